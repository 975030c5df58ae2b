#include "worker/judge.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "common/base/hash.hpp"
#include "common/base/text.hpp"
#include "common/record/check.hpp"

namespace fracfarm::worker {
namespace {

std::string time_text(const std::optional<double>& time) { return time ? shortest(*time) + " s" : std::string("none"); }

void compare(const Record& record, const Summary& summary, std::vector<std::string>& broken) {
  const Judgement& judgement = record.judgement;
  const bool same = judgement.verdict == summary.verdict && judgement.time_to_failure == summary.time_to_failure &&
                    judgement.rule == summary.failure_rule;
  if (!same)
    broken.push_back(fmt::format("summary: the record says {} {} ({}), the solver said {} {} ({})", name_of(judgement.verdict),
                                 time_text(judgement.time_to_failure), judgement.rule, name_of(summary.verdict),
                                 time_text(summary.time_to_failure), summary.failure_rule));
  if (!(record.peak_stress == summary.peak_stress))
    broken.push_back(fmt::format("summary: the record's peak stress is {} Pa, the solver said {} Pa", shortest(record.peak_stress),
                                 shortest(summary.peak_stress)));
}

}  // namespace

Result<void> judge_record(const std::string& bytes, const std::string& key, const Summary& summary) {
  if (const std::string digest = sha256_hex(bytes); digest != summary.record_sha256)
    return fail(Fault::output_bad,
                fmt::format("digest: the file's SHA-256 is {:.16}…, the solver said {:.16}…", digest, summary.record_sha256));
  const CheckedRecord checked = check_record_bytes(bytes, {.key = key});
  std::vector<std::string> broken;
  for (const Check& check : checked.checks)
    if (!check.passed)
      broken.push_back(fmt::format("{}: {} (value {}, limit {})", check.name, check.detail, shortest(check.value), shortest(check.limit)));
  if (checked.record) compare(*checked.record, summary, broken);
  if (!std::isfinite(summary.cpu_s) || !std::isfinite(summary.wall_s) || summary.steps < 0)
    broken.push_back("summary: a number is not finite");
  if (broken.empty()) return {};
  const std::vector<std::string_view> words(broken.begin(), broken.end());
  return fail(Fault::output_bad, join(words, "; "));
}

}  // namespace fracfarm::worker
