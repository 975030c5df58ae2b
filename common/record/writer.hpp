// Records out. The file is made in memory and written in one go, beside and renamed. The same record gives the same bytes.
#pragma once

#include <filesystem>
#include <string>

#include "common/base/result.hpp"
#include "common/record/record.hpp"

namespace fracfarm {

// The record as a file stores it: float fields rounded (rounding.hpp).
Record as_stored(Record record);

// The bytes of the record file, seal included. Errors: OUTPUT_BAD where sizes do not fit together or a text is not printable ASCII.
Result<std::string> record_bytes(Record record);

enum class Keeping {
  durable,  // synced, read back and compared
  scratch,  // a crash may take it: the worker judges it at once and keeps it in a shard
};

// Writes path.part and renames it to path; gives the SHA-256 (hex) of the file. Errors: those of record_bytes, NODE_LOST, OUTPUT_BAD where
// it reads back differently.
Result<std::string> write_record(Record record, const std::filesystem::path& path, Keeping keeping);

}  // namespace fracfarm
