#include "coordinator/cli/metrics_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace fracfarm::cli {
namespace {

using nlohmann::json;

std::string quoted(const std::string& value) {
  std::string text;
  for (const char c : value) {
    if (c == '\\' || c == '"') text += '\\';
    text += c == '\n' ? ' ' : c;
  }
  return fmt::format("\"{}\"", text);
}

void head(std::string& out, const char* name, const char* type, const char* help) {
  out += fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", name, help, type);
}

std::string class_labels(const json& it) {
  return fmt::format("method={},material={},load={}", quoted(it.value("method", "")), quoted(it.value("material", "")),
                     quoted(it.value("load", "")));
}

}  // namespace

std::string metrics_text(const json& status) {
  std::string out;
  head(out, "fracfarm_up", "gauge", "1 where a coordinator serves.");
  out += fmt::format("fracfarm_up {}\n", status.value("serving", false) ? 1 : 0);
  head(out, "fracfarm_jobs", "gauge", "Jobs by class and state.");
  for (const json& it : status["classes"])
    for (const auto& [state, n] : it["counts"].items())
      out += fmt::format("fracfarm_jobs{{{},state={}}} {}\n", class_labels(it), quoted(state), n.get<std::uint64_t>());
  head(out, "fracfarm_results_total", "counter", "Results by class and verdict.");
  for (const json& it : status["classes"])
    for (const auto& [verdict, n] : it["verdicts"].items())
      out += fmt::format("fracfarm_results_total{{{},verdict={}}} {}\n", class_labels(it), quoted(verdict), n.get<std::uint64_t>());
  head(out, "fracfarm_faults_total", "counter", "Tries that ended in a fault, by class of fault.");
  for (const auto& [fault, n] : status["faults"].items())
    out += fmt::format("fracfarm_faults_total{{fault={}}} {}\n", quoted(fault), n.get<std::uint64_t>());
  head(out, "fracfarm_results_per_second", "gauge", "Results a second over the last two minutes.");
  out += fmt::format("fracfarm_results_per_second {}\n", status.value("rate_per_s", 0.0));
  if (!status["eta_s"].is_null()) {
    head(out, "fracfarm_left_seconds", "gauge", "Seconds until nothing is left to do, as estimated.");
    out += fmt::format("fracfarm_left_seconds {}\n", status["eta_s"].get<double>());
  }
  head(out, "fracfarm_slots", "gauge", "Slots of connected workers.");
  for (const json& it : status["workers"])
    out += fmt::format("fracfarm_slots{{worker={},node={},state={}}} {}\n", quoted(it.value("name", "")), quoted(it.value("node", "")),
                       quoted(it.value("state", "")), it.value("slots", 0));
  head(out, "fracfarm_slots_running", "gauge", "Slots that work.");
  for (const json& it : status["workers"])
    out += fmt::format("fracfarm_slots_running{{worker={},node={}}} {}\n", quoted(it.value("name", "")), quoted(it.value("node", "")),
                       it.value("running", 0));
  head(out, "fracfarm_classes_paused", "gauge", "Classes of jobs that are paused.");
  out += fmt::format("fracfarm_classes_paused {}\n", status["paused"].size());
  head(out, "fracfarm_nodes_suspect", "gauge", "Nodes that must do a canary before work.");
  out += fmt::format("fracfarm_nodes_suspect {}\n", status["suspects"].size());
  head(out, "fracfarm_alarms", "gauge", "Alarms raised, at most the latest 20.");
  out += fmt::format("fracfarm_alarms {}\n", status["alarms"].size());
  return out;
}

}  // namespace fracfarm::cli
