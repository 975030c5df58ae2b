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

// Forces of the three joints on the corners: every corner is the end of one edge and the start of the next.
INLINE Corners joint_forces(const Real* slots) {
  Raw e[12];  // edge k of the triangles j, j + 4, ... at 3 j + k: forces at the start, then at the end
  load_lines<3>(slots, e);
  using EndsOf = InGroups<2, 3, 4, 5>;
  const auto first_two = [&](int j) __attribute__((always_inline)) { return e[3 * j] + shuffle<EndsOf>(e[3 * j + 2], e[3 * j + 1]); };
  const auto third = [&](int j) __attribute__((always_inline)) {
    return shuffle<InGroups<2, 3, 6, 7>>(e[3 * j + 1], e[3 * j + 4]) + shuffle<InGroups<0, 1, 4, 5>>(e[3 * j + 2], e[3 * j + 5]);
  };
  const Four4 t = transposed({first_two(0), first_two(1), first_two(2), first_two(3)});
  const Raw low = third(0), high = third(2);
  return {t.a, t.b, t.c, t.d, shuffle<InGroups<0, 2, 4, 6>>(low, high), shuffle<InGroups<1, 3, 5, 7>>(low, high)};
}

INLINE Corners extra_forces(const Real* rows) {
  Raw x[8];
  load_lines<2>(rows, x);
  const Four4 first = transposed({x[0], x[2], x[4], x[6]}), rest = transposed({x[1], x[3], x[5], x[7]});
  return {first.a, first.b, first.c, first.d, rest.a, rest.b};
}

INLINE void store_rows_of(Real* rows, const Corners& u) {
  const Four4 first = transposed({u.x0.raw, u.z0.raw, u.x1.raw, u.z1.raw}), rest = transposed({u.x2.raw, u.z2.raw, u.x0.raw, u.z0.raw});
  Raw x[8] = {first.a, rest.a, first.b, rest.b, first.c, rest.c, first.d, rest.d};
  store_lines<2>(rows, x);
}

INLINE Plastic load_plastic(const Real* at) { return {load(at), load(at + lanes), load(at + 2 * lanes), load(at + 3 * lanes)}; }
INLINE void store_plastic(Real* at, const Plastic& p) {
  store(at, p.xx), store(at + lanes, p.zz), store(at + 2 * lanes, p.xz), store(at + 3 * lanes, p.alpha);
}

INLINE law::Stiffness<Lanes> stiffness(const law::Stiffness<Real>& C) { return {C.C11, C.C13, C.C33, C.C55}; }
INLINE J2 wide(const law::J2<Real>& j2) { return {j2.bulk, j2.mu, j2.yield, j2.hardening}; }

// What the strain of one register of triangles gives beside stress, J/m^3. (GCC 12 copies larger structures of registers to memory and
// back.)
struct Work {
  Lanes plastic;  // of this step
  Lanes stored;
};

INLINE Stress elastic_stress(const TriangleLaw<Real>& law, const Strain& strain, Work& work) {
  const auto C = stiffness(law.stiffness);
  const Stress stress = law::stress(C, strain);
  work = {Lanes(Real(0)), Lanes(Real(0.5)) * (stress.xx * strain.xx + stress.zz * strain.zz + stress.xz * strain.xz)};
  return stress;
}

// From the plastic state that lies at `before`; where any of it flows, all of it goes to `after`, which may be the same place.
INLINE Stress plastic_stress(const TriangleLaw<Real>& law, const Strain& strain, const Real* before, Real* after, bool always, Work& work) {
  const J2 j2 = wide(law.j2);
  work.plastic = Lanes(Real(0));
  if (always || any(law::yields(j2, strain, load_plastic(before)))) {
    const Plastic old = load_plastic(before), now = law::flow(j2, strain, old);
    work.plastic = law::plastic_work(j2, now) - law::plastic_work(j2, old);
    store_plastic(after, now);
    before = after;
  }
  const auto answer = law::response(j2, strain, load_plastic(before));
  work.stored = answer.stored;
  return answer.stress;
}

template <bool plastic>
INLINE Stress stress_of(const View& view, const TriangleLaw<Real>& law, const Strain& strain, const Real* before, Real* after, Work& work) {
  if constexpr (plastic)
    return plastic_stress(law, strain, before, after, view.always_flow, work);
  else
    return elastic_stress(law, strain, work);
}

// How a register of triangles is turned and strained.
struct Form {
  law::Turn<Lanes> turn;
  Strain strain;
};

INLINE Form form_of(const Shape& B, const Corners& u) {
  const Gradient H = gradient(u, B);
  const auto R = law::turn(H);
  return {R, law::biot(H, R)};
}

struct Internal {
  Gradient P;
  Lanes viscous;  // W/m^3
};

INLINE Internal internal(const TriangleLaw<Real>& law, const Shape& B, const Form& form, const Stress& stress, const Corners& v) {
  const Strain rate = law::rate(gradient(v, B), form.turn);
  const Lanes xi = law.viscosity;
  const Stress drag{xi * rate.xx, xi * rate.zz, Lanes(Real(0.5)) * xi * rate.xz};
  const Stress all{stress.xx + drag.xx, stress.zz + drag.zz, stress.xz + drag.xz};
  return {law::piola(all, form.strain, form.turn), drag.xx * rate.xx + drag.zz * rate.zz + drag.xz * rate.xz};
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

INLINE Corners outer_forces(const View& view, const Place& at, unsigned char needs, const Corners& joints) {
  return needs & needs_extra ? joints + extra_forces(view.extra + at.rows) : joints;
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

// The velocities half a step on.
INLINE Corners kicked(const View& view, const TriangleLaw<Real>& law, int b, int s, const Gradient& P, const Corners& joints,
                      const Corners& v, Real dt) {
  const Place at(b, s);
  const Shape B = load_shape(view.shape + at.shape);
  const unsigned char needs = view.needs[b];
  const Corners kick = kick_of(law, B, P, outer_forces(view, at, needs, joints), dt);
  Corners faster = v + kick;
  if (needs & needs_told) obey(view, b, s, B, kick, dt, faster);
  return faster;
}

INLINE void add(Lanes& sum, Lanes value) { sum = sum + value; }

INLINE Lanes area_of(const View& view, const Place& at) { return load(view.shape + at.shape + 4 * lanes); }

INLINE Internal internal_of(const View& view, const TriangleLaw<Real>& law, const Place& at, const Form& form, const Stress& stress) {
  return internal(law, load_shape(view.shape + at.shape), form, stress, load_corners(view.v + at.corners));
}

struct Advance {
  Real dt;
  LaneSums viscous, plastic;

  template <bool yields>
  INLINE Gradient stress(const View& view, const TriangleLaw<Real>& law, int b, int s, const Form& form) {
    const Place at(b, s);
    Real* plastic_state = view.plastic + at.plastic;
    Work work;
    const Internal inside = internal_of(view, law, at, form, stress_of<yields>(view, law, form.strain, plastic_state, plastic_state, work));
    add(viscous.part[s], area_of(view, at) * inside.viscous);
    if constexpr (yields) add(plastic.part[s], area_of(view, at) * work.plastic);
    return inside.P;
  }
  INLINE void move(const View& view, const TriangleLaw<Real>& law, int b, int s, const Gradient& P) {
    const Place at(b, s);
    const Corners faster = kicked(view, law, b, s, P, joint_forces(view.slots + at.slots), load_corners(view.v + at.corners), dt);
    const Corners moved = load_corners(view.u + at.corners) + Lanes(dt) * faster;
    store_corners(view.v + at.corners, faster);
    store_corners(view.u + at.corners, moved);
    store_rows_of(view.rows + at.rows, moved);
  }
};

INLINE Lanes product(const Corners& a, const Corners& b) {
  return ((a.x0 * b.x0 + a.z0 * b.z0) + (a.x1 * b.x1 + a.z1 * b.z1)) + (a.x2 * b.x2 + a.z2 * b.z2);
}

struct Measure {
  Real dt;
  LaneSums xx, zz, elastic, joints, plastic, viscous, kinetic, fastest;

  template <bool yields>
  INLINE Gradient stress(const View& view, const TriangleLaw<Real>& law, int b, int s, const Form& form) {
    const Place at(b, s);
    alignas(register_bytes) Real plastic_state[4 * lanes];
    Work work;
    const Internal inside =
        internal_of(view, law, at, form, stress_of<yields>(view, law, form.strain, view.plastic + at.plastic, plastic_state, work));
    const Lanes area = area_of(view, at);
    add(xx.part[s], area * inside.P.xx);
    add(zz.part[s], area * inside.P.zz);
    add(elastic.part[s], area * work.stored);
    add(plastic.part[s], area * work.plastic);
    add(viscous.part[s], area * inside.viscous);
    return inside.P;
  }
  INLINE void move(const View& view, const TriangleLaw<Real>& law, int b, int s, const Gradient& P) {
    const Place at(b, s);
    const Corners from_joints = joint_forces(view.slots + at.slots);
    add(joints.part[s], product(from_joints, load_corners(view.u + at.corners)));
    const Corners v = load_corners(view.v + at.corners), faster = kicked(view, law, b, s, P, from_joints, v, dt);
    const Lanes half_mass = area_of(view, at) * Lanes(Real(0.5) / law.per_mass), least(view.least_kinetic);
    const Lanes square = product(v, v);
    add(kinetic.part[s], half_mass * larger(product(v, faster), least));
    fastest.part[s] = select(fastest.part[s] > square, fastest.part[s], square);
  }
};

constexpr int form_size = 6, stress_size = 4;

INLINE void store_form(Real* at, const Form& f) {
  store(at, f.turn.c1), store(at + width, f.turn.s), store(at + 2 * width, f.turn.per_trace);
  store(at + 3 * width, f.strain.xx), store(at + 4 * width, f.strain.zz), store(at + 5 * width, f.strain.xz);
}
INLINE Form load_form(const Real* at) {
  const Lanes c1 = load(at);
  return {{c1, Lanes(Real(1)) + c1, load(at + width), load(at + 2 * width)},
          {load(at + 3 * width), load(at + 4 * width), load(at + 5 * width)}};
}
INLINE void store_gradient(Real* at, const Gradient& g) {
  store(at, g.xx), store(at + width, g.xz), store(at + 2 * width, g.zx), store(at + 3 * width, g.zz);
}
INLINE Gradient load_gradient(const Real* at) { return {load(at), load(at + width), load(at + 2 * width), load(at + 3 * width)}; }

// step(law, block, part, number) for every register of the blocks.
template <class Step>
INLINE void for_each(const View& view, Blocks blocks, const Step& step) {
  int i = 0;
  for (int b = blocks.begin; b < blocks.end; ++b)
    for (int s = 0; s < parts; ++s) step(view.laws[view.law_of_block[b]], b, s, i++);
}

// A few blocks go through three short loops, so that the long way through a root, a division and the laws is gone by many at once, and each
// loop has the registers that it needs: how triangles are turned and strained, their stress, and their motion.
constexpr int batch_blocks = 8;

template <class Job>
INLINE void over_batch(const View& view, Blocks blocks, Job& job) {
  alignas(register_bytes) Real forms[batch_blocks * form_size * lanes], stress[batch_blocks * stress_size * lanes];
  for_each(
      view, blocks, [&](const TriangleLaw<Real>&, int b, int s, int i) __attribute__((always_inline)) {
        const Place at(b, s);
        store_form(forms + i * form_size * width, form_of(load_shape(view.shape + at.shape), load_corners(view.u + at.corners)));
      });
  for_each(
      view, blocks, [&](const TriangleLaw<Real>& law, int b, int s, int i) __attribute__((always_inline)) {
        const Form form = load_form(forms + i * form_size * width);
        Real* P = stress + i * stress_size * width;
        if (law.plastic)
          store_gradient(P, job.template stress<true>(view, law, b, s, form));
        else
          store_gradient(P, job.template stress<false>(view, law, b, s, form));
      });
  for_each(
      view, blocks, [&](const TriangleLaw<Real>& law, int b, int s, int i) __attribute__((always_inline)) {
        job.move(view, law, b, s, load_gradient(stress + i * stress_size * width));
      });
}

template <class Job>
INLINE void over_blocks(const View& view, Blocks blocks, Job& job) {
  for (int b = blocks.begin; b < blocks.end; b += batch_blocks)
    over_batch(view, {b, b + batch_blocks < blocks.end ? b + batch_blocks : blocks.end}, job);
}

}  // namespace

AdvanceSums advance(const View& view, Blocks blocks, Real dt) {
  Advance job{dt, {}, {}};
  over_blocks(view, blocks, job);
  return {job.viscous.total(), job.plastic.total()};
}

TriangleSums measure(const View& view, Blocks blocks, Real dt) {
  Measure job{dt, {}, {}, {}, {}, {}, {}, {}, {}};
  over_blocks(view, blocks, job);
  Real squares[lanes];
  for (int s = 0; s < parts; ++s) store(squares + s * width, job.fastest.part[s]);
  double fastest = 0.0;
  for (const Real square : squares) fastest = fastest > double(square) ? fastest : double(square);
  return {.stress_xx = job.xx.total(),
          .stress_zz = job.zz.total(),
          .elastic = job.elastic.total(),
          .joints = -0.5 * job.joints.total(),
          .plastic = job.plastic.total(),
          .viscous = job.viscous.total(),
          .kinetic = job.kinetic.total(),
          .fastest = fastest};
}

}  // namespace fracfarm::fdem::FRACFARM_KERNELS
