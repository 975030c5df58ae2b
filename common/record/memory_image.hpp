// The bytes of a file that HDF5 made in memory, caught when it closes the file. H5Fget_file_image will not do: it clears the flags of an
// open superblock but leaves the old checksum, so that nobody can open the image.
#pragma once

#include <cstddef>
#include <string>

#include "common/record/hdf5.hpp"

namespace fracfarm::h5 {

class MemoryImage {
 public:
  MemoryImage() = default;
  MemoryImage(const MemoryImage&) = delete;
  MemoryImage& operator=(const MemoryImage&) = delete;

  void listen(hid_t access);  // a file access list of the core driver; this object must outlive the file
  std::string take();         // after the file was closed; empty where it was not

 private:
  static void* grow(void* memory, std::size_t size, H5FD_file_image_op_t, void* self);
  static herr_t release(void* memory, H5FD_file_image_op_t operation, void* self);

  std::size_t allocated_ = 0;
  std::string bytes_;
};

}  // namespace fracfarm::h5
