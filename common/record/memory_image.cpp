#include "common/record/memory_image.hpp"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace fracfarm::h5 {
namespace {

constexpr std::size_t end_of_file_field = 28;  // in superblocks 2 and 3: where the file ends, 8 bytes little-endian

void* same_user_data(void* self) { return self; }
herr_t keep_user_data(void*) { return 0; }

}  // namespace

void MemoryImage::listen(hid_t access) {
  H5FD_file_image_callbacks_t callbacks{};
  callbacks.image_realloc = grow;
  callbacks.image_free = release;
  callbacks.udata_copy = same_user_data;
  callbacks.udata_free = keep_user_data;
  callbacks.udata = this;
  H5Pset_file_image_callbacks(access, &callbacks);
}

std::string MemoryImage::take() { return std::exchange(bytes_, {}); }

void* MemoryImage::grow(void* memory, std::size_t size, H5FD_file_image_op_t, void* self) {
  static_cast<MemoryImage*>(self)->allocated_ = size;
  return std::realloc(memory, size);
}

herr_t MemoryImage::release(void* memory, H5FD_file_image_op_t operation, void* self) {
  auto& image = *static_cast<MemoryImage*>(self);
  std::uint64_t size = 0;
  if (operation == H5FD_FILE_IMAGE_OP_FILE_CLOSE && image.allocated_ >= end_of_file_field + sizeof size) {
    std::memcpy(&size, static_cast<const char*>(memory) + end_of_file_field, sizeof size);
    if (size <= image.allocated_) image.bytes_.assign(static_cast<const char*>(memory), size);
  }
  std::free(memory);
  return 0;
}

}  // namespace fracfarm::h5
