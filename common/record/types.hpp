// HDF5 types of the grammar, and the walk over the chunks of a dataset. Writer and reader agree by sharing them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/record/grammar.hpp"
#include "common/record/hdf5.hpp"

namespace fracfarm::h5 {

Handle file_type(grammar::Type type);
bool shuffled(grammar::Type type);  // numbers wider than a byte

// One row of REFERENCE_LIST: which dataset uses the scale along which dimension.
struct UseRow {
  hobj_ref_t dataset;
  int dimension;
};
Handle use_type();         // in memory
Handle use_file_type();    // in the file
Handle scale_list_type();  // DIMENSION_LIST: variable-length list of object references

// Visits the chunks of an array in row-major order. Chunks at the far edges are whole in the file, padded with zeros.
class ChunkWalk {
 public:
  ChunkWalk(const std::vector<std::size_t>& dims, std::size_t width);

  std::size_t chunk_bytes() const { return chunk_bytes_; }
  const hsize_t* offset() const { return offset_.data(); }
  bool next();  // false after the last chunk

  void gather(const std::string& array, std::string& chunk) const;   // array -> chunk
  void scatter(const std::string& chunk, std::string& array) const;  // chunk -> array

 private:
  template <class Copy>
  void each_run(Copy copy) const;  // copy(byte in array, byte in chunk, bytes)

  std::vector<std::size_t> dims_, chunk_;
  std::size_t width_, chunk_bytes_;
  std::vector<hsize_t> offset_;
};

}  // namespace fracfarm::h5
