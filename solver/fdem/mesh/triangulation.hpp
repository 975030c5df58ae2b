// Constrained Delaunay triangulation of a rectangle of the lattice: insert points, demand edges, move points, flip back to Delaunay. Own
// code rather than the dual of a Voronoi diagram, because points are added, moved and constrained after the first triangles exist.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "solver/fdem/mesh/lattice.hpp"

namespace fracfarm::fdem {

struct Triangle {
  std::array<int, 3> corner{};                 // counter-clockwise
  std::array<int, 3> across{};                 // neighbour over the edge opposite each corner, -1 at a side of the rectangle
  std::array<unsigned char, 3> constrained{};  // 1: the edge opposite each corner stays
};

class Triangulation {
 public:
  // Two triangles; the corners of the rectangle are points 0 ... 3, counter-clockwise from the origin.
  explicit Triangulation(Point upper_right);

  const std::vector<Point>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

  // The point's number; one that is there already keeps its number. The rectangle must hold p. `near`: a triangle to search from.
  int insert(Point p, int near);
  int triangle_of(int point) const { return triangle_of_[static_cast<std::size_t>(point)]; }

  // The triangle that holds p, or -1 where a constrained edge stands between it and the middle of triangle `from`.
  int locate_in_sight(Point p, int from) const;

  // Makes the edge between two points exist and stay. False where another point or a constrained edge lies in its way.
  bool constrain(int a, int b);

  // Triangles around a point that is not on a side, counter-clockwise, into `star` with the point's place in each. False for a side's
  // point.
  bool star(int point, std::vector<std::pair<int, int>>& star) const;

  // Moves a point whose star stays valid; restore() afterwards.
  void move(int point, Point to) { points_[static_cast<std::size_t>(point)] = to; }

  bool restore();  // flips until every edge that is not constrained is Delaunay; false where that did not end (never seen)

  bool flippable(int triangle, int k) const;  // inner, unconstrained, and its two triangles form a convex quadrilateral
  void flip(int triangle, int k);             // the edge opposite corner k

 private:
  Point at(int point) const { return points_[static_cast<std::size_t>(point)]; }
  Triangle& triangle(int t) { return triangles_[static_cast<std::size_t>(t)]; }
  const Triangle& triangle(int t) const { return triangles_[static_cast<std::size_t>(t)]; }
  std::pair<int, int> locate(Point p, int near) const;  // triangle, and 0 ... 2 where p lies on the edge opposite that corner, else -1
  int add_triangle(const Triangle& made);
  void set_neighbour(int t, int from, int to);
  void split_inside(int t, int point);
  void split_edge(int t, int k, int point);
  void legalise();  // around the point just added: corner 0 of the triangles on the stack
  bool illegal(int t, int k) const;
  std::pair<int, int> edge(int a, int b) const;  // triangle whose edge opposite corner k goes a -> b, or {-1, -1}
  int place_of(int t, int neighbour) const;      // k with across[k] == neighbour
  bool crossing_edges(int a, int b, std::vector<std::pair<int, int>>& crossed) const;

  std::vector<Point> points_;
  std::vector<int> triangle_of_;
  std::vector<Triangle> triangles_;
  std::vector<int> stack_;
};

}  // namespace fracfarm::fdem
