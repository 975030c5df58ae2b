// fracfarm failures: how tries ended badly, and with --explain which values of the jobs' parameters stand out among those that failed.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/scene/parse.hpp"
#include "coordinator/campaign.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/overrepresented.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

constexpr std::size_t most_shown = 20;
constexpr double believed = 0.01;  // p below it is shown as standing out

// What a job is, in words of few values. Lengths in octaves, so that near ones go together.
Features features_of(const Campaign& campaign, const JobSpec& spec) {
  Features it{{"method", std::string(name_of(spec.method))},
              {"material", spec.material},
              {"load", spec.load},
              {"crack set", std::string(name_of(spec.set))}};
  for (const auto& [key, value] : spec.settings) it[key] = value;
  const Scene scene = scene_of(campaign, spec);
  double total = 0.0, longest = 0.0;
  for (const Segment& crack : scene.cracks) {
    const double length = std::hypot(crack.x1 - crack.x0, crack.z1 - crack.z0);
    total += length;
    longest = std::max(longest, length);
  }
  const auto octave = [&](double length) {
    const double top = std::exp2(std::ceil(std::log2(std::max(length / scene.width, 1e-3)))) * scene.width;
    return fmt::format("{} to {}", engineering(top / 2.0, "m"), engineering(top, "m"));
  };
  it["number of cracks"] = std::to_string(scene.cracks.size());
  it["total crack length"] = octave(total);
  it["longest crack"] = octave(longest);
  return it;
}

std::vector<Features> features_of(const json& places, const std::map<std::int64_t, Campaign>& campaigns) {
  std::vector<Features> list;
  for (const json& place : places) {
    const auto campaign = campaigns.find(place.at(0).get<std::int64_t>());
    const auto position = place.at(1).get<std::uint64_t>();
    if (campaign != campaigns.end() && position < job_count(campaign->second))
      list.push_back(features_of(campaign->second, job_at(campaign->second, position)));
  }
  return list;
}

std::map<std::int64_t, Campaign> campaigns_of(const json& texts) {
  std::map<std::int64_t, Campaign> campaigns;
  for (const auto& [id, text] : texts.items())
    if (Parsed<Campaign> campaign = parse_campaign(text.get<std::string>(), "campaign"))
      campaigns.emplace(std::stoll(id), std::move(*campaign));
  return campaigns;
}

json standing_json(const json& cases) {
  const std::map<std::int64_t, Campaign> campaigns = campaigns_of(cases["campaigns"]);
  const std::vector<Features> failed = features_of(cases["failed"], campaigns), sound = features_of(cases["sound"], campaigns);
  json list = json::array();
  for (const Standing& it : standing_out(failed, sound, cases.value("every", 1.0)))
    list.push_back({{"feature", it.feature},
                    {"value", it.value},
                    {"failed_with", it.failed_with},
                    {"failed", it.failed},
                    {"sound_with", it.sound_with},
                    {"sound", it.sound},
                    {"lift", it.lift},
                    {"share_low", it.low},
                    {"share_high", it.high},
                    {"p", it.p}});
  return list;
}

std::string groups_text(const json& groups) {
  if (groups.empty()) return "no try has failed\n";
  std::vector<std::vector<std::string>> rows{{"fault", "signature", "material", "load", "tries", "jobs", "nodes", "a job", "last"}};
  for (const json& it : groups)
    rows.push_back({it.value("fault", ""), it.value("signature", ""), it.value("material", ""), it.value("load", ""),
                    std::to_string(it.value("attempts", 0)), std::to_string(it.value("jobs", 0)), std::to_string(it.value("nodes", 0)),
                    std::to_string(it.value("example", 0)), it.value("last_at", "")});
  return table_text(rows);
}

std::string standing_text(const json& list) {
  if (list.empty()) return "\nno job has failed for a reason of its own: nothing to explain\n";
  std::vector<std::vector<std::string>> rows{{"parameter", "value", "failed", "sound", "lift", "share of the failed (95 %)", "p"}};
  for (const json& it : list)
    if (it["p"] < believed && it["lift"] > 1.0 && rows.size() <= most_shown)
      rows.push_back({it["feature"], it["value"], fmt::format("{} of {}", it["failed_with"].get<int>(), it["failed"].get<int>()),
                      fmt::format("{} of {}", it["sound_with"].get<int>(), it["sound"].get<int>()),
                      fmt::format("{:.2f}", it["lift"].get<double>()),
                      fmt::format("{:.2f} to {:.2f}", it["share_low"].get<double>(), it["share_high"].get<double>()),
                      fmt::format("{:.1e}", it["p"].get<double>())});
  if (rows.size() == 1) return "\nno value of a parameter stands out among the jobs that failed\n";
  return fmt::format("\nstands out among the jobs that failed (Fisher's exact test, corrected for the number of values looked at):\n{}",
                     table_text(rows));
}

int failures(const FarmOptions& options, bool explain) {
  Result<FarmLink> link = FarmLink::open(options.farm);
  if (!link) return report_unreachable(link.error(), options.json);
  const Result<wire::Answer> groups = link->ask("failures", json::object());
  if (!groups) return report_unreachable(groups.error(), options.json);
  json body = json::parse(groups->body);
  if (explain) {
    const Result<wire::Answer> cases = link->ask("cases", json::object());
    if (!cases) return report_unreachable(cases.error(), options.json);
    link = fail(Fault::planned_stop, "");  // lets go of the ledger
    body["standing_out"] = standing_json(json::parse(cases->body));
  }
  if (options.json) return fmt::print("{}\n", body.dump(2)), exit_ok;
  fmt::print("{}{}", groups_text(body["groups"]), explain ? standing_text(body["standing_out"]) : "");
  return exit_ok;
}

}  // namespace

int run_failures(int argc, char** argv) {
  FarmOptions options;
  bool explain = false;
  Command app{"How tries ended badly, by fault and signature; with --explain which parameters stand out among the jobs that failed.",
              "fracfarm failures"};
  add_farm_options(app, options);
  app.add_flag("--explain", explain, "compare failed with sound jobs: material, load, method, settings, cracks");
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] { return failures(options, explain); });
}

}  // namespace fracfarm::cli
