// The datasets that every method has, behind the frames of the method; and the table of methods.
#include "common/record/grammar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/record/layouts.hpp"

namespace fracfarm::grammar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Array take_segments(const View& view) {
  const Record& r = view.record;
  std::vector<double> ends;
  for (const Segment& s : r.cracks) ends.insert(ends.end(), {s.x0, s.z0, s.x1, s.z1});
  return array_of(ends, {r.cracks.size(), 4});
}

void give_segments(Record& r, const Array& array) {
  const std::vector<double> ends = doubles_of(array);
  for (std::size_t i = 0; i + 3 < ends.size(); i += 4) r.cracks.push_back({ends[i], ends[i + 1], ends[i + 2], ends[i + 3]});
}

Array take_rules(const View& view) {
  const Record& r = view.record;
  std::vector<std::string> rules;
  for (const FailureTime& t : r.failure_times) rules.push_back(t.rule);
  return array_of(rules);
}

Array take_times(const View& view) {
  const Record& r = view.record;
  std::vector<double> times;
  for (const FailureTime& t : r.failure_times) times.push_back(t.time.value_or(nan));
  return array_of(times, {times.size()});
}

// /failure/rule comes first in the table and makes the rows, /failure/time fills them.
void give_rules(Record& r, const Array& array) {
  for (std::string& rule : texts_of(array)) r.failure_times.push_back({std::move(rule), std::nullopt});
}

void give_times(Record& r, const Array& array) {
  const std::vector<double> times = doubles_of(array);
  for (std::size_t i = 0; i < std::min(times.size(), r.failure_times.size()); ++i)
    if (!std::isnan(times[i])) r.failure_times[i].time = times[i];
}

Array take_scene(const View& view) { return {Type::text, {view.record.canonical_scene.size()}, view.record.canonical_scene}; }
void give_scene(Record& r, const Array& array) { r.canonical_scene = array.bytes; }

template <class Get>
Array take_checks(const View& view, Get get) {
  std::vector<double> values;
  for (const ContentCheck& check : view.checks) values.push_back(get(check));
  return array_of(values, {values.size()});
}

template <class Get>
Array take_check_texts(const View& view, Get get) {
  std::vector<std::string> texts;
  for (const ContentCheck& check : view.checks) texts.emplace_back(get(check));
  return array_of(texts);
}

Array take_passed(const View& view) {
  Array array{Type::i1, {view.checks.size()}, {}};
  for (const ContentCheck& check : view.checks) array.bytes += check.passed ? '\1' : '\0';
  return array;
}

std::vector<DatasetRow> shared_datasets() {
  return {
      {{"/cracks/segments", Type::f8, {"crack", "4"}, "m", "initial cracks as drawn: x0 z0 x1 z1"}, take_segments, give_segments},
      {{"/failure/rule", Type::text, {"candidate", "length"}, "", "criterion of each candidate time"}, take_rules, give_rules},
      {{"/failure/time", Type::f8, {"candidate"}, "s", "candidate times to failure, not a number where the criterion was not met"},
       take_times,
       give_times},
      {{"/checks/name", Type::text, {"check", "length"}, "", "rule that the content must satisfy"},
       [](const View& v) { return take_check_texts(v, [](const ContentCheck& c) { return c.name; }); },
       nullptr},
      {{"/checks/meaning", Type::text, {"check", "length"}, "", "what the value is"},
       [](const View& v) { return take_check_texts(v, [](const ContentCheck& c) { return c.meaning; }); },
       nullptr},
      {{"/checks/value", Type::f8, {"check"}, "", "worked out when the record was written"},
       [](const View& v) { return take_checks(v, [](const ContentCheck& c) { return c.value; }); },
       nullptr},
      {{"/checks/limit", Type::f8, {"check"}, "", "largest value allowed"},
       [](const View& v) { return take_checks(v, [](const ContentCheck& c) { return c.limit; }); },
       nullptr},
      {{"/checks/passed", Type::i1, {"check"}, "1", "1 where value <= limit"}, take_passed, nullptr},
      {{"/provenance/canonical_scene", Type::text, {"length"}, "", "the scene, canonical JSON"}, take_scene, give_scene},
  };
}

struct MethodRow {
  std::string_view method;
  std::vector<DatasetRow> (*frames)();
  std::vector<AttributeRow> (*attributes)();
};

constexpr std::array<MethodRow, 3> methods{{
    {"phase_field", phase_field_frames, phase_field_attributes},
    {"fdem", fdem_frames, fdem_attributes},
    {"drill", phase_field_frames, phase_field_attributes},  // four nodes at time 0
}};

struct Layout {
  std::string_view method;
  std::vector<DatasetRow> datasets;
  std::vector<AttributeRow> attributes;
};

const Layout* layout_of(std::string_view method) {
  static const std::vector<Layout> layouts = [] {
    std::vector<Layout> made;
    for (const MethodRow& row : methods) {
      Layout layout{row.method, row.frames(), shared_attributes()};
      for (DatasetRow& shared : shared_datasets()) layout.datasets.push_back(std::move(shared));
      for (const AttributeRow& own : row.attributes()) layout.attributes.push_back(own);
      made.push_back(std::move(layout));
    }
    return made;
  }();
  const auto found = std::find_if(layouts.begin(), layouts.end(), [&](const Layout& layout) { return layout.method == method; });
  return found == layouts.end() ? nullptr : &*found;
}

}  // namespace

bool has_layout(std::string_view method) { return layout_of(method) != nullptr; }

std::span<const DatasetRow> datasets(std::string_view method) {
  const Layout* layout = layout_of(method);
  return layout ? layout->datasets : std::span<const DatasetRow>{};
}

std::span<const AttributeRow> attributes(std::string_view method) {
  const Layout* layout = layout_of(method);
  return layout ? layout->attributes : std::span<const AttributeRow>{};
}

}  // namespace fracfarm::grammar
