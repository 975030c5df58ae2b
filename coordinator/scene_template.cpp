#include "coordinator/scene_template.hpp"

#include <fmt/format.h>

#include <array>

#include "common/base/text.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm {
namespace {

constexpr std::array<std::uint64_t, 4> compared_ids{1, 2, 977, 123456};

void put(std::string& text, double value, char after) {
  text += shortest(value + 0.0);  // -0 becomes 0, as in canonical text
  text += after;
}

std::string cracks_text(const std::vector<Segment>& cracks) {
  std::string text = "[";
  for (const Segment& it : cracks) {
    text += text.size() > 1 ? ",[" : "[";
    put(text, it.x0, ','), put(text, it.z0, ','), put(text, it.x1, ','), put(text, it.z1, ']');
  }
  return text + ']';
}

std::string sample_text(CrackSet set, std::uint64_t seed, std::uint64_t id, const std::string& load) {
  return fmt::format(R"("sample":{{"id":{},"load":"{}","seed":{},"set":"{}"}})", id, load, seed, name_of(set));
}

std::string slow_text(const Campaign& campaign, JobSpec job, CrackSet set, std::uint64_t id) {
  job.set = set;
  job.sample_id = id;
  const Parsed<Scene> scene = try_scene_of(campaign, job);
  return scene ? canonical_text(*scene) : std::string();
}

}  // namespace

std::optional<SceneTemplate> SceneTemplate::cut(const Campaign& campaign, const JobSpec& job) {
  const Parsed<Scene> scene = try_scene_of(campaign, job);
  if (!scene || !scene->sample) return std::nullopt;
  const std::string text = canonical_text(*scene), cracks = "\"cracks\":" + cracks_text(scene->cracks);
  SceneTemplate made;
  made.load_ = scene->sample->load;
  made.seed_ = scene->sample->seed;
  made.pattern_ = {.width = scene->width, .height = scene->height, .redraw = campaign.blocks.at(job.block).redraw};
  const std::string sample = sample_text(job.set, made.seed_, job.sample_id, made.load_);
  const std::size_t at_cracks = text.find(cracks), at_sample = text.find(sample);
  if (at_sample == std::string::npos) return std::nullopt;
  made.has_cracks_ = at_cracks != std::string::npos && at_cracks + cracks.size() <= at_sample;
  const std::size_t end_of_cracks = made.has_cracks_ ? at_cracks + cracks.size() : 0;
  if (made.has_cracks_) made.before_ = text.substr(0, at_cracks) + "\"cracks\":";
  made.between_ = text.substr(end_of_cracks, at_sample - end_of_cracks);
  made.after_ = text.substr(at_sample + sample.size());
  return made;
}

std::optional<SceneTemplate> SceneTemplate::make(const Campaign& campaign, const JobSpec& job) {
  std::optional<SceneTemplate> made = cut(campaign, job);
  if (!made) return std::nullopt;
  for (const CrackSet set : {CrackSet::orthogonal, CrackSet::oblique})
    for (const std::uint64_t id : compared_ids)
      if (made->text(set, id) != slow_text(campaign, job, set, id)) return std::nullopt;
  return made;
}

std::string SceneTemplate::text(CrackSet set, std::uint64_t sample_id) const {
  std::string text = before_;
  if (has_cracks_) text += cracks_text(draw_pattern(set, seed_, sample_id, pattern_));
  text += between_;
  text += sample_text(set, seed_, sample_id, load_);
  return text += after_;
}

}  // namespace fracfarm
