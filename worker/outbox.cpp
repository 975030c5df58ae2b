#include "worker/outbox.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"
#include "common/wire/codec.hpp"

namespace fracfarm::worker {
namespace {

namespace fs = std::filesystem;

// One line "fracfarm.outbox/1 <xxh3-128 of the rest>", then a NEXT message as it goes over the wire.
constexpr std::string_view magic = "fracfarm.outbox/1 ";
constexpr std::size_t digest_length = 32;

std::string to_bytes(const std::vector<wire::Completion>& completions) {
  wire::Next next;
  next.completed = completions;
  const std::string body = wire::encode(wire::RequestEnvelope{0, std::move(next)});
  return fmt::format("{}{}\n", magic, xxh3_hex(body)) + body;
}

Result<std::vector<wire::Completion>> from_bytes(const std::string& bytes) {
  const std::size_t head = magic.size() + digest_length + 1;
  if (bytes.size() < head || !bytes.starts_with(magic)) return fail(Fault::output_bad, "is no outbox of this release");
  const std::string body = bytes.substr(head);
  if (xxh3_hex(body) != bytes.substr(magic.size(), digest_length)) return fail(Fault::output_bad, "is damaged (its checksum differs)");
  auto envelope = wire::decode_request(body);
  if (!envelope) return tl::unexpected(envelope.error());
  auto* next = std::get_if<wire::Next>(&envelope->request);
  if (!next) return fail(Fault::output_bad, "holds another message");
  return std::move(next->completed);
}

}  // namespace

Outbox Outbox::open(const fs::path& file, std::string& warning) {
  Outbox outbox(file);
  std::error_code error;
  if (!fs::exists(file, error)) return outbox;
  const auto bytes = read_file(file, wire::max_message_bytes);
  auto completions = bytes ? from_bytes(*bytes) : tl::unexpected(bytes.error());
  if (completions) {
    outbox.completions_ = std::move(*completions);
    return outbox;
  }
  fs::rename(file, file.string() + ".damaged", error);
  warning = fmt::format("{} {}; it was set aside and its jobs will be solved again", file.string(), completions.error().message);
  return outbox;
}

Result<void> Outbox::add(const std::vector<wire::Completion>& completions) {
  const std::size_t before = completions_.size();
  completions_.insert(completions_.end(), completions.begin(), completions.end());
  auto written = write();
  if (!written) completions_.resize(before);
  return written;
}

void Outbox::acknowledge(const std::vector<std::string>& keys) {
  std::erase_if(completions_, [&](const wire::Completion& c) { return std::find(keys.begin(), keys.end(), c.key) != keys.end(); });
}

Result<void> Outbox::close() {
  if (!completions_.empty()) return write();
  std::error_code ignored;
  fs::remove(file_, ignored);
  return {};
}

Result<void> Outbox::write() const { return write_atomically(file_, to_bytes(completions_)); }

}  // namespace fracfarm::worker
