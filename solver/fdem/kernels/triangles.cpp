// Triangles: rho u_tt = div P on constant-strain triangles that own their three nodes, with a third of the mass at each.
//   f_i = -A P grad N_i + joints + extra, v += dt f / m, u += dt v
//   P = R (C (U - I) + xi sym(R^T dH/dt)), metals: C (U - I - plastic)
#include "solver/fdem/kernels/lanes.hpp"
#include "solver/law/plane_return.hpp"

namespace fracfarm::fdem::FRACFARM_KERNELS {

using Gradient = law::Gradient<Lanes>;
using Strain = law::Strain<Lanes>;
using Stress = law::Stress<Lanes>;
using Plastic = law::Plastic<Lanes>;
using J2 = law::J2<Lanes>;

namespace {

struct Corners {
  Lanes x0, z0, x1, z1, x2, z2;
};

INLINE Corners load_corners(const Real* at) {
  return {load(at), load(at + lanes), load(at + 2 * lanes), load(at + 3 * lanes), load(at + 4 * lanes), load(at + 5 * lanes)};
}

INLINE void store_corners(Real* at, const Corners& c) {
  store(at, c.x0), store(at + lanes, c.z0), store(at + 2 * lanes, c.x1), store(at + 3 * lanes, c.z1);
  store(at + 4 * lanes, c.x2), store(at + 5 * lanes, c.z2);
}

template <class Join>
INLINE Corners each(const Corners& a, const Corners& b, const Join& join) {
  return {join(a.x0, b.x0), join(a.z0, b.z0), join(a.x1, b.x1), join(a.z1, b.z1), join(a.x2, b.x2), join(a.z2, b.z2)};
}

INLINE Corners operator+(const Corners& a, const Corners& b) {
  return each(
      a, b, [](Lanes p, Lanes q) __attribute__((always_inline)) { return p + q; });
}
INLINE Corners operator*(Lanes a, const Corners& b) { return {a * b.x0, a * b.z0, a * b.x1, a * b.z1, a * b.x2, a * b.z2}; }

// B, the inverse of the matrix whose columns are the edges from corner 0: its rows are the gradients of N_1 and N_2.
struct Shape {
  Lanes b11, b12, b21, b22, area, per_mass;
};

INLINE Shape load_shape(const Real* at) {
  return {load(at), load(at + lanes), load(at + 2 * lanes), load(at + 3 * lanes), load(at + 4 * lanes), load(at + 5 * lanes)};
}

INLINE Gradient gradient(const Corners& u, const Shape& B) {
  const Lanes x1 = u.x1 - u.x0, x2 = u.x2 - u.x0, z1 = u.z1 - u.z0, z2 = u.z2 - u.z0;
  return {x1 * B.b11 + x2 * B.b21, x1 * B.b12 + x2 * B.b22, z1 * B.b11 + z2 * B.b21, z1 * B.b12 + z2 * B.b22};
}

// -P grad N_i.
INLINE Corners pull(const Gradient& P, const Shape& B) {
  const Lanes x1 = P.xx * B.b11 + P.xz * B.b12, z1 = P.zx * B.b11 + P.zz * B.b12;
  const Lanes x2 = P.xx * B.b21 + P.xz * B.b22, z2 = P.zx * B.b21 + P.zz * B.b22;
  return {x1 + x2, z1 + z2, -x1, -z1, -x2, -z2};
}

// Forces of the three joints on the corners.
INLINE Corners joint_forces(const Real* slots) {
  const Lanes4 e0 = load_rows(LANE_AT { return slots + l * slot_size; });
  const Lanes4 e1 = load_rows(LANE_AT { return slots + l * slot_size + 4; });
  const Lanes4 e2 = load_rows(LANE_AT { return slots + l * slot_size + 8; });
  return {e0.a + e2.c, e0.b + e2.d, e0.c + e1.a, e0.d + e1.b, e1.c + e2.a, e1.d + e2.b};
}

INLINE Corners extra_forces(const Real* rows) {
  const Lanes4 first = load_rows(LANE_AT { return rows + l * row_size; });
  const Lanes4 rest = load_rows(LANE_AT { return rows + l * row_size + 4; });
  return {first.a, first.b, first.c, first.d, rest.a, rest.b};
}

INLINE void store_rows_of(Real* rows, const Corners& u) {
  store_rows(LANE_AT { return rows + l * row_size; }, {u.x0, u.z0, u.x1, u.z1});
  store_rows(LANE_AT { return rows + l * row_size + 4; }, {u.x2, u.z2, u.x0, u.z0});
}

INLINE Plastic load_plastic(const Real* at) { return {load(at), load(at + lanes), load(at + 2 * lanes), load(at + 3 * lanes)}; }
INLINE void store_plastic(Real* at, const Plastic& p) {
  store(at, p.xx), store(at + lanes, p.zz), store(at + 2 * lanes, p.xz), store(at + 3 * lanes, p.alpha);
}

INLINE law::Stiffness<Lanes> stiffness(const law::Stiffness<Real>& C) { return {C.C11, C.C13, C.C33, C.C55}; }
INLINE J2 wide(const law::J2<Real>& j2) { return {j2.bulk, j2.mu, j2.yield, j2.hardening}; }

// What the strain of one register of triangles gives.
struct Response {
  Stress stress;
  Plastic plastic;
  Lanes plastic_work;  // J/m^3, of this step
  Lanes stored;        // J/m^3
};

INLINE Response elastic_response(const TriangleLaw<Real>& law, const Strain& strain) {
  const auto C = stiffness(law.stiffness);
  const Stress stress = law::stress(C, strain);
  return {stress, {}, Lanes(Real(0)), Lanes(Real(0.5)) * (stress.xx * strain.xx + stress.zz * strain.zz + stress.xz * strain.xz)};
}

// kept: where the plastic state lies, which is left as it is where nothing flows.
INLINE Response plastic_response(const TriangleLaw<Real>& law, const Strain& strain, const Real* kept, bool always) {
  const J2 j2 = wide(law.j2);
  const Plastic old = load_plastic(kept);
  Plastic now = old;
  Lanes work(Real(0));
  if (always || any(law::yields(j2, strain, old))) {
    now = law::flow(j2, strain, old);
    work = law::plastic_work(j2, now) - law::plastic_work(j2, old);
  }
  const auto answer = law::response(j2, strain, now);
  return {answer.stress, now, work, answer.stored};
}

struct Internal {
  Gradient P;
  Response response;
  Lanes viscous;  // W/m^3
};

template <bool plastic>
INLINE Internal internal(const View& view, const TriangleLaw<Real>& law, const Shape& B, const Corners& u, const Corners& v,
                         const Real* kept) {
  const Gradient H = gradient(u, B);
  const auto R = law::turn(H);
  const Strain strain = law::biot(H, R), rate = law::rate(gradient(v, B), R);
  Response response;
  if constexpr (plastic)
    response = plastic_response(law, strain, kept, view.always_flow);
  else
    response = elastic_response(law, strain);
  const Lanes xi = law.viscosity;
  const Stress drag{xi * rate.xx, xi * rate.zz, Lanes(Real(0.5)) * xi * rate.xz};
  const Stress all{response.stress.xx + drag.xx, response.stress.zz + drag.zz, response.stress.xz + drag.xz};
  return {law::piola(all, strain, R), response, drag.xx * rate.xx + drag.zz * rate.zz + drag.xz * rate.xz};
}

// Where the registers of part s of block b lie.
struct Place {
  Index corners, shape, plastic, rows, slots;
  INLINE Place(int b, int s)
      : corners(Index(b) * corner_count * lanes + s * width),
        shape(Index(b) * shape_count * lanes + s * width),
        plastic(Index(b) * 4 * lanes + s * width),
        rows((Index(b) * lanes + s * width) * row_size),
        slots((Index(b) * lanes + s * width) * slot_size) {}
};

INLINE Corners outer_forces(const View& view, const Place& at, unsigned char needs) {
  Corners f = joint_forces(view.slots + at.slots);
  if (needs & needs_extra) f = f + extra_forces(view.extra + at.rows);
  return f;
}

// dt f / m of a register of triangles.
INLINE Corners kick_of(const TriangleLaw<Real>& law, const Shape& B, const Gradient& P, const Corners& outer, Real dt) {
  return Lanes(dt * law.per_mass) * pull(P, B) + (Lanes(dt) * B.per_mass) * outer;
}

// Where velocities are told: keeps the force and puts the told velocity in place of the kicked one.
INLINE void obey(const View& view, int b, int s, const Shape& B, const Corners& kick, Real dt, Corners& v) {
  const Index at = Index(view.told_of_block[b]) * corner_count * lanes + s * width;
  const Lanes per_kick = Lanes(Real(1)) / (Lanes(dt) * larger(B.per_mass, Lanes(Real(1e-30))));
  store_corners(view.told_force + at, per_kick * kick);
  const Corners told = load_corners(view.told + at), velocity = load_corners(view.told_velocity + at);
  const auto swap = [](Lanes is_told, Lanes given, Lanes free) __attribute__((always_inline)) {
    return select(is_told > Lanes(Real(0)), given, free);
  };
  v = {swap(told.x0, velocity.x0, v.x0), swap(told.z0, velocity.z0, v.z0), swap(told.x1, velocity.x1, v.x1),
       swap(told.z1, velocity.z1, v.z1), swap(told.x2, velocity.x2, v.x2), swap(told.z2, velocity.z2, v.z2)};
}

struct AdvanceParts {
  LaneSums viscous, plastic;
};

template <bool plastic>
INLINE void advance_part(const View& view, const TriangleLaw<Real>& law, int b, int s, Real dt, AdvanceParts& sums) {
  const Place at(b, s);
  const Shape B = load_shape(view.shape + at.shape);
  const Corners u = load_corners(view.u + at.corners), v = load_corners(view.v + at.corners);
  const Internal inside = internal<plastic>(view, law, B, u, v, view.plastic + at.plastic);
  const unsigned char needs = view.needs[b];
  const Corners kick = kick_of(law, B, inside.P, outer_forces(view, at, needs), dt);
  Corners faster = v + kick;
  if (needs & needs_told) obey(view, b, s, B, kick, dt, faster);
  const Corners moved = u + Lanes(dt) * faster;
  store_corners(view.v + at.corners, faster);
  store_corners(view.u + at.corners, moved);
  store_rows_of(view.rows + at.rows, moved);
  sums.viscous.part[s] = sums.viscous.part[s] + B.area * inside.viscous;
  if constexpr (plastic) {
    store_plastic(view.plastic + at.plastic, inside.response.plastic);
    sums.plastic.part[s] = sums.plastic.part[s] + B.area * inside.response.plastic_work;
  }
}

struct MeasureParts {
  LaneSums xx, zz, elastic, plastic, viscous, kinetic, fastest;
};

INLINE void add(Lanes& sum, Lanes value) { sum = sum + value; }

INLINE Lanes product(const Corners& a, const Corners& b) {
  return ((a.x0 * b.x0 + a.z0 * b.z0) + (a.x1 * b.x1 + a.z1 * b.z1)) + (a.x2 * b.x2 + a.z2 * b.z2);
}

template <bool plastic>
INLINE void measure_part(const View& view, const TriangleLaw<Real>& law, int b, int s, Real dt, MeasureParts& sums) {
  const Place at(b, s);
  const Shape B = load_shape(view.shape + at.shape);
  const Corners u = load_corners(view.u + at.corners), v = load_corners(view.v + at.corners);
  const Internal inside = internal<plastic>(view, law, B, u, v, view.plastic + at.plastic);
  const unsigned char needs = view.needs[b];
  const Corners kick = kick_of(law, B, inside.P, outer_forces(view, at, needs), dt);
  Corners faster = v + kick;
  if (needs & needs_told) obey(view, b, s, B, kick, dt, faster);
  const Lanes half_mass = B.area * Lanes(Real(0.5) / law.per_mass), least(view.least_kinetic);
  const Lanes square = product(v, v);
  add(sums.xx.part[s], B.area * inside.P.xx);
  add(sums.zz.part[s], B.area * inside.P.zz);
  add(sums.elastic.part[s], B.area * inside.response.stored);
  add(sums.plastic.part[s], B.area * inside.response.plastic_work);
  add(sums.viscous.part[s], B.area * inside.viscous);
  add(sums.kinetic.part[s], half_mass * larger(product(v, faster), least));
  sums.fastest.part[s] = select(sums.fastest.part[s] > square, sums.fastest.part[s], square);
}

// body(law, block) over the blocks, with the law's kind known when it is compiled.
template <class Body>
INLINE void over_blocks(const View& view, Blocks blocks, const Body& body) {
  for (int b = blocks.begin; b < blocks.end; ++b) {
    const TriangleLaw<Real>& law = view.laws[view.law_of_block[b]];
    if (law.plastic)
      body(law, b, std::true_type{});
    else
      body(law, b, std::false_type{});
  }
}

}  // namespace

AdvanceSums advance(const View& view, Blocks blocks, Real dt) {
  AdvanceParts sums;
  over_blocks(
      view, blocks, [&](const TriangleLaw<Real>& law, int b, auto plastic) __attribute__((always_inline)) {
#pragma GCC unroll 4
        for (int s = 0; s < parts; ++s) advance_part<decltype(plastic)::value>(view, law, b, s, dt, sums);
      });
  return {sums.viscous.total(), sums.plastic.total()};
}

TriangleSums measure(const View& view, Blocks blocks, Real dt) {
  MeasureParts sums;
  over_blocks(
      view, blocks, [&](const TriangleLaw<Real>& law, int b, auto plastic) __attribute__((always_inline)) {
#pragma GCC unroll 4
        for (int s = 0; s < parts; ++s) measure_part<decltype(plastic)::value>(view, law, b, s, dt, sums);
      });
  Real squares[lanes];
  for (int s = 0; s < parts; ++s) store(squares + s * width, sums.fastest.part[s]);
  double fastest = 0.0;
  for (const Real square : squares) fastest = fastest > double(square) ? fastest : double(square);
  return {sums.xx.total(),      sums.zz.total(), sums.elastic.total(), sums.plastic.total(), sums.viscous.total(),
          sums.kinetic.total(), fastest};
}

}  // namespace fracfarm::fdem::FRACFARM_KERNELS
