// Attributes of the grammar, and the specs that datasets share.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/record/layouts.hpp"

namespace fracfarm::grammar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool give_text(std::string& into, const Value& value) {
  into = std::get<std::string>(value);
  return true;
}

bool give_number(double& into, const Value& value) {
  into = std::get<double>(value);
  return true;
}

bool give_count(std::uint64_t& into, const Value& value) {
  into = std::get<std::uint64_t>(value);
  return true;
}

bool give_verdict(Record& r, const Value& value) {
  const auto verdict = verdict_by_name(std::get<std::string>(value));
  if (verdict) r.judgement.verdict = *verdict;
  return verdict.has_value();
}

bool give_time_to_failure(Record& r, const Value& value) {
  const double time = std::get<double>(value);
  if (!std::isnan(time)) r.judgement.time_to_failure = time;
  return true;
}

bool is_schema(std::string_view name) { return name == schema || name == schema_2 || name == schema_1; }

Value solver_of(const Record& r) {
  const auto build = r.provenance.find("build_id");
  return "fracfarm " + (build == r.provenance.end() ? std::string("of unknown build") : build->second);
}

}  // namespace

std::vector<AttributeRow> shared_attributes() {
  return {
      {"/", "Conventions", [](const Record&) -> Value { return std::string(conventions); }, nullptr},
      {"/", "fracfarm_schema", [](const Record&) -> Value { return std::string(schema); },
       [](Record&, const Value& v) { return is_schema(std::get<std::string>(v)); }},
      {"/", "solver", solver_of, nullptr},
      {"/", "method", [](const Record& r) -> Value { return r.method; }, [](Record& r, const Value& v) { return give_text(r.method, v); }},
      {"/", "material", [](const Record& r) -> Value { return r.material; },
       [](Record& r, const Value& v) { return give_text(r.material, v); }},
      {"/", "boundary_condition", [](const Record& r) -> Value { return r.boundary_condition; },
       [](Record& r, const Value& v) { return give_text(r.boundary_condition, v); }},
      {"/", "sample_id", [](const Record& r) -> Value { return r.sample_id; },
       [](Record& r, const Value& v) { return give_count(r.sample_id, v); }},
      {"/", "pattern_seed", [](const Record& r) -> Value { return r.pattern_seed; },
       [](Record& r, const Value& v) { return give_count(r.pattern_seed, v); }},
      {"/", "key", [](const Record& r) -> Value { return r.key; }, [](Record& r, const Value& v) { return give_text(r.key, v); }},
      {"/", "verdict", [](const Record& r) -> Value { return std::string(name_of(r.judgement.verdict)); }, give_verdict},
      {"/", "time_to_failure", [](const Record& r) -> Value { return r.judgement.time_to_failure.value_or(nan); }, give_time_to_failure},
      {"/", "peak_stress", [](const Record& r) -> Value { return r.peak_stress; },
       [](Record& r, const Value& v) { return give_number(r.peak_stress, v); }},
      {"/", "energy_residual", [](const Record& r) -> Value { return r.energy_residual; },
       [](Record& r, const Value& v) { return give_number(r.energy_residual, v); }},
      {"/", "licence", [](const Record&) -> Value { return std::string(licence); }, nullptr},
      {"/failure", "chosen_rule", [](const Record& r) -> Value { return r.judgement.rule; },
       [](Record& r, const Value& v) { return give_text(r.judgement.rule, v); }},
      {"/failure", "chosen_time", [](const Record& r) -> Value { return r.judgement.time_to_failure.value_or(nan); }, nullptr},
      {"/failure", "confidence", [](const Record& r) -> Value { return r.judgement.confidence; },
       [](Record& r, const Value& v) { return give_number(r.judgement.confidence, v); }},
  };
}

std::span<const std::string_view> groups() {
  static constexpr std::array<std::string_view, 5> table{"/cracks", "/series", "/failure", "/checks", "/provenance"};
  return table;
}

bool is_name(std::string_view name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '+' || c == '-';
  };
  return !name.empty() && name.size() <= name_limit && std::all_of(name.begin(), name.end(), allowed);
}

DatasetSpec series_spec(std::string_view name, std::string_view unit) {
  DatasetSpec spec;
  spec.path = "/series/" + std::string(name);
  spec.dims = {"/series/step_time"};
  spec.units = unit;
  spec.long_name = name;
  for (const ColumnRow& row : series_table)
    if (row.name == name) spec.long_name = row.meaning;
  return spec;
}

Array series_array(const Column& column) { return array_of(column.values, {column.values.size()}); }

std::vector<std::pair<std::string, std::string>> DatasetSpec::attributes(std::string_view file_schema) const {
  std::vector<std::pair<std::string, std::string>> list;
  if (!units.empty()) list.emplace_back("units", units);
  list.emplace_back("long_name", long_name);
  if (!axis.empty()) list.emplace_back("axis", axis);
  if (fraction_bits)
    list.emplace_back("rounding",
                      file_schema == schema_1
                          ? "to the nearest float with 12 explicit mantissa bits, ties to even; 0 and 1 are exact"
                          : "to the nearest multiple of 2^-" + std::to_string(fraction_bits) + ", ties to even" + rounding_note);
  return list;
}

}  // namespace fracfarm::grammar
