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
