#include "coordinator/scene_template.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "common/scene/parse.hpp"
#include "coordinator/campaign_book.hpp"

using namespace fracfarm;

namespace {

Campaign campaign_with(const std::string& more, const std::string& method = "phase_field") {
  return parse_campaign(
             fmt::format(
                 R"({{"name": "t", "seed": 99, "jobs": [{{"method": "{}", "materials": ["pbx", "steel"], "loads": ["uniaxial", "biaxial"],
    "patterns": {{"orthogonal": "1-100000", "oblique": "1-100000"{}}}]}})",
                 method, more),
             "t")
      .value();
}

// Texts of jobs all over the campaign, made both ways.
void check_texts(const Campaign& campaign, int number) {
  const std::uint64_t total = job_count(campaign);
  std::map<std::string, std::optional<SceneTemplate>> made;
  for (int n = 0; n < number; ++n) {
    const std::uint64_t position = static_cast<std::uint64_t>(n) * 7919 * 131 % total;
    const JobSpec spec = job_at(campaign, position);
    const std::string series = fmt::format("{} {} {}", spec.material, spec.load, spec.settings.empty() ? "" : spec.settings.back().second);
    if (!made.contains(series)) made[series] = SceneTemplate::make(campaign, spec);
    REQUIRE(made[series]);
    REQUIRE(made[series]->text(spec.set, spec.sample_id) == canonical_text(scene_of(campaign, spec)));
  }
}

}  // namespace

TEST_CASE("A scene's text written from its series' template is the canonical one, for any pattern and setting") {
  check_texts(campaign_with("}"), 800);
  check_texts(campaign_with(R"(, "redraw": true})"), 400);
  check_texts(campaign_with(R"(}, "set": {"phase_field.cfl": [0.7, 0.8], "domain.width": 0.3, "material.density": 2000})"), 400);
}

TEST_CASE("A series whose cracks are set goes the slow way, or comes out the same") {
  const Campaign campaign = campaign_with(R"(}, "set": {"cracks": [[0.1, 0.1, 0.15, 0.1]]})");
  const auto made = SceneTemplate::make(campaign, job_at(campaign, 5));
  if (made) CHECK(made->text(CrackSet::orthogonal, 77) == canonical_text(scene_of(campaign, job_at(campaign, 4 * 76))));
}
