// The grammar of a campaign file; one line a key. Settings are proven by making their scenes.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "common/scene/fields.hpp"
#include "coordinator/campaign.hpp"
#include "coordinator/campaign_block.hpp"
#include "coordinator/campaign_file.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr std::size_t max_blocks = 100;
constexpr std::uint64_t max_jobs = 1'000'000'000;

bool plain_name(std::string_view name) {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), good);
}

void read_name(Fields& top, Campaign& campaign) {
  const json* value = top.value("name");
  if (!value) return;
  if (value->is_string() && plain_name(value->get_ref<const std::string&>()))
    campaign.name = value->get<std::string>();
  else
    top.problems().add("name", printed(*value), "1 to 64 of a-z A-Z 0-9 . _ -");
}

void read_jobs(Fields& top, Campaign& campaign) {
  const json* value = top.value("jobs");
  if (!value) return;
  if (!value->is_array() || value->empty() || value->size() > max_blocks) {
    top.problems().add("jobs", printed(*value), fmt::format("1 to {} blocks of jobs", max_blocks), "begin each with [[jobs]]");
    return;
  }
  for (std::size_t i = 0; i < value->size(); ++i) campaign.blocks.push_back(read_block((*value)[i], key_path("jobs", i), top.problems()));
}

// "8h", "90 s", "1.5 min", "2d" in seconds.
std::optional<double> duration(std::string_view text) {
  struct Unit {
    std::string_view name;
    double seconds;
  };
  static constexpr std::array<Unit, 5> units{{{"s", 1}, {"min", 60}, {"m", 60}, {"h", 3600}, {"d", 86400}}};
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  std::string_view rest = text.substr(static_cast<std::size_t>(end - text.data()));
  while (rest.starts_with(' ')) rest.remove_prefix(1);
  for (const Unit& unit : units)
    if (rest == unit.name) return number * unit.seconds;
  return std::nullopt;
}

void read_budget(Fields& top, Campaign& campaign) {
  const json* value = top.value("budget");
  if (!value) return;
  Fields fields(*value, "budget", top.problems());
  if (const json* wall = fields.value("wall_clock")) {
    static constexpr Range range{0.1, 30.0 * 86400.0, "s"};
    const std::optional<double> seconds = wall->is_string()   ? duration(wall->get_ref<const std::string&>())
                                          : wall->is_number() ? wall->get<double>()
                                                              : std::optional<double>();
    if (seconds && range.holds(*seconds))
      campaign.wall_budget_s = *seconds;
    else
      top.problems().add(fields.path("wall_clock"), printed(*wall),
                         "0.1 s to 30 d, as \"8h\", \"30min\", \"90s\", \"2d\" or a number of seconds");
  }
  std::uint64_t attempts = static_cast<std::uint64_t>(campaign.attempts);
  if (fields.integer("attempts", 1, 100, attempts)) campaign.attempts = static_cast<int>(attempts);
  fields.done();
}

void read_output(Fields& top, Campaign& campaign) {
  const json* value = top.value("output");
  if (!value) return;
  Fields fields(*value, "output", top.problems());
  if (const json* store = fields.value("store")) {
    const auto control = [](char c) { return static_cast<unsigned char>(c) < 32; };
    const std::string text = store->is_string() ? store->get<std::string>() : "";
    if (!text.empty() && text.size() <= 1024 && std::none_of(text.begin(), text.end(), control))
      campaign.store = text;
    else
      top.problems().add(fields.path("store"), printed(*store), "a folder name of 1 to 1024 characters");
  }
  fields.done();
}

// The same campaign with one block, of one pattern. What a mistake left empty is filled in, so that its settings are checked all the same.
Campaign first_pattern(const Campaign& campaign, std::size_t block) {
  Campaign one = campaign;
  one.blocks = {campaign.blocks[block]};
  JobBlock& only = one.blocks[0];
  if (only.materials.empty()) only.materials = {material_table().front().name};
  if (only.loads.empty()) only.loads = {std::string(named_loads.front().name)};
  IdRange range = only.patterns.empty() ? IdRange{} : only.patterns.front();
  range.last = range.first;
  only.patterns = {range};
  return one;
}

// Makes the scenes of each block's first pattern: whatever settings can do wrong shows in one of them, since patterns differ in cracks
// alone.
void check_settings(const Campaign& campaign, ProblemList& problems) {
  for (std::size_t block = 0; block < campaign.blocks.size(); ++block) {
    if (campaign.blocks[block].set.empty()) continue;
    const Campaign one = first_pattern(campaign, block);
    const std::uint64_t jobs = job_count(one);
    for (std::uint64_t i = 0; i < jobs; ++i) {
      const Parsed<Scene> scene = try_scene_of(one, job_at(one, i));
      if (scene) continue;
      for (const Problem& p : scene.error()) problems.add(fmt::format("jobs[{}].set.{}", block, p.key), p.value, p.limit, p.suggestion);
    }
  }
}

Parsed<Campaign> campaign_from(const json& value) {
  ProblemList problems;
  Campaign campaign;
  Fields top(value, "", problems);
  top.require({"name", "seed", "jobs"});
  read_name(top, campaign);
  top.integer("seed", 0, UINT64_MAX, campaign.seed);
  read_jobs(top, campaign);
  read_budget(top, campaign);
  read_output(top, campaign);
  top.done();
  check_settings(campaign, problems);
  if (problems.empty() && job_count(campaign) > max_jobs)
    problems.add("jobs", fmt::format("{} jobs", job_count(campaign)), fmt::format("at most {} jobs", max_jobs), "split the campaign");
  if (!problems.empty()) return tl::unexpected(problems.take());
  return campaign;
}

}  // namespace

Parsed<Campaign> parse_campaign(std::string_view text, std::string_view file_name) {
  Parsed<CampaignFile> file = read_campaign_file(text, file_name);
  if (!file) return tl::unexpected(std::move(file.error()));
  Parsed<Campaign> campaign = campaign_from(*file->value);
  if (campaign) return campaign;
  for (Problem& problem : campaign.error()) problem.key = file->place(problem.key);
  return campaign;
}

}  // namespace fracfarm
