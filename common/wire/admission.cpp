#include "common/wire/admission.hpp"

#include <chrono>
#include <system_error>

#include "common/wire/keys.hpp"

namespace fracfarm::wire {
namespace {

constexpr double look_interval_s = 0.25;
constexpr double stranger_interval_s = 0.01;  // for a key that was not there: it may have been made since, and its first message counts
constexpr double longest_trust_s = 5.0;       // in a folder whose time is unchanged: a file may be written in place
constexpr auto clock_tick = std::chrono::seconds(2);

}  // namespace

// What cannot be read just now is asked for again at the next look; until then everybody's key is as good as it was.
void Admission::reload() {
  Result<std::vector<AllowedKey>> keys = allowed_keys(farm_);
  read_ = keys.has_value();
  if (!keys) return;
  names_.clear();
  for (AllowedKey& key : *keys) names_.emplace(std::move(key.public_key), std::move(key.name));
}

// Two changes within one tick of the file system's clock leave the folder's time unchanged: a young time says nothing.
bool Admission::may_have_changed() {
  std::error_code error;
  const auto changed = std::filesystem::last_write_time(farm_ / "keys" / "allowed", error);
  const bool same = !error && read_ && changed == read_at_ && std::filesystem::file_time_type::clock::now() - changed > clock_tick;
  read_at_ = changed;
  return !same;
}

std::string Admission::name_of_key(const std::string& public_key) {
  if (public_key.empty()) return {};
  if (may_have_changed() || !names_.contains(public_key)) reload();
  const auto found = names_.find(public_key);
  return found == names_.end() ? std::string() : found->second;
}

bool Admission::still_allowed(const std::string& name, const std::string& public_key, double now_s) {
  const double interval_s = names_.contains(public_key) ? look_interval_s : stranger_interval_s;
  if (now_s - looked_s_ > interval_s) {
    looked_s_ = now_s;
    if (may_have_changed() || now_s - reloaded_s_ > longest_trust_s) {
      reload();
      reloaded_s_ = now_s;
    }
  }
  const auto found = names_.find(public_key);
  return found != names_.end() && found->second == name;
}

}  // namespace fracfarm::wire
