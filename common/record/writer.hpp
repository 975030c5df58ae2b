// Records out. The file is made in memory and written in one go: beside, synced, renamed. The same record gives the same bytes.
#pragma once

#include <filesystem>
#include <string>

#include "common/base/result.hpp"
#include "common/record/record.hpp"

namespace fracfarm {

// The record as a file stores it: float fields rounded (rounding.hpp).
Record as_stored(const Record& record);

// The bytes of the record file, seal included. Errors: OUTPUT_BAD where sizes do not fit together or a text is not printable ASCII.
Result<std::string> record_bytes(const Record& record);

// Writes path.part, flushes, fsyncs, renames to path; gives the SHA-256 (hex) of the file. Errors: those of record_bytes, NODE_LOST.
Result<std::string> write_record(const Record& record, const std::filesystem::path& path);

}  // namespace fracfarm
