#include "coordinator/campaign.hpp"

#include <fmt/format.h>

#include <cassert>
#include <nlohmann/json.hpp>

#include "common/scene/json_text.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

std::uint64_t pattern_count(const JobBlock& block) {
  std::uint64_t count = 0;
  for (const IdRange& range : block.patterns) count += range.last - range.first + 1;
  return count;
}

std::uint64_t jobs_per_pattern(const JobBlock& block) {
  std::uint64_t count = block.materials.size() * block.loads.size();
  for (const SettingAxis& axis : block.set) count *= axis.values.size();
  return count;
}

// Takes the lowest digit, in a number system whose digits have `base` values, off `index`.
std::size_t take_digit(std::uint64_t& index, std::size_t base) {
  const std::size_t digit = index % base;
  index /= base;
  return digit;
}

std::string range_text(const JobBlock& block, CrackSet set) {
  std::string text;
  for (const IdRange& range : block.patterns) {
    if (range.set != set) continue;
    if (!text.empty()) text += ',';
    text += range.first == range.last ? fmt::format("{}", range.first) : fmt::format("{}-{}", range.first, range.last);
  }
  return text;
}

json axis_json(const SettingAxis& axis) {
  json list = json::array();
  for (const std::string& value : axis.values) list.push_back(json::parse(value));
  return list.size() == 1 ? list.front() : list;
}

json block_json(const JobBlock& block) {
  json patterns{{"redraw", block.redraw}};
  for (const CrackSet set : {CrackSet::orthogonal, CrackSet::oblique})
    if (std::string text = range_text(block, set); !text.empty()) patterns[std::string(name_of(set))] = std::move(text);
  json set = json::object();
  for (const SettingAxis& axis : block.set) set[axis.key] = axis_json(axis);
  json out{{"method", name_of(block.method)}, {"patterns", patterns}, {"set", set}};
  if (block.method != Method::drill) out.update({{"materials", block.materials}, {"loads", block.loads}});
  return out;
}

}  // namespace

std::string canonical_text(const Campaign& campaign) {
  json jobs = json::array();
  for (const JobBlock& block : campaign.blocks) jobs.push_back(block_json(block));
  return compact_text({{"name", campaign.name},
                       {"seed", campaign.seed},
                       {"jobs", std::move(jobs)},
                       {"budget", {{"wall_clock", campaign.wall_budget_s}, {"attempts", campaign.attempts}}},
                       {"output", {{"store", campaign.store}}}});
}

std::uint64_t job_count(const Campaign& campaign) {
  std::uint64_t count = 0;
  for (const JobBlock& block : campaign.blocks) count += pattern_count(block) * jobs_per_pattern(block);
  return count;
}

// Blocks and ranges are few (a campaign file names them one by one), so walking them costs less than an index over them would.
JobSpec job_at(const Campaign& campaign, std::uint64_t index) {
  assert(index < job_count(campaign));
  JobSpec job;
  while (index >= pattern_count(campaign.blocks[job.block]) * jobs_per_pattern(campaign.blocks[job.block])) {
    index -= pattern_count(campaign.blocks[job.block]) * jobs_per_pattern(campaign.blocks[job.block]);
    ++job.block;
  }
  const JobBlock& block = campaign.blocks[job.block];
  job.method = block.method;
  job.settings.resize(block.set.size());
  for (std::size_t axis = block.set.size(); axis-- > 0;)
    job.settings[axis] = {block.set[axis].key, block.set[axis].values[take_digit(index, block.set[axis].values.size())]};
  job.load = block.loads[take_digit(index, block.loads.size())];
  job.material = block.materials[take_digit(index, block.materials.size())];
  for (const IdRange& range : block.patterns) {
    job.set = range.set;
    job.sample_id = range.first + index;
    if (job.sample_id <= range.last) break;
    index -= range.last - range.first + 1;
  }
  return job;
}

Parsed<Scene> try_scene_of(const Campaign& campaign, const JobSpec& job) {
  if (job.method == Method::drill) return drill_sample({.set = job.set, .seed = campaign.seed, .id = job.sample_id}, job.settings);
  const SampleChoice choice{.material = find_material(job.material),
                            .load = find_load(job.load),
                            .set = job.set,
                            .seed = campaign.seed,
                            .id = job.sample_id,
                            .method = job.method};
  return sample_scene_with(choice, {.redraw = campaign.blocks.at(job.block).redraw}, job.settings);
}

Scene scene_of(const Campaign& campaign, const JobSpec& job) {
  Parsed<Scene> scene = try_scene_of(campaign, job);
  assert(scene && "parse_campaign made this scene before");
  return std::move(*scene);
}

}  // namespace fracfarm
