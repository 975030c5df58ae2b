#include "coordinator/cli/farm_verbs.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/atomic_file.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "coordinator/cli/options.hpp"

namespace fracfarm::cli {
namespace {

constexpr std::uint64_t most_campaign_bytes = 1u << 20;

Problems problems_of(const nlohmann::json& body) {
  Problems problems;
  for (const nlohmann::json& it : body.value("problems", nlohmann::json::array()))
    problems.push_back({it.value("key", ""), it.value("value", ""), it.value("limit", ""), it.value("suggestion", "")});
  return problems;
}

}  // namespace

void add_farm_options(Command& app, FarmOptions& options) {
  app.add_option("--farm", options.farm, "folder of the farm").with_default_shown();
  app.add_flag("--json", options.json, "print one JSON object");
}

int report_unreachable(const Error& error, bool json) {
  const int status = report_error(error, json);
  return error.fault == Fault::node_lost ? exit_unreachable : status;
}

int guarded(const FarmOptions& options, const std::function<int()>& body) {
  try {
    return body();
  } catch (const LedgerError& failure) {
    return report_error({Fault::node_lost, failure.what()}, options.json);
  }
}

Answered ask_and_report(FarmLink& link, const std::string& verb, const nlohmann::json& arguments, bool json) {
  const Result<wire::Answer> answer = link.ask(verb, arguments);
  if (!answer) return {report_unreachable(answer.error(), json), {}, false};
  const nlohmann::json body = nlohmann::json::parse(answer->body, nullptr, false);
  const std::string schema = body.is_object() ? body.value("schema", "") : "";
  if (json) {
    fmt::print("{}\n", body.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return {answer->exit_code, answer->body, false};
  }
  if (schema == "fracfarm.problems/1") return {report_problems(problems_of(body), body.value("what", verb), false), {}, false};
  if (schema == "fracfarm.error/1") {
    fmt::print(stderr, "{} {}\n", ink("error:", Ink::red, stderr), body.value("message", ""));
    return {answer->exit_code, {}, false};
  }
  return {answer->exit_code, answer->body, true};
}

Parsed<Campaign> load_campaign(const std::filesystem::path& file) {
  const Result<std::string> text = read_file(file, most_campaign_bytes);
  if (!text) return tl::unexpected(Problems{{"CAMPAIGN", file.string(), "a readable file of at most 1 MB", text.error().message}});
  return parse_campaign(*text, file.filename().string());
}

}  // namespace fracfarm::cli
