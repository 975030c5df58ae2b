// Who this worker is: "worker-<node>-<n>", n the lowest number whose lock is free, so that a restarted worker takes its old name, key and
// outbox; and which start of it: instances of later starts sort after those of earlier ones, so that a greeting which a dead start sent is
// known for what it is whenever it comes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/base/result.hpp"

namespace fracfarm::worker {

class Identity {
 public:
  // `wall_s`: s since 1970. The number of a start is kept in its lock's file; where that was removed, the time stands in.
  // Errors: NODE_LOST where no lock can be made in FARM/keys, BAD_REQUEST where all 1,000 numbers of the node are taken.
  static Result<Identity> claim(const std::filesystem::path& farm, const std::string& node, double wall_s);
  ~Identity();
  Identity(Identity&& other) noexcept;
  Identity& operator=(Identity&& other) noexcept;

  const std::string& name() const { return name_; }
  const std::string& instance() const { return instance_; }  // one for each start

 private:
  Identity(std::string name, std::string instance, int fd) : name_(std::move(name)), instance_(std::move(instance)), fd_(fd) {}
  std::string name_, instance_;
  int fd_ = -1;  // locked as long as this lives
};

std::string instance_of_start(std::uint64_t number);  // sorts as its number does, with random digits behind
std::string name_of_node(const std::string& host);    // lower case, only what a key name may have, at most 40 bytes

}  // namespace fracfarm::worker
