// Classic errors of such a farm, put back in around the real parts to show that the harness finds them. They live in the tests alone: the
// programs have no switch for them.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "common/wire/messages.hpp"
#include "coordinator/ledger.hpp"

namespace fracfarm::simulation {

enum class KnownBug {
  none,
  acknowledge_before_commit,
  epoch_not_raised,
  identity_by_routing_id,
  retry_after_failed_sync,
  counter_drift,
  result_overwritten,
  planned_stop_counted,
  worker_clock_trusted,
  lost_wakeup,
  repeated_claim_served_again,
  beats_not_heard,
  report_before_sync,
  restart_forgets_leases,
};

struct KnownBugRow {
  KnownBug bug;
  std::string_view name;
  std::string_view breaks;  // the invariant that must be the first to fall
};
inline constexpr std::array<KnownBugRow, 13> known_bugs{{
    {KnownBug::acknowledge_before_commit, "acknowledge_before_commit", "I2"},
    {KnownBug::epoch_not_raised, "epoch_not_raised", "I4"},
    {KnownBug::identity_by_routing_id, "identity_by_routing_id", "I4"},
    {KnownBug::retry_after_failed_sync, "retry_after_failed_sync", "I2"},
    {KnownBug::counter_drift, "counter_drift", "I5"},
    {KnownBug::result_overwritten, "result_overwritten", "I1"},
    {KnownBug::planned_stop_counted, "planned_stop_counted", "I10"},
    {KnownBug::worker_clock_trusted, "worker_clock_trusted", "I4"},
    {KnownBug::lost_wakeup, "lost_wakeup", "I8"},
    {KnownBug::repeated_claim_served_again, "repeated_claim_served_again", "I4"},
    {KnownBug::beats_not_heard, "beats_not_heard", "I4"},
    {KnownBug::report_before_sync, "report_before_sync", "I3"},
    {KnownBug::restart_forgets_leases, "restart_forgets_leases", "I4"},
}};
const KnownBugRow* known_bug(std::string_view name);  // null: no such bug

// What a coordinator with the bug would have taken a request for, inside the transaction that answers it.
void spoil_request(KnownBug bug, wire::RequestEnvelope& envelope, Ledger& ledger, std::uint64_t& fresh_id);
// What it would have answered.
void spoil_reply(KnownBug bug, wire::Reply& reply);
// What it would have left in the ledger by the time that it starts again.
void spoil_start(KnownBug bug, Database& ledger);

}  // namespace fracfarm::simulation
