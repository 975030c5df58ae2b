#include "tests/simulation/known_bugs.hpp"

#include "coordinator/queries.hpp"

namespace fracfarm::simulation {
namespace {

// The first result gives way to the later one.
void overwrite(const wire::Completion& completion, Ledger& ledger) {
  const std::optional<Job> job = job_by_key(ledger.reading(), completion.key);
  if (!job || job->state != State::done || job->outcome->sha256 == completion.sha256) return;
  const std::string digest = bytes_of_hex(completion.sha256);
  ledger.reading().run("UPDATE jobs SET sha256 = ?2 WHERE id = ?1", job->id, Blob{digest});
}

void count_planned_stops(wire::Next& next, Ledger& ledger) {
  for (const wire::LeaseId& lease : next.returned)
    if (const std::optional<Job> job = job_by_lease(ledger.reading(), lease))
      next.failed.push_back({lease, job->key, Fault::node_lost, "was stopped", "stopped"});
  next.returned.clear();
}

}  // namespace

const KnownBugRow* known_bug(std::string_view name) {
  for (const KnownBugRow& row : known_bugs)
    if (row.name == name) return &row;
  return nullptr;
}

void spoil_request(KnownBug bug, wire::RequestEnvelope& envelope, Ledger& ledger, std::uint64_t& fresh_id) {
  if (bug == KnownBug::repeated_claim_served_again) envelope.request_id = ++fresh_id;
  if (auto* beat = std::get_if<wire::Beat>(&envelope.request); beat && bug == KnownBug::beats_not_heard) beat->held.clear();
  auto* next = std::get_if<wire::Next>(&envelope.request);
  if (!next) return;
  if (bug == KnownBug::result_overwritten)
    for (const wire::Completion& completion : next->completed) overwrite(completion, ledger);
  if (bug == KnownBug::planned_stop_counted) count_planned_stops(*next, ledger);
}

void spoil_reply(KnownBug bug, wire::Reply& reply) {
  if (auto* welcome = std::get_if<wire::Welcome>(&reply); welcome && bug == KnownBug::restart_forgets_leases)
    for (wire::Ruling& ruling : welcome->rulings) ruling = wire::Ruling::abandon;
}

void spoil_start(KnownBug bug, Database& ledger) {
  if (bug == KnownBug::epoch_not_raised)
    ledger.run("UPDATE meta SET value = CAST(CAST(value AS INTEGER) - 1 AS TEXT) WHERE name = 'epoch' AND CAST(value AS INTEGER) > 0");
  if (bug == KnownBug::counter_drift) ledger.run("UPDATE counts SET n = n + 1 WHERE state = 'LEASED' AND n > 0");
  if (bug == KnownBug::lost_wakeup) ledger.run("UPDATE jobs SET wait_s = 1e300 WHERE state = 'RETRY_WAIT'");
}

}  // namespace fracfarm::simulation
