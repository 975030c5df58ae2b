// CURVE keys of a farm: DIR/keys/server.json, DIR/keys/allowed/<name>.pub, and <name>.key (mode 0600) beside it. Made on first use.
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

// The pair of this name in the farm folder, made and stored durably where it does not exist. Names: [a-z0-9._-]{1,64}.
Result<KeyPair> load_or_make_key(const std::filesystem::path& farm, const std::string& name);
Result<std::string> server_public_key(const std::filesystem::path& farm);

struct AllowedKey {
  std::string name;
  std::string public_key;
};
// Every public key that may connect now; read again at each unknown key, so that revoking one is removing its file.
std::vector<AllowedKey> allowed_keys(const std::filesystem::path& farm);

}  // namespace fracfarm::wire
