// The codec of the pipe. A line is data from another process: every field is looked at before it is believed, and nothing here throws.
#include "common/task/task.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

namespace fracfarm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t line_limit = std::size_t{64} << 20;  // bytes
constexpr std::array<std::string_view, 5> kind_names{"ready", "progress", "done", "stopped", "fault"};

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json to_json(const Summary& summary) {
  Json times = Json::object(), stages = Json::object();
  for (const auto& [rule, time] : summary.times) times[rule] = number(time);
  for (const auto& [stage, seconds] : summary.stages) stages[stage] = number(seconds);
  return Json{{"schema", summary_schema},
              {"verdict", name_of(summary.verdict)},
              {"time_to_failure", number(summary.time_to_failure)},
              {"failure_rule", summary.failure_rule},
              {"times", times},
              {"peak_stress", number(summary.peak_stress)},
              {"steps", summary.steps},
              {"dt", number(summary.dt)},
              {"energy_residual", number(summary.energy_residual)},
              {"cpu_s", number(summary.cpu_s)},
              {"wall_s", number(summary.wall_s)},
              {"stages", stages},
              {"kernel", summary.kernel},
              {"record_sha256", summary.record_sha256}};
}

// Takes typed fields out of one JSON object and keeps the first mistake. A missing or mistyped field leaves its target alone.
class Fields {
 public:
  explicit Fields(const Json& object) : object_(object) {
    if (!object.is_object()) mistake_ = "not a JSON object";
  }

  void take(const char* key, std::string& into) {
    if (const Json* value = need(key, &Json::is_string, "a string")) into = value->get_ref<const std::string&>();
  }
  void take(const char* key, std::filesystem::path& into) {
    std::string text;
    take(key, text);
    into = text;
  }
  void take(const char* key, double& into) {  // null is NaN
    if (const Json* value = need(key, is_real, "a number or null")) into = real(*value);
  }
  void take(const char* key, std::optional<double>& into) {  // null is nothing
    const Json* value = need(key, is_real, "a number or null");
    if (value) into = value->is_null() ? std::nullopt : std::optional<double>(value->get<double>());
  }
  template <class Integer>
  requires std::is_integral_v<Integer>
  void take(const char* key, Integer& into) {
    const Json* value = need(key, &Json::is_number_integer, "an integer");
    if (!value) return;
    const long long wide = value->get<long long>();
    const bool fits = wide >= std::numeric_limits<Integer>::min() && wide <= std::numeric_limits<Integer>::max();
    const bool wrapped = value->is_number_unsigned() && wide < 0;
    if (!fits || wrapped) return refuse(key, "an integer in range");
    into = static_cast<Integer>(wide);
  }
  void take(const char* key, std::map<std::string, double>& into) {
    each(key, [&](const std::string& name, const Json& value) { into[name] = real(value); });
  }
  void take(const char* key, std::map<std::string, std::optional<double>>& into) {
    each(key, [&](const std::string& name, const Json& value) {
      into[name] = value.is_null() ? std::nullopt : std::optional<double>(real(value));
    });
  }

  const Json* object(const char* key) { return need(key, &Json::is_object, "an object"); }
  void refuse(const char* key, std::string_view allowed) {
    if (mistake_.empty()) mistake_ = std::string("field '") + key + "' is not " + std::string(allowed);
  }
  const std::string& mistake() const { return mistake_; }

 private:
  static bool is_real(const Json& value) { return value.is_number() || value.is_null(); }
  static double real(const Json& value) { return value.is_null() ? std::nan("") : value.get<double>(); }

  template <class Test>
  const Json* need(const char* key, Test test, std::string_view allowed) {
    if (!object_.is_object()) return nullptr;
    const auto found = object_.find(key);
    if (found != object_.end() && std::invoke(test, *found)) return &*found;
    refuse(key, allowed);
    return nullptr;
  }
  template <class Use>
  void each(const char* key, Use use) {
    const Json* list = object(key);
    if (!list) return;
    for (const auto& [name, value] : list->items()) is_real(value) ? use(name, value) : refuse(key, "an object of numbers");
  }

  const Json& object_;
  std::string mistake_;
};

tl::unexpected<Error> bad_line(std::string_view what, const std::string& why) {
  return fail(Fault::bad_request, std::string(what) + " line: " + why);
}

Result<Json> parse_line(std::string_view line, std::string_view what) {
  if (line.size() > line_limit) return bad_line(what, std::to_string(line.size()) + " bytes, the limit is " + std::to_string(line_limit));
  Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return bad_line(what, "not one JSON object");
  const auto schema = json.find("schema");
  if (schema == json.end() || *schema != task_schema) return bad_line(what, "schema is not " + std::string(task_schema));
  return json;
}

std::optional<Report::Kind> kind_by_name(std::string_view name) {
  for (std::size_t i = 0; i < kind_names.size(); ++i)
    if (kind_names[i] == name) return static_cast<Report::Kind>(i);
  return std::nullopt;
}

Result<Summary> summary_from(const Json& json) {
  Summary summary;
  Fields fields(json);
  std::string verdict;
  fields.take("verdict", verdict);
  if (const auto known = verdict_by_name(verdict))
    summary.verdict = *known;
  else
    fields.refuse("verdict", "a verdict");
  fields.take("time_to_failure", summary.time_to_failure);
  fields.take("failure_rule", summary.failure_rule);
  fields.take("times", summary.times);
  fields.take("peak_stress", summary.peak_stress);
  fields.take("steps", summary.steps);
  fields.take("dt", summary.dt);
  fields.take("energy_residual", summary.energy_residual);
  fields.take("cpu_s", summary.cpu_s);
  fields.take("wall_s", summary.wall_s);
  fields.take("stages", summary.stages);
  fields.take("kernel", summary.kernel);
  fields.take("record_sha256", summary.record_sha256);
  if (!fields.mistake().empty()) return bad_line("report", "summary: " + fields.mistake());
  return summary;
}

Result<Error> error_from(const Json& json) {
  Error error;
  Fields fields(json);
  std::string fault;
  fields.take("fault", fault);
  if (const auto known = fault_by_name(fault))
    error.fault = *known;
  else
    fields.refuse("fault", "a fault class");
  fields.take("message", error.message);
  if (!fields.mistake().empty()) return bad_line("report", "error: " + fields.mistake());
  return error;
}

}  // namespace

std::string to_json_text(const Summary& summary) { return text_of(to_json(summary)); }

std::string to_line(const Task& task) {
  return text_of(Json{{"schema", task_schema},
                      {"key", task.key},
                      {"scene", task.scene},
                      {"output", task.output.string()},
                      {"checkpoint", task.checkpoint.string()},
                      {"wall_budget_s", number(task.wall_budget_s)},
                      {"attempt", task.attempt},
                      {"step_scale", number(task.step_scale)}}) +
         "\n";
}

std::string to_line(const Report& report) {
  Json json{{"schema", task_schema}, {"report", kind_names[static_cast<std::size_t>(report.kind)]}, {"key", report.key}};
  if (report.kind == Report::Kind::ready) json["build_id"] = report.build_id;
  if (report.kind == Report::Kind::progress) {
    json["step"] = report.step;
    json["time"] = number(report.time);
    json["horizon"] = number(report.horizon);
  }
  if (report.kind == Report::Kind::done) json["summary"] = to_json(report.summary);
  if (report.kind == Report::Kind::fault) {
    const Error error = report.error.value_or(Error{Fault::solver_crash, "no reason given"});
    json["error"] = Json{{"fault", fault_row(error.fault).name}, {"message", error.message}};
  }
  return text_of(json) + "\n";
}

Result<Task> task_from_line(std::string_view line) {
  const Result<Json> json = parse_line(line, "task");
  if (!json) return tl::unexpected(json.error());
  Task task;
  Fields fields(*json);
  fields.take("key", task.key);
  fields.take("scene", task.scene);
  fields.take("output", task.output);
  fields.take("checkpoint", task.checkpoint);
  fields.take("wall_budget_s", task.wall_budget_s);
  fields.take("attempt", task.attempt);
  fields.take("step_scale", task.step_scale);
  if (!(task.wall_budget_s > 0.0)) fields.refuse("wall_budget_s", "above 0");
  if (!(task.step_scale > 0.0 && task.step_scale <= 1.0)) fields.refuse("step_scale", "in (0, 1]");
  if (task.attempt < 1) fields.refuse("attempt", "1 or more");
  if (!fields.mistake().empty()) return bad_line("task", fields.mistake());
  return task;
}

Result<Report> report_from_line(std::string_view line) {
  const Result<Json> json = parse_line(line, "report");
  if (!json) return tl::unexpected(json.error());
  Report report;
  Fields fields(*json);
  std::string kind;
  fields.take("report", kind);
  fields.take("key", report.key);
  const std::optional<Report::Kind> known = kind_by_name(kind);
  if (!known) fields.refuse("report", "a kind of report");
  report.kind = known.value_or(Report::Kind::ready);
  if (known == Report::Kind::ready) fields.take("build_id", report.build_id);
  if (known == Report::Kind::progress) {
    fields.take("step", report.step);
    fields.take("time", report.time);
    fields.take("horizon", report.horizon);
  }
  if (known == Report::Kind::done)
    if (const Json* object = fields.object("summary")) {
      Result<Summary> summary = summary_from(*object);
      if (!summary) return tl::unexpected(summary.error());
      report.summary = std::move(*summary);
    }
  if (known == Report::Kind::fault)
    if (const Json* object = fields.object("error")) {
      Result<Error> error = error_from(*object);
      if (!error) return tl::unexpected(error.error());
      report.error = std::move(*error);
    }
  if (!fields.mistake().empty()) return bad_line("report", fields.mistake());
  return report;
}

}  // namespace fracfarm
