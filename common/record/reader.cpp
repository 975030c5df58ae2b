#include "common/record/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "common/base/atomic_file.hpp"
#include "common/base/build_info.hpp"
#include "common/record/chunk_codec.hpp"
#include "common/record/grammar.hpp"
#include "common/record/open_dataset.hpp"
#include "common/record/seal.hpp"

namespace fracfarm {
namespace {

using grammar::Array;
using grammar::DatasetSpec;

constexpr std::size_t violations_limit = 50;

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes), budget_(h5::decode_budget(bytes.size())) {}
  Reading read();

 private:
  void object_lists();
  void fixed_datasets();
  void series();
  void attributes();
  void provenance();
  void scales();
  void derived();
  std::optional<Array> dataset(const DatasetSpec& spec, bool keep_array);
  void violate(std::string sentence) {
    if (reading_.violations.size() < violations_limit) reading_.violations.push_back(std::move(sentence));
  }
  void keep(std::vector<std::string> sentences) {
    for (std::string& sentence : sentences) violate(std::move(sentence));
  }

  const std::string& bytes_;
  std::size_t budget_;
  h5::Silence silence_;
  h5::Handle file_;
  std::string method_;  // says which layout
  Reading reading_;
  std::set<std::string> objects_;        // every path that is there as a hard link
  std::vector<std::string> columns_;     // of /series, in order
  std::map<std::string, Array> arrays_;  // as read, by path: scales, and what follows from the rest
  std::vector<h5::OpenDataset> open_;    // in file order
};

Reading Reader::read() {
  file_ = h5::open_image(bytes_);
  if (!file_) {
    violate("HDF5 cannot open the file: not a record, or its superblock is damaged");
    return std::move(reading_);
  }
  if (!h5::has_checksums(file_)) violate("the file format is older than HDF5 1.10: its metadata carries no checksums");
  method_ = h5::text_attribute(file_, "/", "method").value_or("");
  if (!grammar::has_layout(method_)) {
    violate(fmt::format("/: the attribute 'method' is missing or '{}', which has no layout", method_.substr(0, 60)));
    return std::move(reading_);
  }
  object_lists();
  fixed_datasets();
  series();
  attributes();
  provenance();
  scales();
  if (reading_.violations.empty()) derived();
  return std::move(reading_);
}

// Which objects there are, and that no others are.
void Reader::object_lists() {
  std::set<std::string> known;
  for (const grammar::DatasetRow& row : grammar::datasets(method_)) known.insert(row.spec.path);
  for (std::string_view group : grammar::groups()) known.insert(std::string(group));
  std::vector<std::string> parents{""};
  for (std::string_view group : grammar::groups()) parents.emplace_back(group);
  for (const std::string& parent : parents) {
    if (!parent.empty() && !objects_.contains(parent)) continue;  // said below
    const auto members = h5::members(file_, parent.empty() ? "/" : parent);
    if (!members) {
      violate(fmt::format("{}: the list of its members cannot be read", parent.empty() ? "/" : parent));
      continue;
    }
    for (const h5::Member& member : *members) {
      const std::string path = parent + "/" + member.name;
      const bool column = parent == "/series" && grammar::is_name(member.name);
      if (!member.hard_link || !(column || known.contains(path)))
        violate(fmt::format("{}: not part of the grammar", path.substr(0, 100)));
      else
        objects_.insert(path);
      if (column) columns_.push_back(member.name);
    }
  }
  for (const std::string& path : known)
    if (!objects_.contains(path)) violate(fmt::format("{}: missing", path));
}

std::optional<Array> Reader::dataset(const DatasetSpec& spec, bool keep_array) {
  if (!objects_.contains(spec.path)) return std::nullopt;
  std::vector<std::string> why;
  h5::OpenDataset opened(file_, spec, arrays_, why);
  std::optional<Array> array;
  if (why.empty()) array = opened.read(budget_, bytes_.size(), why);
  keep(std::move(why));
  if (!array) return std::nullopt;
  if (keep_array || spec.is_scale()) arrays_[spec.path] = *array;
  open_.push_back(std::move(opened));
  return array;
}

void Reader::fixed_datasets() {
  for (const grammar::DatasetRow& row : grammar::datasets(method_))
    if (const std::optional<Array> array = dataset(row.spec, !row.give); array && row.give) row.give(reading_.record, *array);
}

void Reader::series() {
  for (const std::string& name : columns_) {
    const std::optional<std::string> unit = h5::text_attribute(file_, "/series/" + name, "units");
    if (!unit) {
      violate(fmt::format("/series/{}: the attribute 'units' is missing", name));
      continue;
    }
    if (const std::optional<Array> array = dataset(grammar::series_spec(name, *unit), false))
      reading_.record.series.columns.push_back({name, *unit, grammar::doubles_of(*array)});
  }
}

void Reader::attributes() {
  std::map<std::string, std::set<std::string>> known{{"/", {}}};
  for (std::string_view group : grammar::groups()) known[std::string(group)];
  for (const grammar::AttributeRow& row : grammar::attributes(method_)) {
    const std::string object(row.object), name(row.name);
    known[object].insert(name);
    const std::optional<grammar::Value> value = h5::value_attribute(file_, object, name, row.take({}).index());
    if (!value)
      violate(fmt::format("{}: the attribute '{}' is missing or not of its type", object, name));
    else if (row.give && !row.give(reading_.record, *value))
      violate(fmt::format("{}: the attribute '{}' has a value that is not allowed", object, name));
  }
  for (const auto& [object, names] : known) {
    if (object == "/provenance") continue;
    for (const std::string& name : h5::attribute_names(file_, object))
      if (!names.contains(name)) violate(fmt::format("{}: the attribute '{}' is not part of the grammar", object, name.substr(0, 60)));
  }
}

void Reader::provenance() {
  for (const std::string& name : h5::attribute_names(file_, "/provenance")) {
    const std::optional<std::string> text = h5::text_attribute(file_, "/provenance", name);
    if (!text || !grammar::is_name(name))
      violate(fmt::format("/provenance: the attribute '{}' is not a fixed-length text", name.substr(0, 60)));
    else
      reading_.record.provenance[name] = *text;
  }
}

void Reader::scales() {
  const std::string file_schema = h5::text_attribute(file_, "/", "fracfarm_schema").value_or("");
  for (const h5::OpenDataset& one : open_) keep(one.broken_attributes(open_, file_schema));
}

// What follows from the rest must be what is written.
void Reader::derived() {
  const Record& record = reading_.record;
  if (std::string why = broken_shape(record); !why.empty()) return violate(why);
  reading_.checks = check_content(record);
  const auto build = record.provenance.find("build_id");
  const bool own = build != record.provenance.end() && build->second == build_info().build_id;  // another build may have other rules
  for (const grammar::DatasetRow& row : grammar::datasets(method_))
    if (own && !row.give && arrays_[row.spec.path] != row.take({record, reading_.checks}))
      violate(fmt::format("{}: differs from what the record's content gives", row.spec.path));
  for (const grammar::AttributeRow& row : grammar::attributes(method_)) {
    const grammar::Value expected = row.take(record);
    const auto value = h5::value_attribute(file_, std::string(row.object), std::string(row.name), expected.index());
    if (!row.give && !(value && grammar::same(*value, expected)))
      violate(fmt::format("{}: the attribute '{}' differs from what the record's content gives", row.object, row.name));
  }
}

}  // namespace

Reading read_leniently(const std::string& bytes) { return Reader(bytes).read(); }

Result<Record> read_record_bytes(const std::string& bytes) {
  if (const std::string why = broken_seal(bytes); !why.empty()) return fail(Fault::output_bad, why);
  Reading reading = read_leniently(bytes);
  if (reading.violations.empty()) return std::move(reading.record);
  return fail(Fault::output_bad,
              fmt::format("{}{}", reading.violations.front(),
                          reading.violations.size() > 1 ? fmt::format(" (and {} more)", reading.violations.size() - 1) : ""));
}

Result<Record> read_record(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path, record_file_limit);
  if (!bytes) return tl::unexpected(bytes.error());
  Result<Record> record = read_record_bytes(*bytes);
  if (!record) return fail(record.error().fault, path.string() + ": " + record.error().message);
  return record;
}

}  // namespace fracfarm
