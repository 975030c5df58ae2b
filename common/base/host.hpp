// What this machine is called.
#pragma once

#include <string>

namespace fracfarm {

std::string host_name();  // "node" where the system has none

}  // namespace fracfarm
