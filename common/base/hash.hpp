// Digests and encodings: SHA-256 for keys and manifests, XXH3-128 for checksums inside our own files, base64 for pages.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace fracfarm {

std::string sha256_hex(std::string_view bytes);
Result<std::string> sha256_file(const std::filesystem::path& path);
std::string xxh3_hex(std::string_view bytes);
std::string base64(std::string_view bytes);  // one line, padded

}  // namespace fracfarm
