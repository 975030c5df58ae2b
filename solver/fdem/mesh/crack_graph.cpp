#include "solver/fdem/mesh/crack_graph.hpp"

#include <algorithm>

namespace fracfarm::fdem {
namespace {

constexpr double tolerance_share = 0.5;   // of the element size: vertices closer than this become one
constexpr double clearance_share = 0.35;  // below 0.5/sqrt 2, so that a line led over a vertex falls into shorter pieces
constexpr int most_work = 4'000'000;      // pieces and obstacles looked at
constexpr int most_depth = 200;           // of pieces within pieces; some ten are seen

}  // namespace

CrackGraph::CrackGraph(double width, double height, double element_size, const std::vector<double>& layers)
    : width_(width),
      height_(height),
      size_(element_size),
      tolerance_(tolerance_share * element_size),
      clearance_(clearance_share * element_size),
      layers_(layers),
      columns_(static_cast<int>(width / element_size) + 1),
      rows_(static_cast<int>(height / element_size) + 1),
      vertices_in_(static_cast<std::size_t>(columns_) * rows_),
      edges_in_(vertices_in_.size()) {}

template <class Visit>
void CrackGraph::visit_cells(Vec low, Vec high, const Visit& visit) const {
  const auto cell = [&](double x, int count) { return static_cast<int>(std::clamp(x / size_, 0.0, count - 1.0)); };
  for (int row = cell(low.z, rows_), row_end = cell(high.z, rows_); row <= row_end; ++row)
    for (int column = cell(low.x, columns_), end = cell(high.x, columns_); column <= end; ++column)
      visit(static_cast<std::size_t>(row) * columns_ + column);
}

int CrackGraph::nearest_vertex(Vec p, double within) const {
  int best = -1;
  visit_cells(p - Vec{within, within}, p + Vec{within, within}, [&](std::size_t cell) {
    for (const int v : vertices_in_[cell]) {
      const double d = distance(p, at(v));
      if (d < within || (d == within && v < best)) within = d, best = v;
    }
  });
  return best;
}

int CrackGraph::nearest_edge(Vec p, double within, int apart_from) const {
  int best = -1;
  visit_cells(p - Vec{within, within}, p + Vec{within, within}, [&](std::size_t cell) {
    for (const int e : edges_in_[cell]) {
      const GraphEdge& edge = edges_[static_cast<std::size_t>(e)];
      if (edge.a == apart_from || edge.b == apart_from) continue;
      const double d = distance_to(p, at(edge.a), at(edge.b));
      if (d < within || (d == within && e < best)) within = d, best = e;
    }
  });
  return best;
}

bool CrackGraph::clear(Vec p, double from_vertices, double from_edges) const {
  bool good = true;
  const double reach = std::max(from_vertices, from_edges);
  visit_cells(p - Vec{reach, reach}, p + Vec{reach, reach}, [&](std::size_t cell) {
    for (const int e : edges_in_[cell]) {
      if (!good) return;
      const GraphEdge& edge = edges_[static_cast<std::size_t>(e)];
      good = distance_to(p, at(edge.a), at(edge.b)) >= from_edges && distance(p, at(edge.a)) >= from_vertices &&
             distance(p, at(edge.b)) >= from_vertices;
    }
  });
  return good;
}

int CrackGraph::add_vertex(Vec p) {
  const int vertex = static_cast<int>(vertices_.size());
  vertices_.push_back(p);
  visit_cells(p, p, [&](std::size_t cell) { vertices_in_[cell].push_back(vertex); });
  return vertex;
}

int CrackGraph::find_edge(int a, int b) const {
  int found = -1;
  visit_cells(at(a), at(a), [&](std::size_t cell) {
    for (const int e : edges_in_[cell]) {
      const GraphEdge& edge = edges_[static_cast<std::size_t>(e)];
      if ((edge.a == a && edge.b == b) || (edge.a == b && edge.b == a)) found = e;
    }
  });
  return found;
}

void CrackGraph::add_edge(int a, int b, LineKind kind) {
  const int edge = static_cast<int>(edges_.size());
  edges_.push_back({a, b, kind});
  const Vec p = at(a), q = at(b);
  visit_cells({std::min(p.x, q.x), std::min(p.z, q.z)}, {std::max(p.x, q.x), std::max(p.z, q.z)},
              [&](std::size_t cell) { edges_in_[cell].push_back(edge); });
}

void CrackGraph::remove_edge(int edge) {
  const GraphEdge gone = edges_[static_cast<std::size_t>(edge)];
  const Vec p = at(gone.a), q = at(gone.b);
  auto& cells = edges_in_;
  visit_cells({std::min(p.x, q.x), std::min(p.z, q.z)}, {std::max(p.x, q.x), std::max(p.z, q.z)},
              [&](std::size_t cell) { std::erase(cells[cell], edge); });
  edges_[static_cast<std::size_t>(edge)].a = -1;
}

std::vector<GraphEdge> CrackGraph::edges() const {
  std::vector<GraphEdge> left;
  for (const GraphEdge& edge : edges_)
    if (edge.a >= 0) left.push_back(edge);
  return left;
}

// Points nearer than the tolerance to a side or layer lie on it; into a corner of the body where two sides are near.
Vec CrackGraph::onto_fixed_line(Vec p) const {
  if (p.x < tolerance_) p.x = 0;
  if (p.x > width_ - tolerance_) p.x = width_;
  if (p.z < tolerance_) p.z = 0;
  if (p.z > height_ - tolerance_) p.z = height_;
  double near = tolerance_;
  for (const double z : layers_)
    if (std::fabs(p.z - z) < near && p.z > 0 && p.z < height_) near = std::fabs(p.z - z), p.z = z;
  return p;
}

int CrackGraph::place_fixed(Vec p) {
  const int there = nearest_vertex(p, tolerance_);
  return there >= 0 ? there : add_vertex(p);
}

int CrackGraph::place(Vec p) {
  const Vec drawn = p;
  p = onto_fixed_line(p);
  int there = nearest_vertex(p, tolerance_);
  merged_ += distance(drawn, there >= 0 ? at(there) : p) > 1e-6 * size_;
  if (there >= 0) return there;
  if (const int near = nearest_edge(p, clearance_, -1); near >= 0) {
    const GraphEdge& edge = edges_[static_cast<std::size_t>(near)];
    const Vec foot = nearest_on(p, at(edge.a), at(edge.b));
    if (edge.kind != LineKind::crack || nearest_vertex(foot, tolerance_) < 0) p = foot;
  }
  there = place_fixed(p);
  lead_edges_over(there);
  return there;
}

// Edges nearer than the clearance: split where the vertex lies on them, bent where it lies beside.
void CrackGraph::lead_edges_over(int vertex) {
  for (int near = 0; !tangled_ && (near = nearest_edge(at(vertex), clearance_, vertex)) >= 0;) {
    const GraphEdge edge = edges_[static_cast<std::size_t>(near)];
    remove_edge(near);
    connect(edge.a, vertex, edge.kind);
    connect(vertex, edge.b, edge.kind);
  }
}

void CrackGraph::draw(int a, int b, LineKind kind) {
  const Vec p = at(a), q = at(b);
  const int pieces = std::max(1, static_cast<int>(std::lround(distance(p, q) / size_)));
  int from = a;
  for (int i = 1; i <= pieces && !tangled_; ++i) {
    const Vec step = along(p, q, static_cast<double>(i) / pieces);
    const int to = i == pieces ? b : kind == LineKind::crack ? place(step) : place_fixed(step);
    connect(from, to, kind);
    from = to;
  }
}

CrackGraph::Obstacle CrackGraph::vertex_near(int a, int b) const {
  Obstacle best;
  const Vec p = at(a), q = at(b), reach{clearance_, clearance_};
  visit_cells(Vec{std::min(p.x, q.x), std::min(p.z, q.z)} - reach, Vec{std::max(p.x, q.x), std::max(p.z, q.z)} + reach,
              [&](std::size_t cell) {
                for (const int v : vertices_in_[cell]) {
                  if (v == a || v == b) continue;
                  const double d = distance_to(at(v), p, q);
                  if (d < clearance_ && (d < best.distance || (d == best.distance && v < best.vertex))) best = {v, -1, at(v), d};
                }
              });
  return best;
}

CrackGraph::Obstacle CrackGraph::crossed_edge(int a, int b) const {
  Obstacle best;
  const Vec p = at(a), q = at(b);
  visit_cells({std::min(p.x, q.x), std::min(p.z, q.z)}, {std::max(p.x, q.x), std::max(p.z, q.z)}, [&](std::size_t cell) {
    for (const int e : edges_in_[cell]) {
      const GraphEdge& edge = edges_[static_cast<std::size_t>(e)];
      if (edge.a == a || edge.a == b || edge.b == a || edge.b == b) continue;
      const auto meet = meeting(p, q, at(edge.a), at(edge.b));
      if (!meet || meet->first <= 0 || meet->first >= 1 || meet->second <= 0 || meet->second >= 1) continue;
      const double way = meet->first * distance(p, q);
      if (way < best.distance || (way == best.distance && e < best.edge)) best = {-1, e, along(p, q, meet->first), way};
    }
  });
  return best;
}

// Over the nearest vertex in the way, else through the first crossing, else straight.
void CrackGraph::connect(int a, int b, LineKind kind) {
  if (a == b || tangled_) return;
  if (++spent_ > most_work || depth_ > most_depth) {
    tangled_ = true;
    return;
  }
  if (const int there = find_edge(a, b); there >= 0) {
    GraphEdge& edge = edges_[static_cast<std::size_t>(there)];
    edge.kind = std::max(edge.kind, kind);
    return;
  }
  ++depth_;
  if (const Obstacle vertex = vertex_near(a, b); vertex.vertex >= 0) {
    merged_ += kind == LineKind::crack && vertex.distance > 1e-6 * size_;
    connect(a, vertex.vertex, kind);
    connect(vertex.vertex, b, kind);
  } else if (const Obstacle crossing = crossed_edge(a, b); crossing.edge >= 0) {
    cross_at(a, b, kind, crossing);
  } else {
    add_edge(a, b, kind);
  }
  --depth_;
}

// The crossing becomes a vertex of both lines, or both are led over the vertex that is within the tolerance of it.
void CrackGraph::cross_at(int a, int b, LineKind kind, const Obstacle& crossing) {
  const GraphEdge other = edges_[static_cast<std::size_t>(crossing.edge)];
  const int vertex = place(other.kind == LineKind::crack ? crossing.at : nearest_on(crossing.at, at(other.a), at(other.b)));
  if (edges_[static_cast<std::size_t>(crossing.edge)].a >= 0 && vertex != other.a && vertex != other.b) {
    remove_edge(crossing.edge);
    connect(other.a, vertex, other.kind);
    connect(vertex, other.b, other.kind);
  }
  connect(a, vertex, kind);
  connect(vertex, b, kind);
}

namespace {

// A straight line that is to be drawn, and the vertices on it with their shares of its length.
struct Line {
  Vec from, to;
  LineKind kind;
  std::vector<std::pair<double, int>> on;
};

// Sides and layers stay straight: they take only what lies on them.
void add_on(const CrackGraph& graph, Line& line, Vec p, int vertex) {
  const Vec v = graph.vertices()[static_cast<std::size_t>(vertex)];
  if (line.kind != LineKind::crack && (line.from.x == line.to.x ? v.x != line.from.x : v.z != line.from.z)) return;
  line.on.emplace_back(foot_share(line.kind == LineKind::crack ? p : v, line.from, line.to), vertex);
}

std::vector<Line> all_lines(double width, double height, const std::vector<double>& layers, const std::vector<Segment>& cracks) {
  std::vector<Line> lines;
  for (const auto& [p, q] : {std::pair{Vec{0, 0}, Vec{width, 0}},
                             {Vec{width, 0}, Vec{width, height}},
                             {Vec{0, height}, Vec{width, height}},
                             {Vec{0, 0}, Vec{0, height}}})
    lines.push_back({p, q, LineKind::side, {}});
  for (const double z : layers) lines.push_back({{0, z}, {width, z}, LineKind::layer, {}});
  for (const Segment& crack : cracks) lines.push_back({first(crack), last(crack), LineKind::crack, {}});
  return lines;
}

// Ends first, since they are where a crack starts to grow, then crossings; each is a vertex of every line that runs through it.
void place_ends(CrackGraph& graph, std::vector<Line>& lines, double reach) {
  for (Line& line : lines)
    for (const Vec end : {line.from, line.to}) {
      const int vertex = line.kind == LineKind::crack ? graph.place(end) : graph.place_fixed(end);
      add_on(graph, line, end, vertex);
      for (Line& other : lines)
        if (&other != &line && distance_to(end, other.from, other.to) < reach) add_on(graph, other, end, vertex);
    }
}

void place_crossings(CrackGraph& graph, std::vector<Line>& lines) {
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto meet = meeting(lines[i].from, lines[i].to, lines[j].from, lines[j].to);
      if (!meet || std::min(meet->first, meet->second) < 0 || std::max(meet->first, meet->second) > 1) continue;
      const Vec p = along(lines[j].from, lines[j].to, meet->second);
      const int vertex = graph.place(p);
      add_on(graph, lines[i], p, vertex);
      add_on(graph, lines[j], p, vertex);
    }
}

}  // namespace

CrackGraph draw_lines(double width, double height, double element_size, const std::vector<double>& layers,
                      const std::vector<Segment>& cracks) {
  CrackGraph graph(width, height, element_size, layers);
  std::vector<Line> lines = all_lines(width, height, layers, cracks);
  for (const Vec corner : {Vec{0, 0}, Vec{width, 0}, Vec{width, height}, Vec{0, height}}) graph.place_fixed(corner);
  place_ends(graph, lines, 1e-3 * element_size);
  place_crossings(graph, lines);
  for (Line& line : lines) {
    std::sort(line.on.begin(), line.on.end());
    for (std::size_t i = 0; i + 1 < line.on.size(); ++i) graph.draw(line.on[i].second, line.on[i + 1].second, line.kind);
  }
  return graph;
}

}  // namespace fracfarm::fdem
