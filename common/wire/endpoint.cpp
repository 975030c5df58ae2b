#include "common/wire/endpoint.hpp"

#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "common/base/atomic_file.hpp"

namespace fracfarm::wire {

using nlohmann::json;

std::string reachable(const std::string& bound, const std::string& host) {
  static constexpr std::string_view every_interface = "tcp://0.0.0.0:";
  if (!bound.starts_with(every_interface)) return bound;
  return "tcp://" + host + ":" + bound.substr(every_interface.size());
}

Result<void> write_endpoint(const std::filesystem::path& farm, const Endpoint& endpoint) {
  const json body{{"endpoint", endpoint.endpoint}, {"epoch", endpoint.epoch}, {"pid", endpoint.pid}};
  return write_atomically(farm / "endpoint.json", body.dump(2) + "\n");
}

Result<Endpoint> read_endpoint(const std::filesystem::path& farm) {
  const std::filesystem::path path = farm / "endpoint.json";
  std::error_code none;
  if (!std::filesystem::exists(path, none))
    return fail(Fault::node_lost, "no coordinator has run in " + farm.string() + " (no endpoint.json)");
  const auto text = read_file(path, 4096);
  if (!text) return tl::unexpected(text.error());
  const json body = json::parse(*text, nullptr, false);
  const bool sound = body.is_object() && body.contains("endpoint") && body["endpoint"].is_string() && body.contains("epoch") &&
                     body["epoch"].is_number_unsigned() && body.contains("pid") && body["pid"].is_number_integer();
  if (!sound) return fail(Fault::node_lost, path.string() + " is not what a coordinator writes; start the coordinator again");
  return Endpoint{body["endpoint"].get<std::string>(), body["epoch"].get<std::uint64_t>(), body["pid"].get<long long>()};
}

// A coordinator replaces the file as a whole, so that a new one is another inode or has another time.
const std::optional<Endpoint>& EndpointReader::read() {
  struct stat facts {};
  std::array<std::int64_t, 4> now{};
  if (::stat(file_.c_str(), &facts) == 0)
    now = {static_cast<std::int64_t>(facts.st_ino), facts.st_size, facts.st_mtim.tv_sec, facts.st_mtim.tv_nsec};
  if (now == seen_ && now != std::array<std::int64_t, 4>{}) return endpoint_;
  seen_ = now;
  Result<Endpoint> fresh = read_endpoint(farm_);
  endpoint_ = fresh ? std::optional(std::move(*fresh)) : std::nullopt;
  return endpoint_;
}

}  // namespace fracfarm::wire
