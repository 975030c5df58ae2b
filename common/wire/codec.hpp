// Messages to MessagePack bytes and back. Decoding never throws or over-allocates, whatever the bytes; unknown versions are refused in
// words.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/wire/messages.hpp"

namespace fracfarm::wire {

std::string encode(const RequestEnvelope& envelope);
std::string encode(const ReplyEnvelope& envelope);
Result<RequestEnvelope> decode_request(std::string_view bytes);  // errors: BAD_REQUEST, with the request id lost
Result<ReplyEnvelope> decode_reply(std::string_view bytes);
std::string trace(std::string_view bytes);  // as JSON for --trace; "not MessagePack" where it is not

}  // namespace fracfarm::wire
