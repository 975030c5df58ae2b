#include "common/base/host.hpp"

#include <unistd.h>

#include <array>

namespace fracfarm {

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "node";
}

}  // namespace fracfarm
