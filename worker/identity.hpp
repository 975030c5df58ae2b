// Who this worker is: "worker-<node>-<n>", n the lowest number whose lock is free, so that a restarted worker takes its old name, key and
// outbox.
#pragma once

#include <filesystem>
#include <string>

#include "common/base/result.hpp"

namespace fracfarm::worker {

class Identity {
 public:
  // Errors: NODE_LOST where no lock can be made in FARM/keys, BAD_REQUEST where all 1,000 numbers of the node are taken.
  static Result<Identity> claim(const std::filesystem::path& farm, const std::string& node);
  ~Identity();
  Identity(Identity&& other) noexcept;
  Identity& operator=(Identity&& other) noexcept;

  const std::string& name() const { return name_; }

 private:
  Identity(std::string name, int fd) : name_(std::move(name)), fd_(fd) {}
  std::string name_;
  int fd_ = -1;  // locked as long as this lives
};

std::string random_instance();                      // one id for each start
std::string name_of_node(const std::string& host);  // lower case, only what a key name may have, at most 40 bytes

}  // namespace fracfarm::worker
