// `fracfarm check` and `fracfarm show`: one record at a time, in words, as JSON or as a picture. They need no farm and change no record.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/atomic_file.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/picture/record_picture.hpp"
#include "common/record/check.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/verb.hpp"

namespace fracfarm::cli {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

void print(const Json& json) { fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace)); }

struct CheckedFile {
  std::string path;
  std::vector<Check> checks;

  bool readable() const { return !(checks.size() == 1 && checks.front().name == "readable"); }
  bool sound() const { return all_passed(checks); }
};

Json to_json(const CheckedFile& file) {
  Json rules = Json::array();
  for (const Check& check : file.checks)
    rules.push_back({{"name", check.name},
                     {"passed", check.passed},
                     {"value", number(check.value)},
                     {"limit", number(check.limit)},
                     {"detail", check.detail}});
  return {{"file", file.path}, {"passed", file.sound()}, {"rules", rules}};
}

void print_words(const CheckedFile& file, bool every_rule) {
  const auto broken = std::count_if(file.checks.begin(), file.checks.end(), [](const Check& check) { return !check.passed; });
  if (broken == 0)
    fmt::print("{}  {}: all {} rules hold\n", ink("ok", Ink::green, stdout), file.path, file.checks.size());
  else
    fmt::print("{}  {}: {} of {} rules broken\n", ink("BROKEN", Ink::red, stdout), file.path, broken, file.checks.size());
  for (const Check& check : file.checks) {
    if (check.passed && !every_rule) continue;
    fmt::print("  {} {}: {} (value {}, limit {})\n", check.passed ? "ok    " : ink("broken", Ink::red, stdout),
               ink(check.name, Ink::bold, stdout), check.detail, shortest(check.value), shortest(check.limit));
  }
}

int exit_of(const std::vector<CheckedFile>& files) {
  if (std::any_of(files.begin(), files.end(), [](const CheckedFile& file) { return !file.readable(); })) return exit_bad_input;
  return std::all_of(files.begin(), files.end(), [](const CheckedFile& file) { return file.sound(); }) ? exit_ok : exit_failed;
}

bool on_mesh(const Record& r) { return r.method == "fdem"; }

Json nodes(const Record& r) { return on_mesh(r) ? Json(r.fdem.mesh.nodes.size()) : Json{r.phase_field.x.size(), r.phase_field.z.size()}; }

Json mesh(const Record& r) {
  if (!on_mesh(r)) return nullptr;
  const std::vector<float>& damage = r.fdem.damage_failure;
  return {{"triangles", r.fdem.mesh.triangles.size()},
          {"edges", damage.size()},
          {"initial_cracks", std::count(damage.begin(), damage.end(), 2.0f)},
          {"broken", std::count(damage.begin(), damage.end(), 1.0f)}};
}

Json to_json(const Record& r, const std::string& path) {
  Json times = Json::object(), provenance = Json::object(), columns = Json::array();
  for (const FailureTime& candidate : r.failure_times) times[candidate.rule] = number(candidate.time);
  for (const auto& [name, value] : r.provenance) provenance[name] = value;
  for (const Column& column : r.series.columns) columns.push_back({{"name", column.name}, {"unit", column.unit}});
  return {{"schema", "fracfarm.show/1"},
          {"file", path},
          {"key", r.key},
          {"method", r.method},
          {"material", r.material},
          {"boundary_condition", r.boundary_condition},
          {"sample_id", r.sample_id},
          {"pattern_seed", r.pattern_seed},
          {"verdict", name_of(r.judgement.verdict)},
          {"time_to_failure", number(r.judgement.time_to_failure)},
          {"failure_rule", r.judgement.rule},
          {"confidence", number(r.judgement.confidence)},
          {"times", times},
          {"disagreement", number(disagreement(r.failure_times))},
          {"peak_stress", number(r.peak_stress)},
          {"energy_residual", number(r.energy_residual)},
          {"nodes", nodes(r)},
          {"mesh", mesh(r)},
          {"cracks", r.cracks.size()},
          {"frames", frame_times(r).size()},
          {"last_frame", frame_times(r).empty() ? Json(nullptr) : number(frame_times(r).back())},
          {"series_rows", r.series.rows()},
          {"series", columns},
          {"scene", Json::parse(r.canonical_scene, nullptr, false)},
          {"provenance", provenance}};
}

using Rows = std::vector<std::vector<std::string>>;

std::string seconds(const std::optional<double>& time) { return time ? engineering(*time, "s") : "not met"; }

std::string body(const Record& r) {
  if (!on_mesh(r))
    return fmt::format("{} x {} nodes, {} x {}", r.phase_field.x.size(), r.phase_field.z.size(), engineering(r.phase_field.x.back(), "m"),
                       engineering(r.phase_field.z.back(), "m"));
  const auto& damage = r.fdem.damage_failure;
  return fmt::format("{} nodes, {} triangles, {} edges of which {} initial cracks and {} broken at the failure", r.fdem.mesh.nodes.size(),
                     r.fdem.mesh.triangles.size(), damage.size(), std::count(damage.begin(), damage.end(), 2.0f),
                     std::count(damage.begin(), damage.end(), 1.0f));
}

Rows facts(const Record& r) {
  const std::string sample = r.sample_id ? fmt::format("sample {} of seed {:#x}", r.sample_id, r.pattern_seed) : "not of a campaign";
  return {{"what", "value"},
          {"material", r.material},
          {"load", r.boundary_condition},
          {"sample", sample},
          {"method", r.method},
          {on_mesh(r) ? "mesh" : "grid", body(r)},
          {"cracks", fmt::format("{}", r.cracks.size())},
          {"verdict", fmt::format("{} ({})", name_of(r.judgement.verdict), r.judgement.rule)},
          {"time to failure", seconds(r.judgement.time_to_failure)},
          {"confidence", fmt::format("{:.2f}", r.judgement.confidence)},
          {"criteria apart", disagreement(r.failure_times) ? seconds(disagreement(r.failure_times)) : "only one was met"},
          {"peak stress", engineering(r.peak_stress, "Pa")},
          {"energy residual", fmt::format("{:.3g} % of the work", 100.0 * r.energy_residual)},
          {"frames", fmt::format("{} to {}", frame_times(r).size(), frame_times(r).empty() ? "" : engineering(frame_times(r).back(), "s"))},
          {"series", fmt::format("{} rows of {} columns", r.series.rows(), r.series.columns.size())},
          {"key", r.key}};
}

void print_summary(const Record& r, const std::string& path) {
  fmt::print("{}\n{}", ink(path, Ink::bold, stdout), table_text(facts(r)));
  Rows candidates{{"criterion", "time", ""}};
  for (const FailureTime& candidate : r.failure_times)
    candidates.push_back({candidate.rule, seconds(candidate.time), candidate.rule == r.judgement.rule ? "chosen" : ""});
  Rows columns{{"series", "unit", "least", "largest"}};
  for (const Column& column : r.series.columns) {
    const auto [least, largest] = std::minmax_element(column.values.begin(), column.values.end());
    columns.push_back({column.name, column.unit, fmt::format("{:.4g}", *least), fmt::format("{:.4g}", *largest)});
  }
  Rows provenance{{"provenance", ""}};
  for (const auto& [name, value] : r.provenance) provenance.push_back({name, value});
  for (const Rows& rows : {candidates, columns, provenance}) fmt::print("\n{}", table_text(rows));
}

}  // namespace

int run_check(int argc, char** argv) {
  Command app(
      "Is each file a record that may be trusted? Names every broken rule; exit status 1 where there is one, 2 where a file cannot be "
      "read.",
      "fracfarm check");
  std::vector<std::string> paths;
  Expectation expectation;
  bool json = false, every_rule = false;
  app.add_option("record", paths, "record files").required();
  app.add_option("--key", expectation.key, "the job that the record must be of");
  app.add_flag("--all", every_rule, "print the rules that hold as well");
  app.add_flag("--json", json, "one JSON object");
  if (const auto ended = app.parse(argc, argv)) return *ended;

  std::vector<CheckedFile> files;
  ProgressLine progress;
  const bool many = paths.size() > 20;  // fewer take less than a second
  for (const std::string& path : paths) {
    if (many && !files.empty()) progress.show(fmt::format("{} of {} records checked", files.size(), paths.size()));
    files.push_back({path, check_record(path, expectation)});
  }
  const auto sound = std::count_if(files.begin(), files.end(), [](const CheckedFile& file) { return file.sound(); });
  if (many) progress.finish(fmt::format("{} of {} records sound", sound, paths.size()));
  if (json) {
    Json list = Json::array();
    for (const CheckedFile& file : files) list.push_back(to_json(file));
    print({{"schema", "fracfarm.check/1"}, {"passed", exit_of(files) == exit_ok}, {"records", list}});
  } else {
    for (const CheckedFile& file : files) print_words(file, every_rule);
  }
  return exit_of(files);
}

int run_show(int argc, char** argv) {
  Command app("What a record holds: a summary in words, or with -o a picture of patterns, stress and energies.", "fracfarm show");
  std::string path, picture;
  bool json = false;
  app.add_option("record", path, "record file").required();
  app.add_option("-o,--output", picture, "PNG file to write");
  app.add_flag("--json", json, "one JSON object");
  if (const auto ended = app.parse(argc, argv)) return *ended;

  const Result<std::string> bytes = read_file(path, record_file_limit);
  if (!bytes) return report_error({Fault::bad_request, bytes.error().message}, json);
  const Result<Record> record = read_record_bytes(*bytes);
  if (!record) return report_error({record.error().fault, path + ": " + record.error().message}, json);
  if (!picture.empty()) {
    const picture::Canvas canvas = picture::draw_record(*record);
    if (const auto written = write_atomically(picture, picture::png_bytes(canvas)); !written) return report_error(written.error(), json);
    if (!json) fmt::print("{}: {} x {} pixels\n", picture, canvas.width(), canvas.height());
  }
  if (json) print(to_json(*record, path));
  if (!json && picture.empty()) print_summary(*record, path);
  return exit_ok;
}

}  // namespace fracfarm::cli
