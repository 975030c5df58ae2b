#include "coordinator/cli/submission.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace fracfarm::cli {

Answered submit(FarmLink& link, const Campaign& campaign, bool json) {
  const nlohmann::json arguments{{"campaign", canonical_text(campaign)}};
  const Result<wire::Answer> answer = link.ask("submit", arguments);
  if (!answer) return {report_unreachable(answer.error(), json), {}, false};
  if (answer->exit_code == 0) return {0, answer->body, true};
  return ask_and_report(link, "submit", arguments, json);  // prints the refusal
}

std::string submitted_text(const nlohmann::json& answer) {
  const std::uint64_t total = answer.value("total", std::uint64_t{0}), shared = answer.value("shared", std::uint64_t{0});
  const std::string was_there = shared ? fmt::format(", {} of them were here already", shared) : "";
  return fmt::format("campaign {}: {} jobs{}\n", answer.value("name", ""), total, was_there);
}

}  // namespace fracfarm::cli
