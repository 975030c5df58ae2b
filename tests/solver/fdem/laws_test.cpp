#include <catch2/catch.hpp>

#include <cmath>

#include "solver/law/compensated.hpp"
#include "solver/law/corotated.hpp"
#include "solver/law/joint.hpp"
#include "solver/law/plane_return.hpp"

using namespace fracfarm::law;

namespace {

struct Strengths {
  double penalty, ft, fs, GI, GII;
};
constexpr Strengths shale{7e14, 1e7, 4e7, 100.0, 400.0};

template <class Curve>
Joint<double> joint(const Strengths& s) {
  const double area = area_under<Curve>();
  return {s.penalty, s.penalty / s.ft, s.penalty / s.fs, 1.0 / rupture_opening(s.penalty, s.ft, s.GI, area),
          1.0 / rupture_opening(s.penalty, s.fs, s.GII, area)};
}

// Work of opening along a ray until the joint is broken, J/m^2: the spring's in closed form, the softening part by Simpson's rule.
template <class Curve>
double work_to_break(const Joint<double>& law, double n, double t) {
  const double onset = 1.0 / std::hypot(n * law.per_onset_n, t * law.per_onset_t);
  const double rupture = 1.0 / std::hypot(n * law.per_rupture_n, t * law.per_rupture_t);
  const int parts = 20000;
  double sum = 0.0;
  for (int i = 0; i <= parts; ++i) {
    const double d = onset + (rupture - onset) * i / parts;
    const auto answer = fracfarm::law::answer<Curve>(law, Opening<double>{d * n, d * t}, 0.0);
    sum += (i == 0 || i == parts ? 1.0 : i % 2 ? 4.0 : 2.0) * (answer.normal * n + answer.shear * t);
  }
  return 0.5 * law.penalty * onset * onset * (n * n + t * t) + sum * (rupture - onset) / (3.0 * parts);
}

template <class Curve>
void check_toughness() {
  const Joint<double> law = joint<Curve>(shale);
  CHECK(work_to_break<Curve>(law, 1.0, 0.0) == Approx(shale.GI).epsilon(1e-8));
  CHECK(work_to_break<Curve>(law, 0.0, 1.0) == Approx(shale.GII).epsilon(1e-8));
  CHECK(work_to_break<Curve>(law, 0.0, -1.0) == Approx(shale.GII).epsilon(1e-8));
  const double mixed = work_to_break<Curve>(law, std::sqrt(0.5), std::sqrt(0.5));
  CHECK((mixed > shale.GI && mixed < shale.GII));
}

}  // namespace

TEST_CASE("breaking a joint takes G_I across it and G_II along it, with either curve") {
  check_toughness<Munjiza>();
  check_toughness<LinearSoftening>();
}

TEST_CASE("Munjiza's curve falls from 1 to 0 over an area of 0.38631, and its exponential is one") {
  CHECK(Munjiza::kept(0.0) == Approx(1.0).epsilon(1e-14));
  CHECK(Munjiza::kept(1.0) == 0.0);
  CHECK(area_under<Munjiza>() == Approx(0.38631).epsilon(1e-5));
  for (double x = -4.0; x <= 0.0; x += 0.01) CHECK(exp_of_negative(x) == Approx(std::exp(x)).epsilon(4e-12));
}

TEST_CASE("openings of mixed mode break on the ellipse through both ruptures, and keep no traction there") {
  const auto law = joint<Munjiza>(shale);
  for (double angle = 0.0; angle <= 1.57; angle += 0.1) {
    const double n = std::cos(angle) / law.per_rupture_n, t = std::sin(angle) / law.per_rupture_t;
    CHECK(answer<Munjiza>(law, Opening<double>{0.999 * n, 0.999 * t}, 0.0).damage < 1.0);
    const auto broken = answer<Munjiza>(law, Opening<double>{1.000001 * n, 1.000001 * t}, 0.0);
    CHECK(broken.damage == 1.0);
    CHECK(broken.normal == 0.0);
    CHECK(broken.shear == 0.0);
  }
}

TEST_CASE("a joint unloads along the line to its origin, loads again on it, and presses back undamaged") {
  const auto law = joint<Munjiza>(shale);
  const double far = 0.4 / law.per_rupture_n;
  const auto loaded = answer<Munjiza>(law, Opening<double>{far, 0.0}, 0.0);
  CHECK((loaded.damage > 0.3 && loaded.damage < 0.5));
  for (const double share : {0.75, 0.5, 0.1}) {
    const auto unloaded = answer<Munjiza>(law, Opening<double>{share * far, 0.0}, loaded.damage);
    CHECK(unloaded.damage == loaded.damage);
    CHECK(unloaded.normal == Approx(share * loaded.normal).epsilon(1e-12));
  }
  CHECK(answer<Munjiza>(law, Opening<double>{-1e-9, 0.0}, loaded.damage).normal == Approx(-shale.penalty * 1e-9));
  CHECK(answer<Munjiza>(law, Opening<double>{-1e-3, 0.0}, 0.0).damage == 0.0);
}

TEST_CASE("below its strength a joint is a spring without damage") {
  const auto law = joint<Munjiza>(shale);
  const auto answer = fracfarm::law::answer<Munjiza>(law, Opening<double>{0.6 / law.per_onset_n, 0.7 / law.per_onset_t}, 0.0);
  CHECK(answer.damage == 0.0);
  CHECK(answer.normal == Approx(0.6 * shale.ft).epsilon(1e-14));
  CHECK(answer.shear == Approx(0.7 * shale.fs).epsilon(1e-14));
}

TEST_CASE("the Biot strain of a turned stretch is the stretch, however small it is and however far it turned") {
  for (const double angle : {0.0, 1e-9, 0.3, 1.5, 2.8, -3.0})
    for (const double size : {1e-3, 1e-12}) {
      const double xx = 0.7 * size, zz = -0.2 * size, xz = 0.4 * size, c = std::cos(angle), s = std::sin(angle);
      const double sine_half = std::sin(0.5 * angle), c1 = -2.0 * sine_half * sine_half;
      const Gradient<double> H{c1 + c * xx - s * xz, -s + c * xz - s * zz, s + s * xx + c * xz, c1 + s * xz + c * zz};
      const auto E = biot(H, turn(H));
      CHECK(E.xx == Approx(xx).margin(4e-16));
      CHECK(E.zz == Approx(zz).margin(4e-16));
      CHECK(E.xz == Approx(2.0 * xz).margin(4e-16));
    }
}

TEST_CASE("the stress of an orthotropic triangle is the slope of its energy, and has no moment") {
  const Stiffness<double> C{3.125738e10, 3.399087e9, 2.248732e10, 6.486048e9};
  const auto energy = [&](const Gradient<double>& H) { return strain_energy(C, biot(H, turn(H))); };
  const Gradient<double> H{0.02, -0.31, 0.28, -0.05};
  const auto R = turn(H);
  const auto E = biot(H, R);
  const auto P = piola(stress(C, E), E, R);
  const double d = 1e-6;
  const auto slope = [&](double Gradient<double>::*part) {
    Gradient<double> more = H, less = H;
    more.*part += d, less.*part -= d;
    return (energy(more) - energy(less)) / (2.0 * d);
  };
  CHECK(P.xx == Approx(slope(&Gradient<double>::xx)).epsilon(1e-7));
  CHECK(P.xz == Approx(slope(&Gradient<double>::xz)).epsilon(1e-7));
  CHECK(P.zx == Approx(slope(&Gradient<double>::zx)).epsilon(1e-7));
  CHECK(P.zz == Approx(slope(&Gradient<double>::zz)).epsilon(1e-7));
  const double moment = P.xx * H.zx + P.xz * (1.0 + H.zz) - (P.zx * (1.0 + H.xx) + P.zz * H.xz);
  CHECK(std::abs(moment) < 1e-9 * std::abs(P.xx));
}

TEST_CASE("compensated triangles and the joints between them are as soft together as the material") {
  const Stiffness<double> C{3.125738e10, 3.399087e9, 2.248732e10, 6.486048e9};
  const double s = 3e-12;
  const auto stiffer = compensated(C, s);
  const Strain<double> e{1e-4, -3e-5, 2e-5};
  const auto sigma = stress(stiffer, e);
  const auto whole = stress(C, Strain<double>{e.xx + s * sigma.xx, e.zz + s * sigma.zz, e.xz + 2.0 * s * sigma.xz});
  CHECK(whole.xx == Approx(sigma.xx).epsilon(1e-12));
  CHECK(whole.zz == Approx(sigma.zz).epsilon(1e-12));
  CHECK(whole.xz == Approx(sigma.xz).epsilon(1e-12));
}

TEST_CASE("viscosity by the damping ratio dissipates in compensated triangles what it did in softer ones under the same stress") {
  const Stiffness<double> C{3.125738e10, 3.399087e9, 2.248732e10, 6.486048e9};
  const auto stiffer = compensated(C, 6e-12);
  CHECK(damping_ratio(C, C) == Approx(1.0).epsilon(1e-14));
  CHECK(damping_ratio(C, {2.0 * C.C11, 2.0 * C.C13, 2.0 * C.C33, 2.0 * C.C55}) == Approx(4.0).epsilon(1e-14));
  double softer = 0.0, less_strained = 0.0;  // sums of |e|^2, tensors, over strains of the stiffer ones that are spread evenly
  const int around = 40, up = 400;
  for (int i = 0; i < up; ++i)
    for (int j = 0; j < around; ++j) {
      const double height = (2.0 * i + 1.0) / up - 1.0, angle = 2.0 * M_PI * j / around, side = std::sqrt(1.0 - height * height);
      const Strain<double> e{side * std::cos(angle), side * std::sin(angle), std::sqrt(2.0) * height};
      const auto sigma = stress(stiffer, e);
      const double determinant = C.C11 * C.C33 - C.C13 * C.C13;
      const double xx = (C.C33 * sigma.xx - C.C13 * sigma.zz) / determinant, zz = (C.C11 * sigma.zz - C.C13 * sigma.xx) / determinant;
      const double gamma = sigma.xz / C.C55;
      softer += xx * xx + zz * zz + 0.5 * gamma * gamma, less_strained += e.xx * e.xx + e.zz * e.zz + 0.5 * e.xz * e.xz;
    }
  CHECK(damping_ratio(C, stiffer) == Approx(softer / less_strained).epsilon(1e-4));
  CHECK(damping_ratio(C, stiffer) > 1.2);
}

TEST_CASE("the radial return without branches is the one with them") {
  const J2<double> law{3e11, 1.56e11, 7.5e8, 5e9};
  Plastic<double> one{}, other{};
  for (int i = 0; i < 50; ++i) {
    const Strain<double> e{2e-3 * std::sin(0.3 * i), 4e-3 * std::sin(0.2 * i), 3e-3 * std::cos(0.37 * i)};
    one = radial_return(law, e, one);
    CHECK(yields(law, e, other) == (radial_return(law, e, other).alpha > other.alpha));
    other = flow(law, e, other);
    CHECK(other.xx == Approx(one.xx).margin(1e-15));
    CHECK(other.xz == Approx(one.xz).margin(1e-15));
    CHECK(other.alpha == Approx(one.alpha).margin(1e-15));
    const auto answer = response(law, e, other);
    CHECK(std::isfinite(answer.stored));
  }
  CHECK(one.alpha > 1e-2);
}
