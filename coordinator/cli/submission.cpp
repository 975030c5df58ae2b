#include "coordinator/cli/submission.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/clock.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"

namespace fracfarm::cli {
namespace {

constexpr double quiet_s = 2.0;  // shorter than this needs no progress

std::string making_text(const nlohmann::json& answer, double elapsed_s, double made) {
  const double total = answer.value("total", 0.0), expanded = answer.value("expanded", 0.0);
  const double left_s = made > 0.0 ? (total - expanded) * elapsed_s / made : 0.0;
  return fmt::format("making jobs: {} of {} · {} left", expanded, total, duration_text(left_s));
}

}  // namespace

Answered submit_and_wait(FarmLink& link, const Campaign& campaign, bool json) {
  const std::string text = canonical_text(campaign);
  SystemClock clock;
  const double began_s = clock.monotonic_s();
  double first = -1.0;
  ProgressLine line;
  bool shown = false;
  for (;;) {
    const Result<wire::Answer> answer = link.ask("submit", {{"campaign", text}});
    if (!answer) return {report_unreachable(answer.error(), json), {}, false};
    const nlohmann::json body = nlohmann::json::parse(answer->body);
    if (answer->exit_code != 0) return ask_and_report(link, "submit", {{"campaign", text}}, json);  // prints the refusal
    const double elapsed_s = clock.monotonic_s() - began_s;
    if (first < 0.0) first = body.value("expanded", 0.0);
    if (body.value("complete", false)) {
      if (shown) line.finish(fmt::format("{} jobs made in {}", body.value("expanded", 0.0) - first, duration_text(elapsed_s)));
      return {0, answer->body, true};
    }
    if (elapsed_s > quiet_s) line.show(making_text(body, elapsed_s, body.value("expanded", 0.0) - first)), shown = true;
    if (const Result<void> helped = link.help_expanding(); !helped) return {report_unreachable(helped.error(), json), {}, false};
  }
}

std::string submitted_text(const nlohmann::json& answer) {
  const std::uint64_t total = answer.value("total", std::uint64_t{0}), shared = answer.value("shared", std::uint64_t{0});
  const std::string was_there = shared ? fmt::format(", {} of them were here already", shared) : "";
  return fmt::format("campaign {}: {} jobs{}\n", answer.value("name", ""), total, was_there);
}

}  // namespace fracfarm::cli
