#include "common/record/open_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

#include "common/record/chunk_codec.hpp"

namespace fracfarm::h5 {
namespace {

using grammar::Array;
using grammar::DatasetSpec;
using grammar::Type;

constexpr std::size_t extent_limit = std::size_t{1} << 27;

herr_t add_member(hid_t, const char* name, const H5L_info_t* info, void* data) {
  auto& list = *static_cast<std::vector<Member>*>(data);
  list.push_back({name, info->type == H5L_TYPE_HARD});
  return list.size() > grammar::columns_limit ? -1 : 0;
}

herr_t add_name(hid_t, const char* name, const H5A_info_t*, void* data) {
  auto& list = *static_cast<std::vector<std::string>*>(data);
  list.emplace_back(name);
  return list.size() > grammar::columns_limit ? -1 : 0;
}

std::vector<std::string> attribute_names(hid_t object) {
  std::vector<std::string> names;
  if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names) < 0) names.clear();
  return names;
}

bool is_scalar(hid_t attribute) {
  const Handle extents = space(H5Aget_space(attribute));
  return extents && H5Sget_simple_extent_type(extents) == H5S_SCALAR;
}

// A fixed-length ASCII text of bounded size.
bool is_text(hid_t kind, std::size_t limit) {
  return H5Tget_class(kind) == H5T_STRING && H5Tis_variable_str(kind) == 0 && H5Tget_cset(kind) == H5T_CSET_ASCII &&
         H5Tget_size(kind) > 0 && H5Tget_size(kind) <= limit;
}

std::optional<std::string> read_text(hid_t object, const std::string& name) {
  const Handle made = attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT));
  if (!made || !is_scalar(made)) return std::nullopt;
  const Handle kind = type(H5Aget_type(made));
  if (!kind || !is_text(kind, grammar::attribute_limit)) return std::nullopt;
  std::string text(H5Tget_size(kind), '\0');
  if (H5Aread(made, kind, text.data()) < 0) return std::nullopt;
  text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
  return text;
}

template <class Number>
std::optional<grammar::Value> read_number(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type) {
  const Handle made = attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT));
  if (!made || !is_scalar(made)) return std::nullopt;
  const Handle kind = type(H5Aget_type(made));
  Number number{};
  if (!kind || H5Tequal(kind, file_type) <= 0 || H5Aread(made, memory_type, &number) < 0) return std::nullopt;
  return number;
}

std::vector<H5Z_filter_t> expected_filters(const DatasetSpec& spec) {
  if (!shuffled(spec.type)) return {H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32};
  return {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32};
}

std::vector<H5Z_filter_t> filters_of(hid_t layout) {
  std::vector<H5Z_filter_t> filters;
  const int count = std::min(H5Pget_nfilters(layout), 8);
  for (int i = 0; i < count; ++i) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    filters.push_back(H5Pget_filter2(layout, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, &config));
  }
  return filters;
}

std::string in_words(const std::vector<std::size_t>& dims) { return fmt::format("{}", fmt::join(dims, " x ")); }

}  // namespace

Handle open_image(const std::string& bytes) {
  if (bytes.empty()) return {};
  const Handle access = properties(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fapl_core(access, std::size_t{1} << 16, false);
  if (H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()) < 0) return {};  // copies
  return file(H5Fopen("record", H5F_ACC_RDONLY, access));
}

bool has_checksums(hid_t file) {
  H5F_info2_t info{};
  return H5Fget_info2(file, &info) >= 0 && info.super.version >= 2;
}

std::size_t decode_budget(std::size_t file_bytes) { return std::min(grammar::total_limit, 1032 * file_bytes); }

std::optional<std::vector<Member>> members(hid_t file, const std::string& path) {
  const Handle opened = group(H5Gopen2(file, path.c_str(), H5P_DEFAULT));
  std::vector<Member> list;
  if (!opened || H5Literate(opened, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, add_member, &list) < 0) return std::nullopt;
  return list;
}

std::vector<std::string> attribute_names(hid_t file, const std::string& path) {
  const Handle opened = object(H5Oopen(file, path.c_str(), H5P_DEFAULT));
  return opened ? attribute_names(hid_t(opened)) : std::vector<std::string>{};
}

std::optional<std::string> text_attribute(hid_t file, const std::string& path, const std::string& name) {
  const Handle opened = object(H5Oopen(file, path.c_str(), H5P_DEFAULT));
  return opened ? read_text(opened, name) : std::nullopt;
}

std::optional<grammar::Value> value_attribute(hid_t file, const std::string& path, const std::string& name, std::size_t alternative) {
  const Handle opened = object(H5Oopen(file, path.c_str(), H5P_DEFAULT));
  if (!opened) return std::nullopt;
  if (alternative == 1) return read_number<double>(opened, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
  if (alternative == 2) return read_number<std::uint64_t>(opened, name, H5T_STD_U64LE, H5T_NATIVE_UINT64);
  const std::optional<std::string> text = read_text(opened, name);
  return text ? std::optional<grammar::Value>(*text) : std::nullopt;
}

OpenDataset::OpenDataset(hid_t file, const DatasetSpec& spec, const std::map<std::string, Array>& arrays, std::vector<std::string>& why)
    : file_(file), spec_(spec), dataset_(h5::dataset(H5Dopen2(file, spec.path.c_str(), H5P_DEFAULT))) {
  std::string wrong = !dataset_ ? "cannot be opened as a dataset: damaged, or another kind of object" : wrong_type();
  if (wrong.empty()) wrong = wrong_extents(arrays);
  if (wrong.empty()) wrong = wrong_layout();
  H5O_info_t info{};
  if (wrong.empty() && H5Oget_info2(dataset_, &info, H5O_INFO_BASIC) < 0) wrong = "its header cannot be read";
  address_ = info.addr;
  if (!wrong.empty()) why.push_back(spec.path + ": " + wrong);
}

std::string OpenDataset::wrong_type() const {
  const Handle kind = type(H5Dget_type(dataset_));
  return kind && H5Tequal(kind, file_type(spec_.type)) > 0 ? "" : "not of the type that the grammar states";
}

std::string OpenDataset::wrong_extents(const std::map<std::string, Array>& arrays) {
  const Handle extents = space(H5Dget_space(dataset_));
  const int rank = extents ? H5Sget_simple_extent_ndims(extents) : -1;
  if (rank < 0 || static_cast<std::size_t>(rank) != spec_.dims.size())
    return fmt::format("has {} dimensions, the grammar states {}", rank, spec_.dims.size());
  std::vector<hsize_t> now(spec_.dims.size()), most(spec_.dims.size());
  if (H5Sget_simple_extent_dims(extents, now.data(), most.data()) < 0) return "its extents cannot be read";
  if (now != most) return "can grow";
  for (std::size_t d = 0; d < now.size(); ++d) {
    const std::string& dim = spec_.dims[d];
    if (now[d] > extent_limit) return fmt::format("extent {} is {}, the limit is {}", d, now[d], extent_limit);
    const auto scale = arrays.find(dim);
    std::size_t fixed = now[d];
    std::from_chars(dim.data(), dim.data() + dim.size(), fixed);
    if (scale != arrays.end()) fixed = scale->second.dims.front();
    if (now[d] != fixed) return fmt::format("extent {} is {}, it should be {}", d, now[d], fixed);
    if (dim.starts_with('/') && scale == arrays.end() && !spec_.is_scale()) return fmt::format("its scale {} cannot be read", dim);
    dims_.push_back(now[d]);
  }
  return {};
}

std::string OpenDataset::wrong_layout() const {
  const Handle layout = properties(H5Dget_create_plist(dataset_));
  if (!layout) return "its layout cannot be read";
  const bool empty = std::find(dims_.begin(), dims_.end(), 0u) != dims_.end();
  if (empty) return H5Pget_layout(layout) == H5D_COMPACT ? "" : "empty, but not compact";
  if (H5Pget_layout(layout) != H5D_CHUNKED) return "not chunked, so its bytes carry no checksum";
  std::vector<hsize_t> chunk(dims_.size());
  if (H5Pget_chunk(layout, static_cast<int>(chunk.size()), chunk.data()) != static_cast<int>(chunk.size()))
    return "its chunks cannot be read";
  const std::vector<std::size_t> found(chunk.begin(), chunk.end()), expected = grammar::chunk_dims(dims_, spec_.chunking);
  if (found != expected) return fmt::format("chunks are {}, they should be {}", in_words(found), in_words(expected));
  if (filters_of(layout) != expected_filters(spec_)) return "filters are not shuffle, deflate and fletcher32 in this order";
  return {};
}

std::optional<Array> OpenDataset::read(std::size_t& budget, std::size_t file_bytes, std::vector<std::string>& why) const {
  const auto wrong = [&](std::string what) {
    why.push_back(spec_.path + ": " + std::move(what));
    return std::nullopt;
  };
  Array array{spec_.type, dims_, {}};
  const std::size_t width = grammar::width_of(spec_.type);
  std::size_t bytes = width;
  for (std::size_t extent : dims_) {
    bytes *= extent;  // cannot wrap: checked against the budget before the next factor
    if (bytes > budget) return wrong(fmt::format("{} elements are more than a file of this size can hold", in_words(dims_)));
  }
  budget -= bytes;
  array.bytes.assign(bytes, '\0');
  if (bytes == 0) return array;
  ChunkWalk walk(dims_, grammar::chunk_dims(dims_, spec_.chunking), width);
  std::string spare, stored;
  std::size_t number = 0;
  for (bool more = true; more; more = walk.next(), ++number) {
    hsize_t size = 0;
    std::uint32_t skipped = 0;
    if (H5Dget_chunk_storage_size(dataset_, walk.offset(), &size) < 0 || size == 0)
      return wrong(fmt::format("chunk {} is missing", number));
    if (size > file_bytes) return wrong(fmt::format("chunk {} claims {} bytes", number, size));
    stored.resize(size);
    if (H5Dread_chunk(dataset_, H5P_DEFAULT, walk.offset(), &skipped, stored.data()) < 0)
      return wrong(fmt::format("chunk {} cannot be read", number));
    if (skipped) return wrong(fmt::format("chunk {} skipped a filter", number));
    const std::span<char> raw = walk.place_in(array.bytes, spare);
    const std::string_view fault = decode_chunk(stored, width, raw);
    if (!fault.empty()) return wrong(fmt::format("chunk {}: {}", number, fault));
    walk.put(raw, array.bytes);
  }
  return array;
}

std::string OpenDataset::wrong_uses(const std::vector<UseRow>& expected) const {
  const Handle made = attribute(H5Aopen(dataset_, "REFERENCE_LIST", H5P_DEFAULT));
  if (!made) return expected.empty() ? "" : "the attribute 'REFERENCE_LIST' is missing";
  const Handle kind = type(H5Aget_type(made)), extents = space(H5Aget_space(made));
  if (!kind || H5Tequal(kind, use_file_type()) <= 0) return "the attribute 'REFERENCE_LIST' is not of its type";
  if (!extents || H5Sget_simple_extent_npoints(extents) != static_cast<hssize_t>(expected.size()))
    return "the attribute 'REFERENCE_LIST' has the wrong length";
  std::vector<UseRow> found(expected.size());
  if (H5Aread(made, use_type(), found.data()) < 0) return "the attribute 'REFERENCE_LIST' cannot be read";
  const auto equal = [](const UseRow& a, const UseRow& b) { return a.dataset == b.dataset && a.dimension == b.dimension; };
  return std::equal(found.begin(), found.end(), expected.begin(), equal)
             ? ""
             : "the attribute 'REFERENCE_LIST' does not name the datasets along this scale";
}

std::vector<std::string> OpenDataset::broken_attributes(const std::vector<OpenDataset>& all, std::string_view file_schema) const {
  std::vector<std::string> broken;
  std::set<std::string> known;
  const auto expect = [&](const std::string& name, const std::string& text) {
    known.insert(name);
    if (read_text(dataset_, name) != text) broken.push_back(fmt::format("{}: the attribute '{}' is not '{}'", spec_.path, name, text));
  };
  for (const auto& [name, text] : spec_.attributes(file_schema)) expect(name, text);
  if (spec_.is_scale()) {
    expect("CLASS", "DIMENSION_SCALE");
    expect("NAME", spec_.path.substr(spec_.path.rfind('/') + 1));
    std::vector<UseRow> uses;
    for (const OpenDataset& other : all)
      for (std::size_t d = 0; d < other.spec_.dims.size(); ++d)
        if (&other != this && other.spec_.dims[d] == spec_.path) uses.push_back({other.address_, static_cast<int>(d)});
    if (!uses.empty()) known.insert("REFERENCE_LIST");
    if (const std::string wrong = wrong_uses(uses); !wrong.empty()) broken.push_back(spec_.path + ": " + wrong);
  } else if (std::all_of(spec_.dims.begin(), spec_.dims.end(), [](const std::string& dim) { return dim.starts_with('/'); })) {
    known.insert("DIMENSION_LIST");
    if (H5Aexists(dataset_, "DIMENSION_LIST") <= 0) broken.push_back(spec_.path + ": the attribute 'DIMENSION_LIST' is missing");
  }
  const std::vector<std::string> names = attribute_names(hid_t(dataset_));
  for (const std::string& name : names)
    if (!known.contains(name))
      broken.push_back(fmt::format("{}: the attribute '{}' is not part of the grammar", spec_.path, name.substr(0, 60)));
  return broken;
}

}  // namespace fracfarm::h5
