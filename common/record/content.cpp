#include "common/record/content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "common/record/content_rules.hpp"
#include "common/record/damage_sweeps.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm {
namespace {

using content::Context;

template <class Fields, class InRange>
bool all_in_range(const Fields& frames, std::span<const float> initial, std::span<const float> failure, InRange in_range) {
  return in_range(initial) && in_range(failure) && std::all_of(frames.begin(), frames.end(), in_range);
}

Context phase_field_context(const Record& record, const std::optional<Scene>& scene) {
  const PhaseFieldFrames& f = record.phase_field;
  return {record, scene, all_in_range(f.psi, f.psi_initial, f.psi_failure, in_unit_range), {}};
}

Context fdem_context(const Record& record, const std::optional<Scene>& scene) {
  const FdemFrames& f = record.fdem;
  Context context{record, scene, all_in_range(f.damage, f.damage_initial, f.damage_failure, in_joint_range), {}};
  for (double broke : f.break_time) {
    const auto first = std::lower_bound(f.time.begin(), f.time.end(), broke);  // of a time that is not a number: none
    context.broken_from.push_back(static_cast<std::int32_t>(std::isnan(broke) ? f.time.size() : first - f.time.begin()));
  }
  return context;
}

// One for each layout of the grammar.
struct MethodRow {
  std::string_view method;
  std::string (*broken_fields)(const Record&);
  Context (*context)(const Record&, const std::optional<Scene>&);
  std::span<const content::Rule> (*rules)();
};

constexpr std::array<MethodRow, 3> methods{{
    {"phase_field", [](const Record& r) { return content::broken_fields(r.phase_field); }, phase_field_context, content::phase_field_rules},
    {"fdem", [](const Record& r) { return content::broken_fields(r.fdem); }, fdem_context, content::fdem_rules},
    {"drill", [](const Record& r) { return content::broken_fields(r.phase_field); }, phase_field_context, content::phase_field_rules},
}};

const MethodRow* row_of(std::string_view method) {
  const auto found = std::find_if(methods.begin(), methods.end(), [&](const MethodRow& row) { return row.method == method; });
  return found == methods.end() ? nullptr : &*found;
}

std::string broken_series(const Series& series) {
  if (series.rows() == 0 || series.columns.front().name != "step_time") return "the series has no rows or does not begin with step_time";
  std::set<std::string_view> names;
  for (const Column& column : series.columns) {
    if (column.values.size() != series.rows())
      return fmt::format("series column '{}' has {} rows, not {}", column.name, column.values.size(), series.rows());
    if (!names.insert(column.name).second) return fmt::format("two series columns are named '{}'", column.name);
  }
  for (const ColumnRow& row : series_table)
    if (row.required && !series.find(row.name)) return fmt::format("the series has no column '{}'", row.name);
  return {};
}

}  // namespace

std::string broken_shape(const Record& record) {
  const MethodRow* row = row_of(record.method);
  if (!row) return fmt::format("no rules for the method '{}'", record.method.substr(0, 60));
  if (std::string why = row->broken_fields(record); !why.empty()) return why;
  if (std::string why = broken_series(record.series); !why.empty()) return why;
  return record.failure_times.empty() ? "no candidate times to failure" : "";
}

std::vector<ContentCheck> check_content(const Record& record) {
  std::optional<Scene> scene;
  if (Parsed<Scene> parsed = parse_scene(record.canonical_scene)) scene = std::move(*parsed);
  const MethodRow* row = row_of(record.method);
  if (!row) return {};
  const Context context = row->context(record, scene);
  std::vector<ContentCheck> checks;
  for (const content::Rule& rule : row->rules()) {
    double value = rule.value(context);
    if (std::isnan(value)) value = content::infinity;
    checks.push_back({rule.name, rule.meaning, value, rule.limit, value <= rule.limit});
  }
  return checks;
}

}  // namespace fracfarm
