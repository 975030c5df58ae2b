#include "common/record/writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"
#include "common/record/chunk_codec.hpp"
#include "common/record/content.hpp"
#include "common/record/grammar.hpp"
#include "common/record/hdf5.hpp"
#include "common/record/memory_image.hpp"
#include "common/record/rounding.hpp"
#include "common/record/seal.hpp"
#include "common/record/types.hpp"

namespace fracfarm {
namespace {

using grammar::Array;
using grammar::DatasetSpec;

// Attributes and links are kept in the checksummed object header up to this many, not in a heap: smaller, and HDF5 1.10 frees memory that
// it never set when it lists a damaged heap.
constexpr unsigned header_attributes = 256, header_members = 256;

// A dimension of a dataset that lies along a scale.
struct Use {
  hobj_ref_t dataset;
  unsigned dimension;
};

class Writer {
 public:
  Writer();
  void group(std::string_view path);
  void dataset(const DatasetSpec& spec, const Array& array);
  void attribute(std::string_view object, const std::string& name, const grammar::Value& value);
  void link_scales();  // REFERENCE_LIST of every scale; after the last dataset
  Result<std::string> finish();

 private:
  template <class T>
  T must(T id) {
    ok_ = ok_ && id >= 0;
    return id;
  }
  void text(hid_t object, const std::string& name, const std::string& value, H5T_str_t padding = H5T_STR_NULLPAD);
  void fill(hid_t dataset, const DatasetSpec& spec, const Array& array);
  void mark_scale(hid_t dataset, const DatasetSpec& spec);
  void attach(hid_t dataset, const DatasetSpec& spec);
  h5::Handle layout(const DatasetSpec& spec, const Array& array);

  h5::Silence silence_;
  h5::MemoryImage image_;  // outlives file_
  h5::Handle file_;
  std::map<std::string, hobj_ref_t> scales_;
  std::vector<std::pair<std::string, std::vector<Use>>> uses_;  // by scale, in the order in which they were made
  bool ok_ = true;
};

h5::Handle plain_object(hid_t property_class) {
  h5::Handle list = h5::properties(H5Pcreate(property_class));
  H5Pset_obj_track_times(list, false);
  H5Pset_attr_phase_change(list, header_attributes, header_attributes / 2);
  H5Pset_attr_creation_order(list, H5P_CRT_ORDER_TRACKED);
  return list;
}

h5::Handle plain_group(hid_t property_class) {
  h5::Handle list = plain_object(property_class);
  H5Pset_link_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_link_phase_change(list, header_members, header_members / 2);
  return list;
}

Writer::Writer() {
  constexpr std::size_t growth = std::size_t{1} << 20;
  const h5::Handle access = h5::properties(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
  H5Pset_fapl_core(access, growth, false);
  image_.listen(access);
  file_ = h5::file(must(H5Fcreate("record", H5F_ACC_TRUNC, plain_group(H5P_FILE_CREATE), access)));
}

void Writer::group(std::string_view path) {
  h5::group(must(H5Gcreate2(file_, std::string(path).c_str(), H5P_DEFAULT, plain_group(H5P_GROUP_CREATE), H5P_DEFAULT)));
}

void Writer::text(hid_t object, const std::string& name, const std::string& value, H5T_str_t padding) {
  const h5::Handle type = h5::type(must(H5Tcopy(H5T_C_S1)));
  H5Tset_size(type, value.size() + (padding == H5T_STR_NULLTERM || value.empty() ? 1 : 0));
  H5Tset_strpad(type, padding);
  const h5::Handle space = h5::space(must(H5Screate(H5S_SCALAR)));
  const h5::Handle attribute = h5::attribute(must(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT)));
  must(H5Awrite(attribute, type, value.c_str()));
}

void Writer::attribute(std::string_view object, const std::string& name, const grammar::Value& value) {
  const h5::Handle holder = h5::object(must(H5Oopen(file_, std::string(object).c_str(), H5P_DEFAULT)));
  if (const std::string* words = std::get_if<std::string>(&value)) return text(holder, name, *words);
  const bool real = std::holds_alternative<double>(value);
  const h5::Handle space = h5::space(must(H5Screate(H5S_SCALAR)));
  const h5::Handle made =
      h5::attribute(must(H5Acreate2(holder, name.c_str(), real ? H5T_IEEE_F64LE : H5T_STD_U64LE, space, H5P_DEFAULT, H5P_DEFAULT)));
  if (real)
    must(H5Awrite(made, H5T_NATIVE_DOUBLE, &std::get<double>(value)));
  else
    must(H5Awrite(made, H5T_NATIVE_UINT64, &std::get<std::uint64_t>(value)));
}

h5::Handle Writer::layout(const DatasetSpec& spec, const Array& array) {
  h5::Handle list = plain_object(H5P_DATASET_CREATE);
  if (array.count() == 0) {
    H5Pset_layout(list, H5D_COMPACT);
    return list;
  }
  const std::vector<std::size_t> chunk = grammar::chunk_dims(array.dims, spec.chunking);
  const std::vector<hsize_t> extents(chunk.begin(), chunk.end());
  must(H5Pset_chunk(list, static_cast<int>(extents.size()), extents.data()));
  if (h5::shuffled(array.type)) must(H5Pset_shuffle(list));
  must(H5Pset_deflate(list, deflate_level));
  must(H5Pset_fletcher32(list));
  H5Pset_fill_time(list, H5D_FILL_TIME_NEVER);
  return list;
}

void Writer::dataset(const DatasetSpec& spec, const Array& array) {
  const std::vector<hsize_t> extents(array.dims.begin(), array.dims.end());
  const h5::Handle space = h5::space(must(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr)));
  const h5::Handle type = h5::file_type(array.type);
  const h5::Handle made =
      h5::dataset(must(H5Dcreate2(file_, spec.path.c_str(), type, space, H5P_DEFAULT, layout(spec, array), H5P_DEFAULT)));
  if (!ok_) return;
  if (array.count()) fill(made, spec, array);
  for (const auto& [name, value] : spec.attributes()) text(made, name, value);
  if (spec.is_scale())
    mark_scale(made, spec);
  else
    attach(made, spec);
}

// Every chunk compressed here and handed over whole, past HDF5's own slower filters.
void Writer::fill(hid_t dataset, const DatasetSpec& spec, const Array& array) {
  const std::size_t width = grammar::width_of(array.type);
  h5::ChunkWalk walk(array.dims, grammar::chunk_dims(array.dims, spec.chunking), width);
  std::string spare;
  for (bool more = true; more; more = walk.next()) {
    const std::string_view stored = encode_chunk(walk.bytes_of(array.bytes, spare), width);
    must(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, walk.offset(), stored.size(), stored.data()));
  }
}

void Writer::mark_scale(hid_t dataset, const DatasetSpec& spec) {
  text(dataset, "CLASS", "DIMENSION_SCALE", H5T_STR_NULLTERM);
  text(dataset, "NAME", spec.path.substr(spec.path.rfind('/') + 1), H5T_STR_NULLTERM);
  hobj_ref_t reference = 0;
  must(H5Rcreate(&reference, file_, spec.path.c_str(), H5R_OBJECT, -1));
  scales_[spec.path] = reference;
  uses_.push_back({spec.path, {}});
}

// DIMENSION_LIST: one list of one scale for each dimension, as the dimension scale specification has it.
void Writer::attach(hid_t dataset, const DatasetSpec& spec) {
  std::vector<hvl_t> lists;
  hobj_ref_t self = 0;
  must(H5Rcreate(&self, file_, spec.path.c_str(), H5R_OBJECT, -1));
  for (unsigned d = 0; d < spec.dims.size(); ++d) {
    const auto scale = scales_.find(spec.dims[d]);
    if (scale == scales_.end()) return;  // no coordinate along this dimension: a plain table
    lists.push_back({1, &scale->second});
    std::find_if(uses_.begin(), uses_.end(), [&](const auto& u) { return u.first == scale->first; })->second.push_back({self, d});
  }
  const h5::Handle type = h5::scale_list_type();
  const hsize_t rank = lists.size();
  const h5::Handle space = h5::space(must(H5Screate_simple(1, &rank, nullptr)));
  const h5::Handle made = h5::attribute(must(H5Acreate2(dataset, "DIMENSION_LIST", type, space, H5P_DEFAULT, H5P_DEFAULT)));
  must(H5Awrite(made, type, lists.data()));
}

void Writer::link_scales() {
  const h5::Handle type = h5::use_type();
  for (const auto& [path, uses] : uses_) {
    if (uses.empty()) continue;
    std::vector<h5::UseRow> rows;
    for (const Use& use : uses) rows.push_back({use.dataset, static_cast<int>(use.dimension)});
    const h5::Handle scale = h5::dataset(must(H5Dopen2(file_, path.c_str(), H5P_DEFAULT)));
    const hsize_t count = rows.size();
    const h5::Handle space = h5::space(must(H5Screate_simple(1, &count, nullptr)));
    const h5::Handle file_type = h5::use_file_type();
    const h5::Handle made = h5::attribute(must(H5Acreate2(scale, "REFERENCE_LIST", file_type, space, H5P_DEFAULT, H5P_DEFAULT)));
    must(H5Awrite(made, type, rows.data()));
  }
}

Result<std::string> Writer::finish() {
  ok_ = file_.reset() && ok_;
  const std::string bytes = image_.take();
  if (!ok_ || bytes.empty()) return fail(Fault::output_bad, "HDF5 refused to make the record in memory");
  return bytes + seal_of(bytes);
}

bool printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

// Names that become links and attributes, texts that become fixed-length ASCII.
std::string broken_text(const Record& record) {
  for (const std::string* text :
       {&record.key, &record.canonical_scene, &record.method, &record.material, &record.boundary_condition, &record.judgement.rule})
    if (!printable(*text)) return fmt::format("the text '{}' is not printable ASCII", text->substr(0, 60));
  for (const auto& [name, value] : record.provenance)
    if (!grammar::is_name(name) || !printable(value) || value.size() > grammar::attribute_limit)
      return fmt::format("provenance '{}' has a name or text that an attribute cannot hold", name.substr(0, 60));
  for (const Column& column : record.series.columns)
    if (!grammar::is_name(column.name) || !printable(column.unit))
      return fmt::format("the series column '{}' has a name or unit that a dataset cannot have", column.name.substr(0, 60));
  for (const FailureTime& time : record.failure_times)
    if (!grammar::is_name(time.rule)) return fmt::format("the failure rule '{}' is not a name", time.rule.substr(0, 60));
  return {};
}

Result<void> write_and_compare(const std::filesystem::path& path, const std::string& bytes) {
  if (Result<void> written = write_atomically(path, bytes); !written) return written;
  drop_cached(path);
  const Result<std::string> back = read_file(path, bytes.size());
  if (!back) return tl::unexpected(back.error());
  if (*back != bytes) return fail(Fault::output_bad, path.string() + " read back differently after it was synced");
  return {};
}

}  // namespace

Record as_stored(Record record) {
  for (std::vector<float>& frame : record.phase_field.psi) round_damage(frame);
  round_damage(record.phase_field.psi_initial);
  round_damage(record.phase_field.psi_failure);
  for (std::vector<float>& frame : record.fdem.damage) round_joint_damage(frame);
  round_joint_damage(record.fdem.damage_initial);
  round_joint_damage(record.fdem.damage_failure);
  return record;
}

Result<std::string> record_bytes(Record given) {
  if (!grammar::has_layout(given.method)) return fail(Fault::output_bad, fmt::format("no record has a layout for '{}'", given.method));
  if (std::string why = broken_shape(given); !why.empty()) return fail(Fault::output_bad, why);
  if (std::string why = broken_text(given); !why.empty()) return fail(Fault::output_bad, why);
  const Record record = as_stored(std::move(given));
  const std::vector<ContentCheck> checks = check_content(record);
  Writer writer;
  for (std::string_view path : grammar::groups()) writer.group(path);
  for (const grammar::DatasetRow& row : grammar::datasets(record.method)) writer.dataset(row.spec, row.take({record, checks}));
  for (const Column& column : record.series.columns)
    writer.dataset(grammar::series_spec(column.name, column.unit), grammar::series_array(column));
  writer.link_scales();
  for (const grammar::AttributeRow& row : grammar::attributes(record.method))
    writer.attribute(row.object, std::string(row.name), row.take(record));
  for (const auto& [name, value] : record.provenance) writer.attribute("/provenance", name, value);
  return writer.finish();
}

Result<std::string> write_record(Record record, const std::filesystem::path& path, Keeping keeping) {
  const Result<std::string> bytes = record_bytes(std::move(record));
  if (!bytes) return bytes;
  const bool durable = keeping == Keeping::durable;
  if (auto written = durable ? write_and_compare(path, *bytes) : write_unsynced(path, *bytes); !written)
    return tl::unexpected(written.error());
  return sha256_hex(*bytes);
}

}  // namespace fracfarm
