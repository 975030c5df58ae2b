// CURVE keys of a farm, made on first use: DIR/keys (mode 0700) has <name>.key (the pair, mode 0600), server.pub, and allowed/<name>.pub
// for everyone who may connect. Revoking a peer is removing its .pub, which ends its say at once, connected or not; it is never made again
// beside an existing .key. Removing both gives it another pair when it next connects.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace fracfarm::wire {

struct KeyPair {
  std::string name;        // who this is: server, client, worker-<node>-<n>
  std::string public_key;  // Z85, 40 characters
  std::string secret_key;
};

bool is_key_name(const std::string& name);  // [a-z0-9._-]{1,64}, not starting with a dot

// The pair of this name in the farm folder, made and stored durably where it does not exist.
// Errors: BAD_REQUEST for a bad name, a key that others can read or one that is no key; NODE_LOST where the disk refuses.
Result<KeyPair> load_or_make_key(const std::filesystem::path& farm, const std::string& name);
Result<KeyPair> load_key(const std::filesystem::path& farm, const std::string& name);  // where it exists
Result<std::string> server_public_key(const std::filesystem::path& farm);

struct AllowedKey {
  std::string name;
  std::string public_key;
};
// Every public key that may connect now; files that hold no key are left out. Errors: NODE_LOST where the folder, or a file that is there,
// cannot be read just now (no descriptor left, a file system that went away): that says nothing about anybody's key.
Result<std::vector<AllowedKey>> allowed_keys(const std::filesystem::path& farm);

}  // namespace fracfarm::wire
