// Forces and velocities of a strip: rows of nodes among elements of one kind. The internal force of linear elastic quadrants,
// f = -B^T g C epsilon, is gathered from the nine nodes around: the four quadrants of a node share its g, so that sums over them collapse
// to differences. Neighbouring rows share most of these.
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {
namespace {

// What a row of nodes lends to the rows below and above it.
struct Lent {
  Wide x_west, x, x_east, z_west, z, z_east, g_west, g, g_east;
  Wide x_across, z_across;  // times g
};

INLINE Lent lent(const Real* x, const Real* z, const Real* g) {
  Lent row{load(x - 1), load(x), load(x + 1), load(z - 1), load(z), load(z + 1), load(g - 1), load(g), load(g + 1), {}, {}};
  row.x_across = row.g * (row.x_east - row.x_west), row.z_across = row.g * (row.z_east - row.z_west);
  return row;
}

struct WideForce {
  Wide x, z;
};

// Differences along the edges between two rows, times the sum of g at the ends.
INLINE WideForce edges_between(const Lent& south, const Lent& north) {
  const Wide g = south.g + north.g;
  return {g * (north.x - south.x), g * (north.z - south.z)};
}

// Outside the sides the place of a neighbour's stress is taken by the node's own.
struct Sides {
  WideFlags west, east;  // the nodes there
};

INLINE Sides sides(const View& v, Index i) {
  WideFlags column;
  for (Index l = 0; l < width; ++l) column[l] = static_cast<Flag>(i + l);
  return {column == 0, column == static_cast<Flag>(v.columns - 1)};
}

// The forces of a strip's nodes, as wide as an instruction, row by row.
struct Forces {
  Wide x[strip_rows], z[strip_rows];
};

struct Law {
  Real along_x, along_z, c33, c55, c13, shear;  // c33 and c55 twice
};

INLINE Law law_of(const View& v, int j) {
  const Differenced<Real>& c = v.element_rows[j + 1].force;
  return {v.node_rows[j].along_x, v.node_rows[j].along_z, Real(2) * c.c33, Real(2) * c.c55, c.c13, c.shear};
}

// Internal forces of linear elastic quadrants from the bottom up: each row of u and g is read once. They move the nodes at once where
// nothing comes on top, else are put into `forces`.
template <bool at_side, bool moves>
class Column {
 public:
  INLINE Column(const View& v, int first, Index i, Real dt, Forces& forces)
      : c_(law_of(v, first)),
        weight_(load(v.column_weight + i)),
        side_(sides(v, i)),
        stride_(v.stride),
        x_(v.ux + row_at(v, first) + i),
        z_(v.uz + row_at(v, first) + i),
        g_(v.degradation + row_at(v, first) + i),
        vx_(v.vx + row_at(v, first) + i),
        vz_(v.vz + row_at(v, first) + i),
        per_mass_x_(dt * load(v.inverse_mass_x[first] + i)),
        per_mass_z_(dt * load(v.inverse_mass_z[first] + i)),
        forces_(forces) {}

  INLINE void run(int rows) {
    Lent a = lent(x_ - stride_, z_ - stride_, g_ - stride_), b = lent(x_, z_, g_), c{};
    below_ = edges_between(a, b);
    int k = 0;
    for (; k + 3 <= rows; k += 3) row(k, a, b, c), row(k + 1, b, c, a), row(k + 2, c, a, b);
    if (k < rows) row(k, a, b, c);
    if (k + 1 < rows) row(k + 1, b, c, a);
  }

  INLINE Wide stress_xx() const { return c_.along_x * stretch_x_ + Real(2) * c_.c13 * stretch_z_; }
  INLINE Wide stress_zz() const { return c_.c33 * stretch_z_ + Real(2) * c_.c13 * stretch_x_; }
  INLINE Wide square() const { return square_; }  // sum of the squares of twice the mean velocity

 private:
  INLINE void row(int k, const Lent& south, const Lent& here, Lent& north) {
    x_ += stride_, z_ += stride_, g_ += stride_;
    const Lent next = lent(x_, z_, g_);
    const WideForce above = edges_between(here, next);
    const Wide g_east = here.g + here.g_east, g_west = here.g_west + here.g;
    const Wide along_x = c_.along_x * (g_east * (here.x_east - here.x) - g_west * (here.x - here.x_west));
    const Wide along_z = c_.along_z * (g_east * (here.z_east - here.z) - g_west * (here.z - here.z_west));
    const Wide rise_x = next.x - south.x, rise_z = next.z - south.z;
    Wide east_x = next.x_east - south.x_east, east_z = next.z_east - south.z_east;
    Wide west_x = next.x_west - south.x_west, west_z = next.z_west - south.z_west;
    if (at_side) {
      east_x = side_.east ? rise_x : east_x, east_z = side_.east ? rise_z : east_z;
      west_x = side_.west ? rise_x : west_x, west_z = side_.west ? rise_z : west_z;
    }
    const Wide cross_x = c_.c13 * (here.g_east * east_z - here.g_west * west_z);
    const Wide cross_z = c_.shear * (here.g_east * east_x - here.g_west * west_x);
    Wide up_x = c_.c55 * (above.x - below_.x) + c_.shear * (next.z_across - south.z_across);
    Wide up_z = c_.c33 * (above.z - below_.z) + c_.c13 * (next.x_across - south.x_across);
    Wide stretch_x = here.x_across, stretch_z = here.g * rise_z;
    if (at_side) up_x *= weight_, up_z *= weight_, stretch_x *= weight_, stretch_z *= weight_;
    const Wide fx = (along_x + cross_x) + up_x, fz = (along_z + cross_z) + up_z;
    if (moves)
      move(fx, fz);
    else
      forces_.x[k] = fx, forces_.z[k] = fz;
    stretch_x_ += stretch_x, stretch_z_ += stretch_z;
    below_ = above, north = next;
  }

  INLINE void move(Wide fx, Wide fz) {
    const Wide before_x = load(vx_), before_z = load(vz_), x = before_x + per_mass_x_ * fx, z = before_z + per_mass_z_ * fz;
    const Wide mean_x = before_x + x, mean_z = before_z + z;
    square_ += mean_x * mean_x + mean_z * mean_z;
    store(vx_, x), store(vz_, z);
    vx_ += stride_, vz_ += stride_;
  }

  const Law c_;
  const Wide weight_;
  const Sides side_;
  const Index stride_;
  const Real *x_, *z_, *g_;
  Real *vx_, *vz_;
  const Wide per_mass_x_, per_mass_z_;
  Forces& forces_;
  WideForce below_;
  Wide stretch_x_{}, stretch_z_{}, square_{};
};

// True where yielding gives something to the forces of a strip's nodes.
INLINE bool is_given(const View& v, int first, int end, Index i) {
  const unsigned char* gives = v.gives + Index(first - 1) * v.tiles + i / lanes;
  unsigned char any = gives_nothing;
  for (int j = first - 1; j <= end; ++j, gives += v.tiles) any |= *gives;
  return any != gives_nothing;
}

INLINE void add_yielding(const View& v, int first, int end, Index i, Forces& f) {
  for (int j = first; j < end; ++j) add_half_edges(v, j, i, f.x[j - first], f.z[j - first]);
}

INLINE void store_forces(const View& v, int first, int end, Index i, const Forces& f) {
  for (int j = first; j < end; ++j) {
    store(v.fx + row_at(v, j) + i, f.x[j - first]);
    store(v.fz + row_at(v, j) + i, f.z[j - first]);
  }
}

// v += dt f / m; returns the sum of the squares of twice the mean velocity.
template <bool at_side>
INLINE Wide move_on(const View& v, int first, int end, Index i, const Forces& f, Real dt) {
  const Wide weight = load(v.column_weight + i);
  const Wide per_mass_x = dt * load(v.inverse_mass_x[first] + i), per_mass_z = dt * load(v.inverse_mass_z[first] + i);
  Real *vx = v.vx + row_at(v, first) + i, *vz = v.vz + row_at(v, first) + i;
  Wide sum{};
  for (int k = 0; k < end - first; ++k, vx += v.stride, vz += v.stride) {
    const Wide before_x = load(vx), before_z = load(vz), x = before_x + per_mass_x * f.x[k], z = before_z + per_mass_z * f.z[k];
    const Wide mean_x = before_x + x, mean_z = before_z + z, square = mean_x * mean_x + mean_z * mean_z;
    sum += at_side ? weight * square : square;
    store(vx, x), store(vz, z);
  }
  return sum;
}

// What a part of a tile adds to the sums.
struct Added {
  Wide xx, zz, square;
};

template <bool at_side>
INLINE Added kick_part(const View& v, int first, int end, Index i, Real dt) {
  Forces forces;
  const bool given = is_given(v, first, end, i);
  if (!at_side && !given && !v.keeps_forces) {
    Column<at_side, true> column(v, first, i, dt, forces);
    column.run(end - first);
    return {column.stress_xx(), column.stress_zz(), column.square()};
  }
  Column<at_side, false> column(v, first, i, dt, forces);
  column.run(end - first);
  if (given) add_yielding(v, first, end, i, forces);
  if (at_side || v.keeps_forces) store_forces(v, first, end, i, forces);
  return {column.stress_xx(), column.stress_zz(), move_on<at_side>(v, first, end, i, forces, dt)};
}

template <bool at_side>
INLINE void kick_tile(const View& v, int first, int end, Index tile, Real dt, Sums& sums) {
  Partial xx, zz, kinetic;
  for (Index part = 0; part < lanes; part += width) {
    const Added added = kick_part<at_side>(v, first, end, tile + part, dt);
    store(xx.at + part, added.xx), store(zz.at + part, added.zz), store(kinetic.at + part, added.square);
  }
  add(sums.stress_xx, xx, v.hx);
  add(sums.stress_zz, zz, v.hz);
  add(sums.kinetic, kinetic, 0.125 * double(v.node_rows[first].mass));
}

}  // namespace

void kick_strip(const View& v, int first, int end, Real dt, Sums& sums) {
  for (Index tile = 0; tile < v.padded; tile += lanes)
    if (tile == 0 || tile + lanes >= v.columns)
      kick_tile<true>(v, first, end, tile, dt, sums);
    else
      kick_tile<false>(v, first, end, tile, dt, sums);
}

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
