#include "common/failure/failure.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace fracfarm;

TEST_CASE("every verdict has a name that reads back") {
  for (Verdict verdict : {Verdict::failed, Verdict::censored, Verdict::rejected, Verdict::diverged})
    CHECK(verdict_by_name(name_of(verdict)) == verdict);
  CHECK_FALSE(verdict_by_name("FAILED"));
}

TEST_CASE("stress drop is the first sample after the peak that is below a tenth of it") {
  const std::vector<double> time{0, 1, 2, 3, 4, 5}, stress{0, 0.5, 10, 1.0, 0.99, 0};
  CHECK(stress_drop(time, stress) == 4.0);  // 1.0 is a tenth itself: not below
  CHECK(stress_drop(time, stress, 0.5) == 3.0);
}

TEST_CASE("stress drop does not look before the peak, and needs one") {
  CHECK_FALSE(stress_drop(std::vector<double>{0, 1, 2}, std::vector<double>{0, 1, 10}));
  CHECK_FALSE(stress_drop(std::vector<double>{0, 1}, std::vector<double>{-1, -2}));
  CHECK_FALSE(stress_drop({}, {}));
}

TEST_CASE("the through crack decides before the stress drop") {
  const std::vector<FailureTime> times{{"through_crack", 2e-4}, {"stress_drop", 1e-4}, {"five_step", std::nullopt}};
  const Judgement judgement = judge("phase_field", times, "horizon");
  CHECK(judgement.verdict == Verdict::failed);
  CHECK(judgement.time_to_failure == 2e-4);
  CHECK(judgement.rule == "through_crack");
  CHECK(judgement.confidence == Approx((0.5 + 0.5) / 2.0));  // half the time; one criterion silent
}

TEST_CASE("lost stress without a through crack is failed by stress drop") {
  const Judgement judgement = judge(
      "phase_field", std::vector<FailureTime>{{"through_crack", std::nullopt}, {"stress_drop", 1e-4}, {"five_step", 1.25e-4}}, "horizon");
  CHECK(judgement.verdict == Verdict::failed);
  CHECK(judgement.rule == "stress_drop");
  CHECK(judgement.time_to_failure == 1e-4);
  CHECK(judgement.confidence == Approx((0.5 + 0.8) / 2.0));
}

TEST_CASE("kept stress is censored, and the five-step pick alone does not decide") {
  const Judgement silent =
      judge("phase_field", std::vector<FailureTime>{{"through_crack", std::nullopt}, {"stress_drop", std::nullopt}}, "horizon");
  CHECK(silent.verdict == Verdict::censored);
  CHECK_FALSE(silent.time_to_failure);
  CHECK(silent.rule == "horizon");
  CHECK(silent.confidence == 1.0);
  const Judgement picked =
      judge("phase_field", std::vector<FailureTime>{{"through_crack", std::nullopt}, {"five_step", 1e-4}}, "wall_clock");
  CHECK(picked.verdict == Verdict::censored);
  CHECK(picked.rule == "wall_clock");
  CHECK(picked.confidence == Approx(0.75));
}

TEST_CASE("criteria that agree give full confidence, and a lone one gives none") {
  CHECK(judge("phase_field", std::vector<FailureTime>{{"through_crack", 3e-4}, {"stress_drop", 3e-4}}, "horizon").confidence == 1.0);
  CHECK(judge("phase_field", std::vector<FailureTime>{{"through_crack", 3e-4}}, "horizon").confidence == 0.0);
  CHECK(judge("phase_field", {}, "horizon").confidence == 0.0);
}

TEST_CASE("in FDEM the five-step pick decides where it exists, else drop10") {
  const std::vector<FailureTime> both{{"drop10", 1e-4}, {"five_step", 2e-4}};
  CHECK(judge("fdem", both, "horizon").rule == "five_step");
  CHECK(judge("fdem", both, "horizon").time_to_failure == 2e-4);
  CHECK(judge("fdem", both, "horizon").confidence == 0.5);
  const Judgement dropped = judge("fdem", std::vector<FailureTime>{{"drop10", 1e-4}, {"five_step", std::nullopt}}, "horizon");
  CHECK(dropped.verdict == Verdict::failed);
  CHECK(dropped.rule == "drop10");
  CHECK(dropped.time_to_failure == 1e-4);
  const Judgement neither = judge("fdem", std::vector<FailureTime>{{"drop10", std::nullopt}, {"five_step", std::nullopt}}, "horizon");
  CHECK(neither.verdict == Verdict::censored);
  CHECK(neither.rule == "horizon");
  CHECK_FALSE(neither.time_to_failure);
}

TEST_CASE("a method without criteria is censored whatever its candidates say") {
  CHECK(judge("drill", std::vector<FailureTime>{{"through_crack", 1e-4}, {"drop10", 1e-4}}, "horizon").verdict == Verdict::censored);
  CHECK(judge("fdem", std::vector<FailureTime>{{"through_crack", 1e-4}}, "horizon").verdict == Verdict::censored);
}

TEST_CASE("criteria disagree by the seconds between the first and the last of them") {
  CHECK(disagreement(std::vector<FailureTime>{{"drop10", 1.0}, {"five_step", 3.0}, {"through_crack", 2.5}}) == 2.0);
  CHECK_FALSE(disagreement(std::vector<FailureTime>{{"drop10", 1.0}, {"five_step", std::nullopt}}));
}

TEST_CASE("a time at which nothing had broken is no failure") {
  const std::vector<double> broke{std::nan(""), 2e-4, 3e-4};
  CHECK(of_broken_body(2e-4, broke) == 2e-4);
  CHECK(of_broken_body(1.7e-4, broke) == 1.7e-4);  // broken 18 % later
  CHECK_FALSE(of_broken_body(1.5e-4, broke));
  CHECK_FALSE(of_broken_body(std::nullopt, broke));
  CHECK_FALSE(of_broken_body(1.0, std::vector<double>{std::nan("")}));
  CHECK_FALSE(of_broken_body(1.0, {}));
}
