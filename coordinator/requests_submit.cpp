// Requests about a whole campaign: submit it, and what of it is here already. Either may be asked twice with the same end.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "coordinator/enrolment.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/requests_parts.hpp"

namespace fracfarm::desk {
namespace {

// Jobs of another solver build than `build_id` that are not settled: two builds at work in one farm would mix their results.
std::uint64_t unfinished_of_other_builds(Database& ledger, const std::string& build_id, std::string& other) {
  std::uint64_t unfinished = 0;
  const std::vector<CountRow> counts = count_rows(ledger);
  for (const CampaignRow& campaign : campaign_rows(ledger)) {
    if (campaign.build_id == build_id) continue;
    std::uint64_t left = campaign.total - campaign.expanded;
    for (const CountRow& row : counts)
      if (row.campaign == campaign.id && !state_row(row.state).settled) left += row.n;
    if (left > 0) other = campaign.build_id;
    unfinished += left;
  }
  return unfinished;
}

}  // namespace

wire::Answer submit(const Desk& desk, const nlohmann::json& arguments) {
  Database& ledger = desk.ledger.reading();
  const std::string text = text_of(arguments, "campaign");
  const Parsed<Campaign> campaign = parse_campaign(text, "campaign");
  if (!campaign) return answer_problems(campaign.error(), "campaign");
  std::string other;
  if (const std::uint64_t unfinished = unfinished_of_other_builds(ledger, desk.build_id, other); unfinished > 0)
    return answer_error(
        exit_bad_input,
        fmt::format(
            "this farm has {} unfinished jobs for solver build {}, this program is build {}: finish them with that build, cancel them "
            "(fracfarm cancel --state READY), or use another farm (--farm)",
            unfinished, other, desk.build_id));
  const std::int64_t id =
      desk.ledger.add_campaign(campaign->name, canonical_text(*campaign), desk.build_id, job_count(*campaign), desk.now.wall_s);
  if (meta_value(ledger, "build_id") != desk.build_id) desk.ledger.set_build_id(desk.build_id);
  if (const Result<void> made = enrol(desk.ledger, desk.book, id); !made) return answer_error(exit_failed, made.error().message);
  const CampaignRow row = campaign_row(ledger, id).value();
  return answer_json({{"schema", "fracfarm.submit/1"},
                      {"campaign", id},
                      {"name", row.name},
                      {"total", row.total},
                      {"expanded", row.expanded},
                      {"shared", row.shared},
                      {"added", row.expanded - row.shared},
                      {"complete", row.expanded == row.total}});
}

wire::Answer known(const Desk& desk, const nlohmann::json& arguments) {
  const Parsed<Campaign> campaign = parse_campaign(text_of(arguments, "campaign"), "campaign");
  if (!campaign) return answer_problems(campaign.error(), "campaign");
  const Known known = known_jobs(desk.ledger.reading(), desk.book, *campaign, desk.build_id);
  return answer_json({{"schema", "fracfarm.known/2"}, {"present", known.present}, {"done", known.done}});
}

}  // namespace fracfarm::desk
