// HDF5 types of the grammar, and the walk over the chunks of a dataset. Writer and reader agree by sharing them.
#pragma once

#include <cstddef>
#include <span>
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
  ChunkWalk(const std::vector<std::size_t>& dims, std::vector<std::size_t> chunk, std::size_t width);

  const hsize_t* offset() const { return offset_.data(); }
  bool next();  // false after the last chunk

  // The chunk's bytes: of the array itself where they lie there in one piece, else gathered in `spare`.
  std::string_view bytes_of(const std::string& array, std::string& spare) const;
  // Where to put the chunk's bytes: the array itself, or `spare`. Then put() brings them home.
  std::span<char> place_in(std::string& array, std::string& spare) const;
  void put(std::span<const char> bytes, std::string& array) const;

 private:
  std::size_t position() const;    // of the chunk's first byte in the array
  bool lies_in_one_piece() const;  // a whole chunk of all trailing indices
  template <class Copy>
  void each_run(Copy copy) const;  // copy(byte in array, byte in chunk, bytes)

  std::vector<std::size_t> dims_, chunk_;
  std::size_t width_, chunk_bytes_;
  std::vector<hsize_t> offset_;
};

}  // namespace fracfarm::h5
