// Whose key is allowed now: DIR/keys/allowed as it is, read again when it has changed. One instance a thread.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace fracfarm::wire {

class Admission {
 public:
  explicit Admission(std::filesystem::path farm) : farm_(std::move(farm)) {}

  // The name that a public key (Z85) stands for, looked up in the folder as it is at this moment; empty: not allowed.
  std::string name_of_key(const std::string& public_key);
  // The same for a peer that was let in before, of whom many messages come: the folder is looked at four times a second at most, so that a
  // key that was taken away is good for a quarter of a second more.
  bool still_allowed(const std::string& name, const std::string& public_key, double now_s);

 private:
  void reload();
  bool may_have_changed();

  std::filesystem::path farm_;
  std::map<std::string, std::string> names_;  // public key to name
  std::filesystem::file_time_type read_at_{};
  bool read_ = false;
  double looked_s_ = -1e300, reloaded_s_ = -1e300;
};

}  // namespace fracfarm::wire
