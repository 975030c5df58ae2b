#include "coordinator/retry_policy.hpp"

#include <catch2/catch.hpp>

using namespace fracfarm;

namespace {

AttemptRow fault_on(Fault fault, const std::string& node, const std::string& signature = "") {
  AttemptRow row;
  row.fault = fault_row(fault).name;
  row.node = node;
  row.signature = signature;
  return row;
}

RetryDecision after(const std::vector<AttemptRow>& history, int attempts = 100) {
  Job job;
  job.id = 1;
  return decide_retry(job, history, attempts);
}

}  // namespace

TEST_CASE("Each class is tried again as often as its row of the table says, then quarantined") {
  for (const FaultRow& row : fault_table) {
    if (row.job_budget == 0) continue;
    std::vector<AttemptRow> history;
    for (int n = 1; n <= row.job_budget; ++n) {
      history.push_back(fault_on(row.fault, "n1"));
      INFO(row.name << " " << n);
      CHECK(after(history).state == State::retry_wait);
    }
    history.push_back(fault_on(row.fault, "n1"));
    CHECK(after(history).state == State::quarantined);
  }
}

TEST_CASE("A planned stop makes a job ready at once and counts nothing") {
  std::vector<AttemptRow> history(50, fault_on(Fault::planned_stop, "n1"));
  CHECK(after(history, 1).state == State::ready);
}

TEST_CASE("The same signature on two nodes quarantines with both named, on one node it does not") {
  CHECK(after({fault_on(Fault::solver_crash, "n1", "signal 11"), fault_on(Fault::solver_crash, "n1", "signal 11")}).state ==
        State::retry_wait);
  const RetryDecision decision =
      after({fault_on(Fault::solver_crash, "n1", "signal 11"), fault_on(Fault::solver_crash, "n2", "signal 11")});
  CHECK(decision.state == State::quarantined);
  CHECK(decision.why.find("n1") != std::string::npos);
  CHECK(decision.why.find("n2") != std::string::npos);
}

TEST_CASE("Lost nodes never prove that the job is to blame") {
  CHECK(after({fault_on(Fault::node_lost, "n1", "lease_timeout"), fault_on(Fault::node_lost, "n2", "lease_timeout")}, 1).state ==
        State::retry_wait);
}

TEST_CASE("A diverged run is tried once with half the step, also where two nodes agree") {
  const RetryDecision once = after({fault_on(Fault::solver_numeric, "n1", "not finite")});
  CHECK(once.state == State::retry_wait);
  CHECK(once.step_scale == 0.5);
  CHECK(after({fault_on(Fault::solver_numeric, "n1", "x"), fault_on(Fault::solver_numeric, "n2", "x")}).state == State::quarantined);
}

TEST_CASE("The campaign's attempts cap what counts against the job") {
  const std::vector<AttemptRow> two{fault_on(Fault::solver_crash, "n1"), fault_on(Fault::out_of_memory, "n1")};
  CHECK(after(two, 3).state == State::retry_wait);
  CHECK(after(two, 2).state == State::quarantined);
}

TEST_CASE("Backoff doubles, is bounded and differs from job to job") {
  CHECK(backoff_s(1, 1) >= 0.75);
  CHECK(backoff_s(1, 1) <= 1.25);
  CHECK(backoff_s(3, 1) == Approx(4.0 * backoff_s(1, 1)));
  CHECK(backoff_s(50, 1) <= 375.0);
  CHECK(backoff_s(1, 1) != backoff_s(1, 2));
}
