// A record file under the reader's hands: lists of members, attributes, and one dataset held against its row of the grammar.
// Variable-length data (DIMENSION_LIST) is never read: HDF5 trusts the sizes in its unchecked global heap.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/record/grammar.hpp"
#include "common/record/types.hpp"

namespace fracfarm::h5 {

Handle open_image(const std::string& bytes);  // read-only, from memory
bool has_checksums(hid_t file);               // superblock 2 or later

// What a file of that many bytes may decode to: deflate packs at most 1032 to 1, and no record is larger than grammar::total_limit.
std::size_t decode_budget(std::size_t file_bytes);

struct Member {
  std::string name;
  bool hard_link = false;  // anything else could lead out of the file or in a circle
};
std::optional<std::vector<Member>> members(hid_t file,
                                           const std::string& group);  // in creation order; nothing where unreadable or too many

std::vector<std::string> attribute_names(hid_t file, const std::string& object);  // empty where unreadable
std::optional<std::string> text_attribute(hid_t file, const std::string& object, const std::string& name);
std::optional<grammar::Value> value_attribute(hid_t file, const std::string& object, const std::string& name, std::size_t alternative);

class OpenDataset {
 public:
  // Opens and compares type, extents, layout and filters; `arrays` has the scales read so far. What differs is added to `why`.
  OpenDataset(hid_t file, const grammar::DatasetSpec& spec, const std::map<std::string, grammar::Array>& arrays,
              std::vector<std::string>& why);

  std::optional<grammar::Array> read(std::size_t& budget, std::size_t file_bytes, std::vector<std::string>& why) const;

  // Attributes, those of dimension scales included, given all datasets of the file in order and the file's schema.
  std::vector<std::string> broken_attributes(const std::vector<OpenDataset>& all, std::string_view file_schema) const;

 private:
  std::string wrong_type() const;
  std::string wrong_extents(const std::map<std::string, grammar::Array>& arrays);
  std::string wrong_layout() const;
  std::string wrong_uses(const std::vector<UseRow>& expected) const;

  hid_t file_;
  grammar::DatasetSpec spec_;
  Handle dataset_;
  std::vector<std::size_t> dims_;
  haddr_t address_ = HADDR_UNDEF;
};

}  // namespace fracfarm::h5
