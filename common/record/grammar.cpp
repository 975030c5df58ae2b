#include "common/record/grammar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "common/record/rounding.hpp"

namespace fracfarm::grammar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
std::vector<T> values_of(const Array& array) {
  std::vector<T> values(array.count());
  std::memcpy(values.data(), array.bytes.data(), array.bytes.size());
  return values;
}

std::vector<std::size_t> plane(const Record& r) { return {r.phase_field.z.size(), r.phase_field.x.size()}; }

Array take_psi(const View& view) {
  const PhaseFieldFrames& f = view.record.phase_field;
  Array array{Type::f4, {f.psi.size(), f.z.size(), f.x.size()}, {}};
  array.bytes.reserve(array.count() * sizeof(float));
  for (const std::vector<float>& frame : f.psi) array.bytes.append(reinterpret_cast<const char*>(frame.data()), frame.size() * 4);
  return array;
}

void give_psi(Record& r, const Array& array) {
  const std::size_t nodes = array.dims[1] * array.dims[2];
  if (nodes == 0) return;  // any number of frames of nothing would fit a small file
  r.phase_field.psi.reserve(array.dims[0]);
  for (std::size_t t = 0; t < array.dims[0]; ++t)
    std::memcpy(r.phase_field.psi.emplace_back(nodes).data(), array.bytes.data() + t * nodes * 4, nodes * 4);
}

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

Array take_mask(const View& view) { return {Type::i1, plane(view.record), bytes_of(view.record.phase_field.mask_initial)}; }
void give_mask(Record& r, const Array& array) { r.phase_field.mask_initial = values_of<unsigned char>(array); }

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

const std::string z_dim = "/z", x_dim = "/x", t_dim = "/time";

}  // namespace

std::span<const DatasetRow> datasets() {
  static const std::vector<DatasetRow> table{
      {{"/time", Type::f8, {"/time"}, "s", "time of the frame since the start", "T"},
       [](const View& v) { return array_of(v.record.phase_field.time, {v.record.phase_field.time.size()}); },
       [](Record& r, const Array& a) { r.phase_field.time = doubles_of(a); }},
      {{"/z", Type::f8, {"/z"}, "m", "height of the node above the lower side", "Y"},
       [](const View& v) { return array_of(v.record.phase_field.z, {v.record.phase_field.z.size()}); },
       [](Record& r, const Array& a) { r.phase_field.z = doubles_of(a); }},
      {{"/x", Type::f8, {"/x"}, "m", "distance of the node from the left side", "X"},
       [](const View& v) { return array_of(v.record.phase_field.x, {v.record.phase_field.x.size()}); },
       [](Record& r, const Array& a) { r.phase_field.x = doubles_of(a); }},
      {{"/psi", Type::f4, {t_dim, z_dim, x_dim}, "1", "phase field: 0 intact, 1 broken; row 0 at the bottom", "", psi_fraction_bits},
       take_psi,
       give_psi},
      {{"/psi_initial", Type::f4, {z_dim, x_dim}, "1", "phase field at the start", "", psi_fraction_bits},
       [](const View& v) {
         return Array{Type::f4, plane(v.record), bytes_of(v.record.phase_field.psi_initial)};
       },
       [](Record& r, const Array& a) { r.phase_field.psi_initial = values_of<float>(a); }},
      {{"/psi_failure",
        Type::f4,
        {z_dim, x_dim},
        "1",
        "phase field at time_to_failure, or the last state where there is none",
        "",
        psi_fraction_bits},
       [](const View& v) {
         return Array{Type::f4, plane(v.record), bytes_of(v.record.phase_field.psi_failure)};
       },
       [](Record& r, const Array& a) { r.phase_field.psi_failure = values_of<float>(a); }},
      {{"/mask_initial", Type::i1, {z_dim, x_dim}, "1", "1 on nodes of the initial cracks, held at psi = 1"}, take_mask, give_mask},
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
  return table;
}

}  // namespace fracfarm::grammar
