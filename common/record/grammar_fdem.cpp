// Frames of FDEM: the undeformed mesh, damage on the edges between its triangles, and when and how each of them broke.
#include <algorithm>
#include <limits>
#include <numeric>

#include "common/failure/failure_pick.hpp"
#include "common/record/layouts.hpp"
#include "common/record/rounding.hpp"

namespace fracfarm::grammar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Rows of `width` numbers each.
template <class Row>
Array table_of(Type type, const std::vector<Row>& rows) {
  return {type, {rows.size(), std::tuple_size_v<Row>}, bytes_of(rows)};
}

// None where they are not as long as they should be.
template <class Row>
std::vector<Row> rows_of(const Array& array) {
  return array.dims[1] == std::tuple_size_v<Row> ? values_of<Row>(array) : std::vector<Row>{};
}

Array take_nodes(const View& view) {
  std::vector<std::array<double, 3>> nodes;
  for (const auto& [x, z] : view.record.fdem.mesh.nodes) nodes.push_back({x, 0.0, z});
  return table_of(Type::f8, nodes);
}

// A node out of the plane becomes one that no rule accepts.
void give_nodes(Record& r, const Array& array) {
  for (const auto& [x, y, z] : rows_of<std::array<double, 3>>(array)) r.fdem.mesh.nodes.push_back({x, y == 0.0 ? z : nan});
}

// 0, 1, …: a scale along which something is counted. Every dimension has one: ParaView's NetCDF reader crashes on those that have none.
Array numbers(std::size_t count) {
  std::vector<std::int32_t> values(count);
  std::iota(values.begin(), values.end(), 0);
  return {Type::i4, {count}, bytes_of(values)};
}

DatasetRow scale(const std::string& path, std::string meaning, Array (*take)(const View&)) {
  return {{path, Type::i4, {path}, "1", std::move(meaning)}, take, nullptr};
}

Array by_edge(const std::vector<float>& values) { return {Type::f4, {values.size()}, bytes_of(values)}; }

Value take_disagreement(const Record& r) { return disagreement(r.failure_times).value_or(nan); }

// Of the rows as they are stored; not a number where columns are missing or of unlike lengths, which others report.
Value take_settled(const Record& r) {
  const std::array columns{r.series.find("step_time"), r.series.find("stress_zz"), r.series.find("total_stress"),
                           r.series.find("kinetic_energy")};
  for (const Column* column : columns)
    if (!column || column->values.size() != r.series.rows()) return nan;
  FailurePick pick;
  for (std::size_t row = 0; row < r.series.rows(); ++row)
    pick.add({columns[0]->values[row], columns[1]->values[row], columns[2]->values[row], columns[3]->values[row]});
  return pick.settled_at().value_or(nan);
}

const std::string t_dim = "/time", e_dim = "/edge", n_dim = "/node", m_dim = "/triangle", xyz_dim = "/component", corner_dim = "/corner",
                  end_dim = "/end";
const std::string damage_range = "0 intact, 1 broken, 2 initial crack";
const std::string never_up = "; below 1 stays below 1";

}  // namespace

std::vector<DatasetRow> fdem_frames() {
  return {
      {{"/time", Type::f8, {t_dim}, "s", "time of the frame since the start", "T"},
       [](const View& v) { return array_of(v.record.fdem.time, {v.record.fdem.time.size()}); },
       [](Record& r, const Array& a) { r.fdem.time = doubles_of(a); }},
      scale(n_dim, "number of the node", [](const View& v) { return numbers(v.record.fdem.mesh.nodes.size()); }),
      scale(m_dim, "number of the triangle", [](const View& v) { return numbers(v.record.fdem.mesh.triangles.size()); }),
      scale(e_dim, "number of the edge between two triangles", [](const View& v) { return numbers(v.record.fdem.mesh.edge_nodes.size()); }),
      scale(xyz_dim, "x, y, z", [](const View&) { return numbers(3); }),
      scale(corner_dim, "corner of a triangle", [](const View&) { return numbers(3); }),
      scale(end_dim, "end of an edge, or side of it", [](const View&) { return numbers(2); }),
      {{"/node_xyz", Type::f8, {n_dim, xyz_dim}, "m", "undeformed nodes: x to the right, y = 0, z up", "", 0, "", Chunking::columns},
       take_nodes,
       give_nodes},
      {{"/tri_nodes", Type::i4, {m_dim, corner_dim}, "", "nodes of each triangle, counter-clockwise seen with z up"},
       [](const View& v) { return table_of(Type::i4, v.record.fdem.mesh.triangles); },
       [](Record& r, const Array& a) { r.fdem.mesh.triangles = rows_of<std::array<int, 3>>(a); }},
      {{"/edge_nodes", Type::i4, {e_dim, end_dim}, "", "nodes at the ends of each edge"},
       [](const View& v) { return table_of(Type::i4, v.record.fdem.mesh.edge_nodes); },
       [](Record& r, const Array& a) { r.fdem.mesh.edge_nodes = rows_of<std::array<int, 2>>(a); }},
      {{"/edge_tris", Type::i4, {e_dim, end_dim}, "", "triangles left and right of the way from the edge's first node to its second"},
       [](const View& v) { return table_of(Type::i4, v.record.fdem.mesh.edge_triangles); },
       [](Record& r, const Array& a) { r.fdem.mesh.edge_triangles = rows_of<std::array<int, 2>>(a); }},
      {{"/edge_kind", Type::i1, {e_dim}, "1", "1 on the edges of the initial cracks, 0 on joints"},
       [](const View& v) {
         return Array{Type::i1, {v.record.fdem.mesh.edge_kind.size()}, bytes_of(v.record.fdem.mesh.edge_kind)};
       },
       [](Record& r, const Array& a) { r.fdem.mesh.edge_kind = values_of<EdgeKind>(a); }},
      {{"/damage", Type::f4, {t_dim, e_dim}, "1", "damage of the edge: " + damage_range, "", psi_fraction_bits, never_up, Chunking::blocks},
       [](const View& v) { return array_of_frames(v.record.fdem.damage, {v.record.fdem.mesh.edge_nodes.size()}); },
       [](Record& r, const Array& a) { r.fdem.damage = frames_of(a); }},
      {{"/damage_initial", Type::f4, {e_dim}, "1", "damage at the start: " + damage_range, "", psi_fraction_bits, never_up},
       [](const View& v) { return by_edge(v.record.fdem.damage_initial); },
       [](Record& r, const Array& a) { r.fdem.damage_initial = values_of<float>(a); }},
      {{"/damage_failure",
        Type::f4,
        {e_dim},
        "1",
        "damage at time_to_failure, or the last state where there is none: " + damage_range,
        "",
        psi_fraction_bits,
        never_up},
       [](const View& v) { return by_edge(v.record.fdem.damage_failure); },
       [](Record& r, const Array& a) { r.fdem.damage_failure = values_of<float>(a); }},
      {{"/break_time", Type::f8, {e_dim}, "s", "when the edge broke, not a number where it never did"},
       [](const View& v) { return array_of(v.record.fdem.break_time, {v.record.fdem.break_time.size()}); },
       [](Record& r, const Array& a) { r.fdem.break_time = doubles_of(a); }},
      {{"/break_mode", Type::i1, {e_dim}, "1", "how the edge broke: 0 did not, 1 in tension, 2 in shear, 3 in both"},
       [](const View& v) {
         return Array{Type::i1, {v.record.fdem.break_mode.size()}, bytes_of(v.record.fdem.break_mode)};
       },
       [](Record& r, const Array& a) { r.fdem.break_mode = values_of<unsigned char>(a); }},
  };
}

std::vector<AttributeRow> fdem_attributes() {
  return {
      {"/failure", "disagreement", take_disagreement, nullptr},  // s, between the first and the last candidate
      {"/failure", "five_step_settled", take_settled, nullptr},  // s, when the run could take the pick as settled
      {"/failure", "stress_drop_fraction", [](const Record&) -> Value { return stress_drop_fraction; }, nullptr},
      {"/failure", "peak_prominence", [](const Record&) -> Value { return peak_prominence; }, nullptr},
      {"/failure", "settling_wait", [](const Record&) -> Value { return settling_wait; }, nullptr},
      {"/failure", "settling_quiet", [](const Record&) -> Value { return settling_quiet; }, nullptr},
  };
}

}  // namespace fracfarm::grammar
