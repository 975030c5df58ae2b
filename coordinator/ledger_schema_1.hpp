// The ledger's first tables: the SQL of its version 1.
#pragma once

#include <string_view>

namespace fracfarm {

extern const std::string_view schema_version_1;

}  // namespace fracfarm
