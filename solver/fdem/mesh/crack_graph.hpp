// Lines as a plane graph with clearance: vertices at least half an element apart, and no vertex nearer than 0.35 elements to an edge that
// does not end in it. Lines that come too near others are led over their vertices, crossings become vertices.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/fdem/mesh/geometry.hpp"

namespace fracfarm::fdem {

enum class LineKind : unsigned char { layer, crack, side };  // where lines share an edge the later kind counts

struct GraphEdge {
  int a = 0, b = 0;
  LineKind kind = LineKind::crack;
};

class CrackGraph {
 public:
  CrackGraph(double width, double height, double element_size, const std::vector<double>& layers);

  // The vertex at a point of a crack: one that is there within half an element, else the foot on a side, layer or edge that is near, else
  // p.
  int place(Vec p);
  // A vertex of a side or layer, exactly there unless one is within half an element.
  int place_fixed(Vec p);

  // The line from vertex a to b in pieces of about an element; sides and layers before cracks.
  void draw(int a, int b, LineKind kind);

  // Is p at least `from_vertices` and `from_edges` away? Both at most one element.
  bool clear(Vec p, double from_vertices, double from_edges) const;

  const std::vector<Vec>& vertices() const { return vertices_; }
  std::vector<GraphEdge> edges() const;  // those that are left
  int merged() const { return merged_; }
  bool tangled() const { return tangled_; }  // gave up: too many repairs

 private:
  struct Obstacle {
    int vertex = -1;  // to lead the line over
    int edge = -1;    // that is crossed
    Vec at;           // there
    double distance = 1e300;
  };
  void connect(int a, int b, LineKind kind);
  Obstacle vertex_near(int a, int b) const;
  Obstacle crossed_edge(int a, int b) const;
  void cross_at(int a, int b, LineKind kind, const Obstacle& crossing);
  int nearest_vertex(Vec p, double within) const;
  int nearest_edge(Vec p, double within, int apart_from) const;  // of those that do not end in vertex `apart_from`
  void lead_edges_over(int vertex);
  int add_vertex(Vec p);
  void add_edge(int a, int b, LineKind kind);
  void remove_edge(int edge);
  int find_edge(int a, int b) const;
  Vec onto_fixed_line(Vec p) const;
  Vec at(int vertex) const { return vertices_[static_cast<std::size_t>(vertex)]; }
  template <class Visit>
  void visit_cells(Vec low, Vec high, const Visit& visit) const;

  double width_, height_, size_, tolerance_, clearance_;
  std::vector<double> layers_;
  int columns_, rows_;
  std::vector<std::vector<int>> vertices_in_, edges_in_;  // by cell of one element
  std::vector<Vec> vertices_;
  std::vector<GraphEdge> edges_;  // a < 0: removed
  int merged_ = 0, spent_ = 0, depth_ = 0;
  bool tangled_ = false;
};

// Sides, layers and repaired cracks as one graph.
CrackGraph draw_lines(double width, double height, double element_size, const std::vector<double>& layers,
                      const std::vector<Segment>& cracks);

}  // namespace fracfarm::fdem
