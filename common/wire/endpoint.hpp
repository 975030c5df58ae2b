// Where the coordinator of a farm answers: DIR/endpoint.json, written by the coordinator at each start, read again by everyone else at each
// reconnect, because the port may change.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/base/result.hpp"

namespace fracfarm::wire {

struct Endpoint {
  std::string endpoint;  // tcp://host:port
  std::uint64_t epoch = 0;
  long long pid = 0;
  bool operator==(const Endpoint&) const = default;
};

// What others connect to: the endpoint as it was bound, with `host` in place of "every interface" (0.0.0.0).
std::string reachable(const std::string& bound, const std::string& host);

Result<void> write_endpoint(const std::filesystem::path& farm, const Endpoint& endpoint);
// Errors: NODE_LOST where there is none ("no coordinator has run here") or it cannot be read.
Result<Endpoint> read_endpoint(const std::filesystem::path& farm);

// The same for who asks before every message: the file is read again only where it is another one than last time, or of another time.
class EndpointReader {
 public:
  explicit EndpointReader(std::filesystem::path farm) : file_(farm / "endpoint.json"), farm_(std::move(farm)) {}
  const std::optional<Endpoint>& read();  // nothing where read_endpoint says no

 private:
  std::filesystem::path file_, farm_;
  std::array<std::int64_t, 4> seen_{};  // inode, size and time of the file; zeros: none
  std::optional<Endpoint> endpoint_;
};

}  // namespace fracfarm::wire
