#include "common/failure/failure.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace fracfarm {
namespace {

constexpr std::array<std::pair<Verdict, std::string_view>, 4> verdict_names{{
    {Verdict::failed, "failed"},
    {Verdict::censored, "censored"},
    {Verdict::rejected, "rejected"},
    {Verdict::diverged, "diverged"},
}};

// The criteria that may decide, the first that was met; the others only count in the confidence.
struct MethodRow {
  std::string_view method;
  std::array<std::string_view, 2> deciding;
};
constexpr std::array<MethodRow, 2> methods{{
    {"phase_field", {"through_crack", "stress_drop"}},
    {"fdem", {"five_step", "drop10"}},
}};

std::span<const std::string_view> deciding_of(std::string_view method) {
  const auto row = std::find_if(methods.begin(), methods.end(), [&](const MethodRow& m) { return m.method == method; });
  return row == methods.end() ? std::span<const std::string_view>{} : row->deciding;
}

const FailureTime* find_time(std::span<const FailureTime> times, std::string_view rule) {
  const auto found = std::find_if(times.begin(), times.end(), [&](const FailureTime& t) { return t.rule == rule && t.time; });
  return found == times.end() ? nullptr : &*found;
}

double ratio(double a, double b) { return std::max(a, b) > 0.0 ? std::max(0.0, std::min(a, b)) / std::max(a, b) : 1.0; }

// 1 - 0.5 where only one of the two is there.
double agreement(const std::optional<double>& chosen, const std::optional<double>& other) {
  if (chosen && other) return ratio(*chosen, *other);
  return chosen || other ? 0.5 : 1.0;
}

double confidence_of(std::span<const FailureTime> times, const std::optional<double>& chosen, std::string_view rule) {
  double sum = 0.0;
  int others = 0;
  for (const FailureTime& candidate : times)
    if (candidate.rule != rule) sum += agreement(chosen, candidate.time), ++others;
  return others ? sum / others : 0.0;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  for (const auto& [value, name] : verdict_names)
    if (value == verdict) return name;
  return "unknown";
}

std::optional<Verdict> verdict_by_name(std::string_view name) {
  for (const auto& [value, known] : verdict_names)
    if (known == name) return value;
  return std::nullopt;
}

std::optional<double> stress_drop(std::span<const double> time, std::span<const double> stress, double fraction) {
  assert(time.size() == stress.size());
  const auto peak = std::max_element(stress.begin(), stress.end());
  if (peak == stress.end() || !(*peak > 0.0)) return std::nullopt;
  const auto low = std::find_if(peak, stress.end(), [&](double value) { return value < fraction * *peak; });
  if (low == stress.end()) return std::nullopt;
  return time[static_cast<std::size_t>(low - stress.begin())];
}

Judgement judge(std::string_view method, std::span<const FailureTime> times, std::string_view otherwise) {
  Judgement judgement;
  judgement.rule = otherwise;
  for (std::string_view rule : deciding_of(method)) {
    const FailureTime* found = find_time(times, rule);
    if (!found) continue;
    judgement.verdict = Verdict::failed;
    judgement.time_to_failure = found->time;
    judgement.rule = rule;
    break;
  }
  judgement.confidence = confidence_of(times, judgement.time_to_failure, judgement.rule);
  return judgement;
}

std::optional<double> disagreement(std::span<const FailureTime> times) {
  std::vector<double> met;
  for (const FailureTime& candidate : times)
    if (candidate.time) met.push_back(*candidate.time);
  if (met.size() < 2) return std::nullopt;
  const auto [shortest, longest] = std::minmax_element(met.begin(), met.end());
  return *longest - *shortest;
}

std::optional<double> of_broken_body(std::optional<double> time, std::span<const double> break_time) {
  const bool broke = time && std::any_of(break_time.begin(), break_time.end(), [&](double edge) { return edge <= broken_soon_after * *time; });
  return broke ? time : std::nullopt;
}

}  // namespace fracfarm
