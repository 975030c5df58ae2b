#include "coordinator/cli/status_text.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/terminal.hpp"
#include "common/base/text.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;
using Table = std::vector<std::vector<std::string>>;

std::uint64_t n_of(const json& counts, const char* name) { return counts.value(name, std::uint64_t{0}); }
std::string number(std::uint64_t n) { return n ? std::to_string(n) : "-"; }

std::string class_table(const json& classes) {
  Table rows{{"material", "load", "done", "failed", "censored", "rejected", "running", "ready", "waiting", "quarantined", "cancelled"}};
  for (const json& it : classes) {
    const json &c = it["counts"], &v = it["verdicts"];
    rows.push_back({it.value("material", ""), it.value("load", ""), number(n_of(c, "done")), number(n_of(v, "failed")),
                    number(n_of(v, "censored")), number(n_of(v, "rejected")), number(n_of(c, "leased")), number(n_of(c, "ready")),
                    number(n_of(c, "retry_wait")), number(n_of(c, "quarantined")), number(n_of(c, "cancelled"))});
  }
  return table_text(rows);
}

std::string worker_table(const json& workers) {
  Table rows{{"worker", "node", "state", "running", "slots", "done", "faults", "last heard", "time left"}};
  for (const json& it : workers)
    rows.push_back({it.value("name", ""), it.value("node", ""), it.value("state", ""), std::to_string(it.value("running", 0)),
                    std::to_string(it.value("slots", 0)), std::to_string(n_of(it, "done")), std::to_string(n_of(it, "faults")),
                    duration_text(it.value("silent_s", 0.0)),
                    it["remaining_s"].is_null() ? "-" : duration_text(it["remaining_s"].get<double>())});
  return table_text(rows);
}

std::string fault_line(const json& faults) {
  std::vector<std::pair<std::uint64_t, std::string>> top;
  for (const auto& [name, n] : faults.items()) top.emplace_back(n.get<std::uint64_t>(), name);
  std::sort(top.rbegin(), top.rend());
  std::string line;
  for (const auto& [n, name] : top) line += fmt::format("{}{} {}", line.empty() ? "" : ", ", name, n);
  return line;
}

std::string time_left_text(const json& status) {
  if (status.value("settled", false)) return "nothing left to do";
  if (status["eta_s"].is_null())
    return status.value("serving", false) ? "time left: not known yet" : "no coordinator runs: fracfarm run goes on";
  return fmt::format("{} left, done at {}", duration_text(status["eta_s"].get<double>()),
                     clock_text(status["finish_time"].get<std::string>()));
}

// How fast and how long still; a farm that nobody serves has no rate.
std::string pace_text(const json& status) {
  if (!status.value("serving", false) && status.value("rate_per_s", 0.0) == 0.0) return time_left_text(status);
  return fmt::format("{:.3g} jobs/s · {}", status.value("rate_per_s", 0.0), time_left_text(status));
}

std::uint64_t all_jobs(const json& status) { return n_of(status, "total") + n_of(status, "unmade"); }

}  // namespace

std::string clock_text(const std::string& utc) {
  std::tm parts{};
  if (!::strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts)) return utc;
  const std::time_t then = ::timegm(&parts), now = std::time(nullptr);
  std::tm local{}, today{};
  ::localtime_r(&then, &local);
  ::localtime_r(&now, &today);
  const bool same_day = local.tm_yday == today.tm_yday && local.tm_year == today.tm_year;
  return same_day ? fmt::format("{:%H:%M:%S}", local) : fmt::format("{:%Y-%m-%d %H:%M}", local);
}

std::string progress_text(const json& status) {
  const json& counts = status["counts"];
  std::string line = fmt::format("{} of {} done, {} running", n_of(counts, "done"), all_jobs(status), n_of(counts, "leased"));
  if (const auto n = n_of(counts, "retry_wait")) line += fmt::format(", {} to be tried again", n);
  if (const auto n = n_of(counts, "quarantined")) line += fmt::format(", {} quarantined", n);
  return fmt::format("{} · {}", line, pace_text(status));
}

std::string status_text(const json& status, std::FILE* to) {
  const json& counts = status["counts"];
  const std::uint64_t done = n_of(counts, "done"), all = all_jobs(status);
  std::string text = fmt::format("{} of {} jobs done ({:.1f} %) · {}\n", ink(std::to_string(done), Ink::bold, to), all,
                                 all ? 100.0 * static_cast<double>(done) / static_cast<double>(all) : 100.0, pace_text(status));
  for (const json& it : status["campaigns"])
    if (it["expanded"] != it["total"])
      text += fmt::format("campaign {} is being made into jobs: {} of {}\n", it.value("name", ""), n_of(it, "expanded"), n_of(it, "total"));
  if (!status["classes"].empty()) text += "\n" + class_table(status["classes"]);
  if (const std::string faults = fault_line(status["faults"]); !faults.empty()) text += fmt::format("\nfaults so far: {}\n", faults);
  if (const auto n = n_of(counts, "quarantined"))
    text += fmt::format(
        "{}\n", ink(fmt::format("{} quarantined: fracfarm jobs --state quarantined, then fracfarm explain JOB", n), Ink::yellow, to));
  for (const json& it : status.value("paused", json::array()))
    text += fmt::format("{}\n", ink(fmt::format("paused: {} {} {}: {}; fracfarm resume goes on", it.value("method", ""),
                                                it.value("material", ""), it.value("load", ""), it.value("why", "")),
                                    Ink::yellow, to));
  for (const json& it : status.value("suspects", json::array()))
    text += fmt::format("{}\n", ink(fmt::format("suspect: {}: {}; it gets a canary before work", it.value("node", ""), it.value("why", "")),
                                    Ink::yellow, to));
  if (const auto n = n_of(counts, "held")) text += fmt::format("{} held: fracfarm release lets them go\n", n);
  for (const json& it : status["alarms"])
    text += fmt::format("{} job {}: {}\n", ink(it.value("kind", ""), Ink::red, to), n_of(it, "job"), it.value("message", ""));
  if (!status["workers"].empty()) text += "\n" + worker_table(status["workers"]);
  return text;
}

std::string jobs_text(const json& jobs) {
  Table rows{{"id", "material", "load", "pattern", "state", "verdict", "time-to-failure", "peak stress", "rule", "tries", "key"}};
  for (const json& it : jobs["jobs"]) {
    const bool done = !it["verdict"].is_null();
    rows.push_back({std::to_string(n_of(it, "id")), it.value("material", ""), it.value("load", ""), it.value("pattern", ""),
                    it.value("state", ""), done ? it.value("verdict", "") : "-",
                    it["time_to_failure"].is_null() ? "-" : engineering(it["time_to_failure"].get<double>(), "s"),
                    done ? engineering(it.value("peak_stress", 0.0), "Pa") : "-", done ? it.value("failure_rule", "") : "-",
                    std::to_string(it.value("attempts", 0)), it.value("key", "").substr(0, 12)});
  }
  return table_text(rows);
}

std::string explain_text(const json& it, std::FILE* to) {
  std::string text =
      fmt::format("{}  {} {}, {}, {}  ({})\n", ink(fmt::format("job {}", n_of(it, "id")), Ink::bold, to), it.value("method", ""),
                  it.value("material", ""), it.value("load", ""), it.value("pattern", ""), it.value("campaign_name", ""));
  text += fmt::format("key     {}\nstate   {}\nwhy     {}\nto do   {}\n", it.value("key", ""), it.value("state", ""), it.value("why", ""),
                      it.value("todo", ""));
  if (it["history"].empty()) return text + "history: no fault\n";
  Table rows{{"try", "fault", "node", "signature", "ended", "message"}};
  for (const json& row : it["history"])
    rows.push_back({std::to_string(row.value("attempt", 0)), row.value("fault", ""), row.value("node", ""), row.value("signature", ""),
                    row.value("ended_at", ""), row.value("message", "")});
  return text + "\n" + table_text(rows);
}

std::string worker_text(const json& it, std::FILE* to) {
  const std::string state = it["now"].is_null() ? "not connected" : it["now"].value("state", "");
  std::string text = fmt::format("{} on {} ({})\nstate   {}\nwhy     {}\nto do   {}\n", ink(it.value("worker", ""), Ink::bold, to),
                                 it.value("node", ""), it.value("node_type", ""), state, it.value("why", ""), it.value("todo", ""));
  if (const auto n = n_of(it, "blamed")) text += fmt::format("blamed  {} failures of jobs that others then did\n", n);
  for (const json& row : it["canaries"])
    text += fmt::format("canary  job {}: {} {}\n", n_of(row, "job"), row.value("state", ""), row.value("message", ""));
  Table starts{{"started", "done", "faults"}};
  for (const json& row : it["starts"])
    starts.push_back({row.value("began_at", ""), std::to_string(n_of(row, "done")), std::to_string(n_of(row, "faults"))});
  text += "\n" + table_text(starts);
  if (it["history"].empty()) return text + "no try of its node has failed\n";
  Table rows{{"job", "fault", "signature", "ended", "message"}};
  for (const json& row : it["history"])
    rows.push_back({std::to_string(n_of(row, "job")), row.value("fault", ""), row.value("signature", ""), row.value("ended_at", ""),
                    row.value("message", "")});
  return text + "\n" + table_text(rows);
}

}  // namespace fracfarm::cli
