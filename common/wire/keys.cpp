#include "common/wire/keys.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zmq.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "common/base/atomic_file.hpp"

namespace fracfarm::wire {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t key_length = 40;  // Z85 of 32 bytes
constexpr std::size_t longest_public_file = 256;

fs::path keys_folder(const fs::path& farm) { return farm / "keys"; }
fs::path public_path(const fs::path& farm, const std::string& name) {
  return name == "server" ? keys_folder(farm) / "server.pub" : keys_folder(farm) / "allowed" / (name + ".pub");
}

bool is_z85_key(const std::string& text) {
  std::array<std::uint8_t, 32> bytes;
  return text.size() == key_length && ::zmq_z85_decode(bytes.data(), text.c_str()) != nullptr;
}

// Held while keys are made, so that two programs started at once agree on one pair.
class MakingLock {
 public:
  explicit MakingLock(const fs::path& folder) : fd_(::open((folder / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    if (fd_ >= 0) ::flock(fd_, LOCK_EX);
  }
  ~MakingLock() {
    if (fd_ >= 0) ::close(fd_);
  }
  MakingLock(const MakingLock&) = delete;
  MakingLock& operator=(const MakingLock&) = delete;

 private:
  int fd_;
};

Result<void> make_folders(const fs::path& farm) {
  std::error_code error;
  fs::create_directories(keys_folder(farm) / "allowed", error);
  if (!error) fs::permissions(keys_folder(farm), fs::perms::owner_all, error);
  if (error) return fail(Fault::node_lost, fmt::format("cannot make {}: {}", keys_folder(farm).string(), error.message()));
  return {};
}

Result<KeyPair> read_pair(const fs::path& path, const std::string& name) {
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && (info.st_mode & 077) != 0)
    return fail(Fault::bad_request, fmt::format("{} can be read by others (mode {:o}); chmod 600 it, or remove it to make another",
                                                path.string(), info.st_mode & 0777u));
  const auto text = read_file(path, 4096);
  if (!text) return tl::unexpected(text.error());
  const json body = json::parse(*text, nullptr, false);
  const auto part = [&](const char* key) {
    return body.is_object() && body.contains(key) && body[key].is_string() ? body[key].get<std::string>() : std::string();
  };
  KeyPair pair{name, part("public_key"), part("secret_key")};
  std::array<char, key_length + 1> derived{};
  const bool sound = is_z85_key(pair.public_key) && is_z85_key(pair.secret_key) &&
                     ::zmq_curve_public(derived.data(), pair.secret_key.c_str()) == 0 && pair.public_key == derived.data();
  if (!sound) return fail(Fault::bad_request, path.string() + " holds no CURVE key pair; remove it to make another");
  return pair;
}

// The public half first: where a .key exists, its .pub was there once, so a missing one is a revoked one.
Result<KeyPair> make_pair(const fs::path& farm, const std::string& name) {
  std::array<char, key_length + 1> public_key{}, secret_key{};
  if (::zmq_curve_keypair(public_key.data(), secret_key.data()) != 0)
    return fail(Fault::node_lost, fmt::format("cannot make a CURVE key pair: {}", ::zmq_strerror(errno)));
  const KeyPair pair{name, public_key.data(), secret_key.data()};
  const json body{{"name", name}, {"public_key", pair.public_key}, {"secret_key", pair.secret_key}};
  if (auto done = write_atomically(public_path(farm, name), pair.public_key + "\n"); !done) return tl::unexpected(done.error());
  if (auto done = write_atomically(keys_folder(farm) / (name + ".key"), body.dump(2) + "\n", 0600); !done)
    return tl::unexpected(done.error());
  return pair;
}

std::string key_of(const std::string& text) {
  const std::string key = text.substr(0, key_length);
  return is_z85_key(key) && text.find_first_not_of(" \t\r\n", key_length) == std::string::npos ? key : std::string();
}

}  // namespace

bool is_key_name(const std::string& name) {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-'; };
  return !name.empty() && name.size() <= 64 && name.front() != '.' && std::all_of(name.begin(), name.end(), allowed);
}

Result<KeyPair> load_or_make_key(const fs::path& farm, const std::string& name) {
  if (!is_key_name(name)) return fail(Fault::bad_request, fmt::format("key name '{}' is not of [a-z0-9._-]{{1,64}}", name));
  const fs::path path = keys_folder(farm) / (name + ".key");
  std::error_code error;
  if (fs::exists(path, error)) return read_pair(path, name);
  if (auto made = make_folders(farm); !made) return tl::unexpected(made.error());
  const MakingLock lock(keys_folder(farm));
  return fs::exists(path, error) ? read_pair(path, name) : make_pair(farm, name);
}

Result<KeyPair> load_key(const fs::path& farm, const std::string& name) {
  if (!is_key_name(name)) return fail(Fault::bad_request, fmt::format("'{}' is no key's name", name));
  return read_pair(keys_folder(farm) / (name + ".key"), name);
}

Result<std::string> server_public_key(const fs::path& farm) {
  const fs::path path = public_path(farm, "server");
  const Result<std::string> text = read_file(path, longest_public_file);
  const std::string key = text ? key_of(*text) : std::string();
  if (key.empty()) return fail(Fault::node_lost, path.string() + " is missing or no key: has a coordinator run in this farm?");
  return key;
}

Result<std::vector<AllowedKey>> allowed_keys(const fs::path& farm) {
  std::vector<AllowedKey> keys;
  std::error_code error, gone;
  const fs::path folder = keys_folder(farm) / "allowed";
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& path = entry->path();
    if (path.extension() != ".pub" || !is_key_name(path.stem().string())) continue;
    const Result<std::string> text = read_file(path, longest_public_file);
    const bool readable = ::access(path.c_str(), R_OK) == 0 && fs::file_size(path, gone) <= longest_public_file && !gone;
    if (!text && readable) return tl::unexpected(text.error());
    if (std::string key = text ? key_of(*text) : std::string(); !key.empty()) keys.push_back({path.stem().string(), std::move(key)});
  }
  if (error && error != std::errc::no_such_file_or_directory)
    return fail(Fault::node_lost, fmt::format("cannot read {}: {}", folder.string(), error.message()));
  std::sort(keys.begin(), keys.end(), [](const AllowedKey& a, const AllowedKey& b) { return a.name < b.name; });
  return keys;
}

}  // namespace fracfarm::wire
