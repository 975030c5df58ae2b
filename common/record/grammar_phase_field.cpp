// Frames of the phase field: psi on the nodes of a regular grid.
#include "common/record/layouts.hpp"
#include "common/record/rounding.hpp"

namespace fracfarm::grammar {
namespace {

std::vector<std::size_t> plane(const Record& r) { return {r.phase_field.z.size(), r.phase_field.x.size()}; }

Array take_mask(const View& view) { return {Type::i1, plane(view.record), bytes_of(view.record.phase_field.mask_initial)}; }
void give_mask(Record& r, const Array& array) { r.phase_field.mask_initial = values_of<unsigned char>(array); }

const std::string z_dim = "/z", x_dim = "/x", t_dim = "/time";

}  // namespace

std::vector<DatasetRow> phase_field_frames() {
  return {
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
       [](const View& v) { return array_of_frames(v.record.phase_field.psi, plane(v.record)); },
       [](Record& r, const Array& a) { r.phase_field.psi = frames_of(a); }},
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
  };
}

std::vector<AttributeRow> phase_field_attributes() {
  return {
      {"/failure", "through_crack_threshold", [](const Record&) -> Value { return through_crack_threshold; }, nullptr},
      {"/failure", "stress_drop_fraction", [](const Record&) -> Value { return stress_drop_fraction; }, nullptr},
      {"/failure", "peak_prominence", [](const Record&) -> Value { return peak_prominence; }, nullptr},
  };
}

}  // namespace fracfarm::grammar
