#include "coordinator/campaign_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/text.hpp"
#include "common/scene/json_text.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr std::size_t max_ranges = 1000;
constexpr std::size_t max_axes = 20;
constexpr std::uint64_t max_sample_id = 1'000'000'000'000;
constexpr std::size_t max_combinations = 1000;  // of a block's settings
constexpr std::string_view range_words = "ids from 1, as \"1-200000\", \"5\" or \"1-10,20-30\", ascending and none twice";

// Scene keys whose one value is a list, and how deep.
struct ListKey {
  std::string_view key;
  int depth;
  bool of_objects;
};
constexpr std::array<ListKey, 13> list_keys{{{"phase_field.cells", 1, false},
                                             {"initial.strain", 1, false},
                                             {"initial.velocity_gradient", 1, false},
                                             {"cracks", 2, false},
                                             {"material.layers", 1, true},
                                             {"loads.left", 1, true},
                                             {"loads.right", 1, true},
                                             {"loads.bottom", 1, true},
                                             {"loads.top", 1, true},
                                             {"loads.left.traction", 1, false},
                                             {"loads.right.traction", 1, false},
                                             {"loads.bottom.traction", 1, false},
                                             {"loads.top.traction", 1, false}}};

int nesting(const json& value) {
  int deepest = 0;
  if (!value.is_array()) return 0;
  for (const json& child : value) deepest = std::max(deepest, nesting(child));
  return 1 + deepest;
}

// Whether a value in `set` is a list of values to sweep over.
bool is_axis(std::string_view key, const json& value) {
  for (const ListKey& row : list_keys) {
    if (row.key != key) continue;
    const bool objects = std::all_of(value.begin(), value.end(), [](const json& child) { return child.is_object(); });
    return nesting(value) > row.depth || (value.is_array() && row.of_objects && !objects);
  }
  return value.is_array();
}

// One word or a list of words, each of the table and none twice.
std::vector<std::string> read_words(Fields& fields, std::string_view key, std::span<const std::string_view> table) {
  std::vector<std::string> words;
  const json* value = fields.value(key);
  if (!value) return words;
  const json list = value->is_array() ? *value : json::array({*value});
  if (list.empty() || list.size() > table.size()) {
    fields.problems().add(fields.path(key), printed(*value), fmt::format("1 to {} of {}", table.size(), join(table, " | ")));
    return words;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = key_path(fields.path(key), i);
    const auto index = read_word(list[i], path, table, {}, fields.problems());
    if (!index) continue;
    if (std::find(words.begin(), words.end(), table[*index]) != words.end())
      fields.problems().add(path, printed(list[i]), "each once", "remove it");
    else
      words.emplace_back(table[*index]);
  }
  return words;
}

// "first-last" or "id"; nothing where it is neither.
std::optional<std::pair<std::uint64_t, std::uint64_t>> one_range(std::string_view text) {
  const auto number = [](std::string_view digits) -> std::optional<std::uint64_t> {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value > max_sample_id) return std::nullopt;
    return value;
  };
  const std::size_t dash = text.find('-');
  const auto first = number(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : number(text.substr(dash + 1));
  if (!first || !last || *first > *last) return std::nullopt;
  return std::pair(*first, *last);
}

void read_ranges(Fields& fields, CrackSet set, std::vector<IdRange>& out) {
  const json* value = fields.value(name_of(set));
  if (!value) return;
  std::string text = value->is_string() ? value->get<std::string>() : value->is_number_integer() ? value->dump() : "";
  std::erase(text, ' ');
  std::uint64_t before = 0;
  std::size_t count = 0;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    const auto range = one_range(std::string_view(text).substr(start, comma - start));
    if (!range || range->first <= before || ++count > max_ranges) {
      fields.problems().add(fields.path(name_of(set)), printed(*value), fmt::format("{}; at most {} ranges", range_words, max_ranges));
      return;
    }
    const bool adjoins = before > 0 && range->first == before + 1;
    if (adjoins) out.back().last = range->second;
    if (!adjoins) out.push_back({.set = set, .first = range->first, .last = range->second});
    before = range->second;
    start = comma + 1;
  }
}

void read_patterns(Fields& block_fields, JobBlock& block) {
  const json* value = block_fields.value("patterns");
  if (!value) return;
  Fields fields(*value, block_fields.path("patterns"), block_fields.problems());
  read_ranges(fields, CrackSet::orthogonal, block.patterns);
  read_ranges(fields, CrackSet::oblique, block.patterns);
  if (const json* redraw = fields.value("redraw")) {
    if (redraw->is_boolean())
      block.redraw = redraw->get<bool>();
    else
      fields.problems().add(fields.path("redraw"), printed(*redraw), "true | false");
  }
  if (value->is_object() && !fields.has("orthogonal") && !fields.has("oblique"))
    fields.problems().add(fields.path("orthogonal"), "(missing)", std::string(range_words), "give orthogonal, oblique or both");
  fields.done();
}

void read_set(Fields& block_fields, JobBlock& block) {
  const json* value = block_fields.value("set");
  if (!value) return;
  const std::string path = block_fields.path("set");
  if (!value->is_object() || value->size() > max_axes) {
    block_fields.problems().add(path, printed(*value), fmt::format("a table of at most {} scene keys", max_axes));
    return;
  }
  std::size_t combinations = 1;
  for (auto item = value->begin(); item != value->end(); ++item) {
    SettingAxis axis{.key = item.key(), .values = {}};
    const json values = is_axis(item.key(), *item) ? *item : json::array({*item});
    for (const json& one : values) axis.values.push_back(compact_text(one));
    combinations *= std::min(axis.values.size(), max_combinations + 1);
    const bool distinct = std::set<std::string>(axis.values.begin(), axis.values.end()).size() == axis.values.size();
    if (axis.values.empty() || !distinct || combinations > max_combinations) {
      block_fields.problems().add(key_path(path, item.key()), printed(*item),
                                  fmt::format("one value, or a list of different values; at most {} combinations", max_combinations));
      return;
    }
    block.set.push_back(std::move(axis));
  }
}

// Materials and loads; a drill has neither.
void read_bodies(Fields& fields, JobBlock& block) {
  if (block.method == Method::drill) {
    fields.only("materials", no_material);
    fields.only("loads", no_load);
    block.materials = {std::string(no_material)};
    block.loads = {std::string(no_load)};
    return;
  }
  fields.require({"materials", "loads"});
  std::vector<std::string_view> materials, loads;
  for (const Material& row : material_table()) materials.push_back(row.name);
  for (const NamedLoad& row : named_loads) loads.push_back(row.name);
  block.materials = read_words(fields, "materials", materials);
  block.loads = read_words(fields, "loads", loads);
}

}  // namespace

JobBlock read_block(const json& value, const std::string& path, ProblemList& problems) {
  JobBlock block;
  Fields fields(value, path, problems);
  fields.require({"method", "patterns"});
  static constexpr std::array<Word<Method>, 3> methods{
      {{"phase_field", Method::phase_field}, {"fdem", Method::fdem}, {"drill", Method::drill}}};
  fields.word("method", methods, block.method);
  read_bodies(fields, block);
  read_patterns(fields, block);
  read_set(fields, block);
  fields.done();
  return block;
}

}  // namespace fracfarm
