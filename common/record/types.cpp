#include "common/record/types.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace fracfarm::h5 {

Handle file_type(grammar::Type type) {
  switch (type) {
    case grammar::Type::f4:
      return h5::type(H5Tcopy(H5T_IEEE_F32LE));
    case grammar::Type::f8:
      return h5::type(H5Tcopy(H5T_IEEE_F64LE));
    case grammar::Type::i1:
      return h5::type(H5Tcopy(H5T_STD_I8LE));
    case grammar::Type::i4:
      return h5::type(H5Tcopy(H5T_STD_I32LE));
    case grammar::Type::text:
      break;
  }
  return h5::type(H5Tcopy(H5T_C_S1));
}

bool shuffled(grammar::Type type) { return grammar::width_of(type) > 1; }

Handle use_type() {
  Handle made = h5::type(H5Tcreate(H5T_COMPOUND, sizeof(UseRow)));
  H5Tinsert(made, "dataset", HOFFSET(UseRow, dataset), H5T_STD_REF_OBJ);
  H5Tinsert(made, "dimension", HOFFSET(UseRow, dimension), H5T_NATIVE_INT);
  return made;
}

Handle use_file_type() {
  Handle made = h5::type(H5Tcreate(H5T_COMPOUND, sizeof(hobj_ref_t) + 4));
  H5Tinsert(made, "dataset", 0, H5T_STD_REF_OBJ);
  H5Tinsert(made, "dimension", sizeof(hobj_ref_t), H5T_STD_I32LE);
  return made;
}

Handle scale_list_type() { return h5::type(H5Tvlen_create(H5T_STD_REF_OBJ)); }

ChunkWalk::ChunkWalk(const std::vector<std::size_t>& dims, std::vector<std::size_t> chunk, std::size_t width)
    : dims_(dims), chunk_(std::move(chunk)), width_(width), chunk_bytes_(width), offset_(dims.size(), 0) {
  for (std::size_t extent : chunk_) chunk_bytes_ *= extent;
}

bool ChunkWalk::next() {
  for (std::size_t d = dims_.size(); d-- > 0;) {
    offset_[d] += chunk_[d];
    if (offset_[d] < dims_[d]) return true;
    offset_[d] = 0;
  }
  return false;
}

// A run is a row along the last dimension.
template <class Copy>
void ChunkWalk::each_run(Copy copy) const {
  const std::size_t rank = dims_.size(), last = rank - 1;
  const std::size_t run = std::min<std::size_t>(chunk_[last], dims_[last] - offset_[last]) * width_;
  std::vector<std::size_t> at(rank, 0);  // row within the chunk
  for (;;) {
    std::size_t in_array = 0, in_chunk = 0;
    for (std::size_t d = 0; d < rank; ++d) {
      in_array = in_array * dims_[d] + offset_[d] + at[d];
      in_chunk = in_chunk * chunk_[d] + at[d];
    }
    copy(in_array * width_, in_chunk * width_, run);
    std::size_t d = last;
    while (d > 0 && (++at[d - 1] == chunk_[d - 1] || offset_[d - 1] + at[d - 1] == dims_[d - 1])) at[--d] = 0;
    if (d == 0) return;
  }
}

std::size_t ChunkWalk::position() const {
  std::size_t element = 0;
  for (std::size_t d = 0; d < dims_.size(); ++d) element = element * dims_[d] + offset_[d];
  return element * width_;
}

bool ChunkWalk::lies_in_one_piece() const {
  for (std::size_t d = 1; d < dims_.size(); ++d)
    if (chunk_[d] != dims_[d]) return false;
  return offset_[0] + chunk_[0] <= dims_[0];
}

std::string_view ChunkWalk::bytes_of(const std::string& array, std::string& spare) const {
  if (lies_in_one_piece()) return std::string_view(array).substr(position(), chunk_bytes_);
  spare.assign(chunk_bytes_, '\0');
  each_run([&](std::size_t from, std::size_t to, std::size_t bytes) { std::memcpy(spare.data() + to, array.data() + from, bytes); });
  return spare;
}

std::span<char> ChunkWalk::place_in(std::string& array, std::string& spare) const {
  if (lies_in_one_piece()) return {array.data() + position(), chunk_bytes_};
  spare.resize(chunk_bytes_);
  return spare;
}

void ChunkWalk::put(std::span<const char> bytes, std::string& array) const {
  if (lies_in_one_piece()) return;
  each_run([&](std::size_t to, std::size_t from, std::size_t count) { std::memcpy(array.data() + to, bytes.data() + from, count); });
}

}  // namespace fracfarm::h5
