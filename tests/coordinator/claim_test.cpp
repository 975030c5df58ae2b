#include "coordinator/claim.hpp"

#include <catch2/catch.hpp>

using namespace fracfarm;

namespace {

const JobClass quick{"phase_field", "pbx", "uniaxial"}, slow{"phase_field", "steel", "biaxial"};
std::map<JobClass, Learned> history(std::uint64_t n) { return {{quick, {n, 0.5, 1.0, 0.0}}, {slow, {n, 500.0, 1000.0, 0.0}}}; }
Candidate job(std::int64_t id, const JobClass& job_class = quick) { return {id, job_class, 3600.0, {}}; }

}  // namespace

TEST_CASE("Jobs are handed out in order, at most as many as there are free slots") {
  const std::vector<Candidate> jobs{job(5), job(3), job(9)};
  CHECK(claim(jobs, {"n1", 2, -1.0}, {}, {}) == std::vector<std::size_t>{0, 1});
  CHECK(claim(jobs, {"n1", -7, -1.0}, {}, {}).empty());
}

TEST_CASE("Nobody is handed what does not fit the time that is left") {
  const std::vector<Candidate> jobs{job(1, slow), job(2, quick)};
  CHECK(claim(jobs, {"n1", 2, 60.0}, history(enough_history), {}) == std::vector<std::size_t>{1});
  CHECK(claim(jobs, {"n1", 2, 60.0}, history(enough_history - 1), {}).empty());  // too little history: the hard budget counts
  CHECK(claim(jobs, {"n1", 2, 4000.0}, {}, {}).size() == 2);
}

TEST_CASE("The longest time of a class never exceeds the hard budget") {
  Candidate it = job(1, slow);
  it.wall_budget_s = 100.0;
  CHECK(longest_s(it, history(1000)) == 100.0 + flush_s);
}

TEST_CASE("A job that failed on a node goes to another where there is one, else back to the same") {
  Candidate it = job(1);
  it.failed_on = {"n1"};
  const std::vector<Candidate> jobs{it};
  CHECK(claim(jobs, {"n1", 1, -1.0}, {}, {"n1", "n2"}).empty());
  CHECK(claim(jobs, {"n2", 1, -1.0}, {}, {"n1", "n2"}).size() == 1);
  CHECK(claim(jobs, {"n1", 1, -1.0}, {}, {"n1"}).size() == 1);
  it.failed_on = {"n1", "n2"};
  CHECK(claim(std::vector<Candidate>{it}, {"n1", 1, -1.0}, {}, {"n1", "n2"}).size() == 1);
}

TEST_CASE("Run times are learned by the type of the node; where it has too few results, all nodes count with a wider margin") {
  LearnedTimes learned;
  learned.all[quick] = {enough_history, 0.5, 10.0, 0.0};
  CHECK(longest_try(quick, 3600.0, learned, "old").seconds == Approx(other_type_margin * 10.0 + flush_s));
  learned.by_node[{quick, "old"}] = {enough_history - 1, 5.0, 40.0, 0.0};
  CHECK(longest_try(quick, 3600.0, learned, "old").seconds == Approx(other_type_margin * 10.0 + flush_s));
  learned.by_node[{quick, "old"}].n = enough_history;
  CHECK(longest_try(quick, 3600.0, learned, "old").seconds == Approx(history_margin * 40.0 + flush_s));
  CHECK_FALSE(longest_try(slow, 3600.0, learned, "old").learned);
  CHECK(longest_try(slow, 3600.0, learned, "old").seconds == 3600.0 + flush_s);
}

TEST_CASE("Jobs behind those that fill the slots must fit behind them") {
  const LearnedTimes learned{history(enough_history), {}};
  Claim taking({.node = "n1", .free_slots = 100, .remaining_s = 40.0, .slots = 2}, learned);
  int taken = 0;
  while (taking.left() > 0 && taking.fits(quick, 3600.0)) taking.take(quick, 3600.0), ++taken;
  // Each takes 1.5 x 1 s + 10 s at most: two at once, then one more every 5.75 s.
  CHECK(taken == 5);
}

TEST_CASE("What is left of an allocation is filled with what still fits") {
  std::vector<Candidate> jobs;
  for (int n = 0; n < 5; ++n) jobs.push_back(job(n, n % 2 ? quick : slow));
  CHECK(claim(jobs, {"n1", 5, 100.0}, history(enough_history), {}) == std::vector<std::size_t>{1, 3});
}

TEST_CASE("A job that wants more memory is left to a larger node where there is one") {
  Candidate it = job(1);
  it.memory_floor = 100;
  const auto may_have = [&](std::uint64_t own, std::uint64_t most) {
    return !claim(std::vector<Candidate>{it}, {.node = "n1", .free_slots = 1, .slot_memory = own, .most_memory = most}, {}, {}).empty();
  };
  CHECK(may_have(101, 101));
  CHECK_FALSE(may_have(100, 101));
  CHECK(may_have(100, 100));
  CHECK(may_have(50, 80));
}
