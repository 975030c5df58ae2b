// The grammar of a record file: every dataset and attribute, stated once, by method of the simulation. Writer, reader, validator and tests
// walk these tables; a new dataset is a row in grammar_<method>.cpp, a new method a row in grammar.cpp. Types are little-endian; every
// dataset is chunked, shuffled, deflated and checksummed (empty ones are compact).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/record/content.hpp"
#include "common/record/record.hpp"

namespace fracfarm::grammar {

inline constexpr std::string_view schema = "fracfarm.record/3";
inline constexpr std::string_view schema_2 = "fracfarm.record/2";  // still read; the phase field's layout is the same
inline constexpr std::string_view schema_1 = "fracfarm.record/1";  // still read; it kept 12 mantissa bits of damage
inline constexpr std::string_view conventions = "CF-1.10";
inline constexpr std::string_view licence = "CC-BY-4.0";
inline constexpr std::size_t total_limit = std::size_t{1} << 30;  // bytes of all datasets together, decoded
inline constexpr std::size_t attribute_limit = 60000;             // bytes of one text attribute
inline constexpr std::size_t name_limit = 64;                     // characters of a column, provenance key or rule
inline constexpr std::size_t columns_limit = 256;                 // members of one group

// text: one ASCII character an element, the last dimension is the longest text, as CF has it. Not fixed-length strings: netCDF 4.9 crashes
// on arrays of them. i1, not u1: ParaView 5.11 refuses a file with unsigned bytes.
enum class Type { f4, f8, i1, i4, text };

std::size_t width_of(Type type);  // bytes of one element

// A dataset's content, in memory as in the file: row-major, little-endian, texts padded with NUL.
struct Array {
  Type type = Type::f8;
  std::vector<std::size_t> dims;
  std::string bytes;

  std::size_t count() const;  // product of dims
  friend bool operator==(const Array&, const Array&) = default;
};

// How a dataset is cut into chunks of at most 64 Ki elements, which are what is compressed.
// rows: as many trailing indices as fit. columns: each column of a table by itself, by which coordinates shrink by a fifth. blocks: frames
// of as few values as fit with many frames, by which what stays as it is from frame to frame shrinks by a fifth.
enum class Chunking { rows, columns, blocks };

struct DatasetSpec {
  std::string path;
  Type type = Type::f8;
  std::vector<std::string> dims;  // "/x": the dimension scale of that path; digits: that many; another word: any extent
  std::string units;
  std::string long_name;
  std::string axis{};     // T, Z, Y, X of a coordinate, or empty
  int fraction_bits = 0;  // 0: all
  std::string rounding_note{};
  Chunking chunking = Chunking::rows;

  bool is_scale() const { return dims.size() == 1 && dims.front() == path; }
  // Name and text, beside those of dimension scales, in a file of that schema.
  std::vector<std::pair<std::string, std::string>> attributes(std::string_view file_schema = schema) const;
};

// What the datasets are taken from: a record and the outcome of its rules.
struct View {
  const Record& record;
  std::span<const ContentCheck> checks;
};

// A dataset that every record of a method has. `give` puts a read array into the record; null: the content follows from the rest
// and is compared where the same build wrote it (another may have other rules).
struct DatasetRow {
  DatasetSpec spec;
  Array (*take)(const View&);
  void (*give)(Record&, const Array&);
};

bool has_layout(std::string_view method);
std::span<const DatasetRow> datasets(std::string_view method);  // dimension scales come before what uses them; empty without a layout

// /series holds one f8 dataset a column, in order, over /series/step_time.
DatasetSpec series_spec(std::string_view name, std::string_view unit);
Array series_array(const Column& column);

using Value = std::variant<std::string, double, std::uint64_t>;

struct AttributeRow {
  std::string_view object;  // "/" or a group
  std::string_view name;
  Value (*take)(const Record&);
  bool (*give)(Record&, const Value&);  // false where the value is not one of the allowed; null: follows from the rest and is compared
};

std::span<const AttributeRow> attributes(std::string_view method);  // `take` must do with an empty record

std::span<const std::string_view> groups();  // beside the root; /provenance has any text attributes

// columns and blocks: of two dimensions.
std::vector<std::size_t> chunk_dims(std::span<const std::size_t> dims, Chunking chunking);

bool is_name(std::string_view name);  // letters, digits and _ . + -, at most name_limit

bool same(const Value& a, const Value& b);  // bitwise for numbers, so that not-a-number equals itself

std::vector<std::string> texts_of(const Array& array);
std::vector<double> doubles_of(const Array& array);
Array array_of(std::span<const double> values, std::vector<std::size_t> dims);
Array array_of(std::span<const std::string> texts);

}  // namespace fracfarm::grammar
