// Records in. The file is data from outside: nothing is allocated before its size is bounded, every chunk's checksum is verified, and a
// file that is not exactly of the grammar is refused. Damaged files are turned away by their seal before HDF5 sees them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/record/content.hpp"
#include "common/record/record.hpp"

namespace fracfarm {

inline constexpr std::uint64_t record_file_limit = std::uint64_t{1} << 30;  // bytes

// Everything that could be read, and every way in which the file is not of the grammar.
struct Reading {
  Record record;
  std::vector<ContentCheck> checks;     // of the content, where there are no violations
  std::vector<std::string> violations;  // one sentence each; the record is whole only where there is none
};
Reading read_leniently(const std::string& bytes);  // whose seal was found to fit: HDF5 itself is not safe on damaged files

// The record, sealed and exactly of the grammar. Errors: OUTPUT_BAD with the first violations, NODE_LOST or BAD_REQUEST where the file
// cannot be read.
Result<Record> read_record(const std::filesystem::path& path);
Result<Record> read_record_bytes(const std::string& bytes);

}  // namespace fracfarm
