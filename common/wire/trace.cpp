// A message as JSON, for people. The only place of the wire that builds a tree of what it was sent, after the same bounds as the codec's.
#include <nlohmann/json.hpp>

#include "common/wire/codec.hpp"
#include "common/wire/fields.hpp"
#include "common/wire/msgpack.hpp"

namespace fracfarm::wire {

std::string trace(std::string_view bytes) {
  using nlohmann::json;
  if (bytes.size() > max_message_bytes || !msgpack::well_formed(bytes, max_depth, max_values)) return "not MessagePack";
  const json tree = json::from_msgpack(bytes.begin(), bytes.end(), true, false);
  return tree.is_discarded() ? "not MessagePack" : tree.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace fracfarm::wire
