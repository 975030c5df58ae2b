#include "coordinator/cli/change.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace fracfarm::cli {
namespace {

using nlohmann::json;

std::string change_text(const json& answer, const ChangeWords& words) {
  const bool dry = answer.value("dry_run", false);
  const std::uint64_t n = answer.value("changed", std::uint64_t{0});
  std::string text = fmt::format("{}{} {}{}{}\n", dry ? "would be " : "", words.did, n, words.what, n == 1 ? "" : words.plural);
  for (const json& it : answer["refused"]) text += fmt::format("job {}: {}\n", it.value("job", 0), it.value("why", ""));
  return text;
}

}  // namespace

int change(const FarmOptions& options, const std::string& verb, const json& arguments, const ChangeWords& words) {
  return guarded(options, [&] {
    Result<FarmLink> link = FarmLink::open(options.farm);
    if (!link) return report_unreachable(link.error(), options.json);
    const Answered answer = ask_and_report(*link, verb, arguments, options.json);
    if (answer.usable) fmt::print("{}", change_text(json::parse(answer.body), words));
    return answer.exit_code;
  });
}

}  // namespace fracfarm::cli
