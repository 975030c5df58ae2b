#include "coordinator/campaign_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/text.hpp"
#include "common/scene/fields.hpp"
#include "common/scene/json_text.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr std::size_t max_bytes = 1'000'000;
constexpr std::size_t max_depth = 16;

// Walks the TOML tree once, writing JSON and noting lines.
class TomlReader {
 public:
  TomlReader(CampaignFile& file, ProblemList& problems) : file_(file), problems_(problems) {}

  json convert(const toml::node& node, const std::string& path, std::size_t depth = 0) {
    if (!path.empty()) file_.lines[path] = static_cast<int>(node.source().begin.line);
    if (depth > max_depth) return refuse(path, "deeper nesting", fmt::format("at most {} levels", max_depth));
    if (const toml::table* table = node.as_table()) return convert_table(*table, path, depth);
    if (const toml::array* array = node.as_array()) return convert_array(*array, path, depth);
    if (const auto* word = node.as_string()) return word->get();
    if (const auto* flag = node.as_boolean()) return flag->get();
    if (const auto* integer = node.as_integer())
      return integer->get() < 0 ? json(integer->get()) : json(static_cast<std::uint64_t>(integer->get()));
    if (const auto* number = node.as_floating_point())
      return std::isfinite(number->get()) ? json(number->get()) : refuse(path, shortest(number->get()), "a finite number");
    return refuse(path, "a date or time", "numbers, words, lists and tables");
  }

 private:
  json convert_table(const toml::table& table, const std::string& path, std::size_t depth) {
    json out = json::object();
    for (const auto& [key, value] : table) out[std::string(key.str())] = convert(value, key_path(path, key.str()), depth + 1);
    return out;
  }

  json convert_array(const toml::array& array, const std::string& path, std::size_t depth) {
    json out = json::array();
    for (const toml::node& value : array) out.push_back(convert(value, key_path(path, out.size()), depth + 1));
    return out;
  }

  json refuse(const std::string& path, std::string value, std::string limit) {
    problems_.add(path, std::move(value), std::move(limit));
    return nullptr;
  }

  CampaignFile& file_;
  ProblemList& problems_;
};

Parsed<CampaignFile> read_toml(std::string_view text, CampaignFile file) {
  ProblemList problems;
  try {
    const toml::table table = toml::parse(text, file.name);
    file.value = std::make_shared<const json>(TomlReader(file, problems).convert(table, ""));
  } catch (const toml::parse_error& mistake) {
    const auto at = mistake.source().begin;
    return tl::unexpected(Problems{
        {fmt::format("{}:{}", file.name, at.line), std::string(mistake.description()), "TOML text", fmt::format("column {}", at.column)}});
  }
  if (problems.empty()) return file;
  Problems found = problems.take();
  for (Problem& problem : found) problem.key = file.place(problem.key);
  return tl::unexpected(std::move(found));
}

}  // namespace

std::string CampaignFile::place(std::string_view key) const {
  std::string_view near = key;
  while (!near.empty() && !lines.contains(std::string(near))) {
    const std::size_t cut = near.find_last_of(".[");
    near = near.substr(0, cut == std::string_view::npos ? 0 : cut);
  }
  if (near.empty()) return fmt::format("{}: {}", name, key);
  return fmt::format("{}:{}: {}", name, lines.at(std::string(near)), key);
}

Parsed<CampaignFile> read_campaign_file(std::string_view text, std::string_view name) {
  CampaignFile file{.value = nullptr, .lines = {}, .name = std::string(name)};
  const JsonBounds bounds{.max_bytes = max_bytes, .max_depth = max_depth};
  if (text.size() > bounds.max_bytes)
    return tl::unexpected(Problems{{file.name, bytes_text(text.size()), fmt::format("at most {}", bytes_text(bounds.max_bytes)), ""}});
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || text[first] != '{') return read_toml(text, std::move(file));
  Parsed<json> value = read_json(text, name, bounds);
  if (!value) return tl::unexpected(std::move(value.error()));
  file.value = std::make_shared<const json>(std::move(*value));
  return file;
}

}  // namespace fracfarm
