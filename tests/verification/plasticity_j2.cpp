// PF-12 for J2: a square strained to and fro, without damage, against the hardening line from the equations alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/phasefield/assembled/assembled.hpp"
#include "tests/verification/bench.hpp"
#include "tests/verification/cases.hpp"

namespace fracfarm::verification {
namespace {

using phasefield::assembled::Assembled;
using phasefield::assembled::Prescription;

// One stress that grows with the slope `stiffness` of its strain until it meets the yield line, which rises by H for each unit of the
// equivalent plastic strain: q = stiffness e - 3 mu p, |q| <= sigma_y + H alpha.
class HardeningLine {
 public:
  HardeningLine(double stiffness, double mu, const Plasticity& metal) : stiffness_(stiffness), three_mu_(3.0 * mu), metal_(metal) {}
  double strained_to(double e) {
    const double elastic = stiffness_ * e - three_mu_ * p_, past = std::abs(elastic) - (metal_.yield + metal_.hardening * alpha_);
    const double grown = std::max(past, 0.0) / (three_mu_ + metal_.hardening);
    alpha_ += grown;
    p_ += std::copysign(grown, elastic);
    return stiffness_ * e - three_mu_ * p_;
  }

 private:
  double stiffness_, three_mu_;
  Plasticity metal_;
  double p_ = 0.0, alpha_ = 0.0;
};

constexpr int steps_of_leg = 8;
constexpr std::array<double, 4> turns{6.0, -10.0, 3.0, 20.0};  // in yields: out, past reverse yield, back inside, and far out

double strain_at(double step, double yield_strain) {
  double from = 0.0;
  for (std::size_t leg = 0; leg < turns.size(); ++leg, step -= steps_of_leg) {
    if (step <= steps_of_leg) return yield_strain * (from + (turns[leg] - from) * step / steps_of_leg);
    from = turns[leg];
  }
  return yield_strain * from;
}

struct Square {
  Assembled run;
  double h;

  // Two by two elements whose boundary follows the strain history; the node in the middle is free.
  Square(const Material& material, Quadrature quadrature, bool shear, double yield_strain)
      : run(scene_of(material, quadrature), boundary(shear, yield_strain)), h(dataset_h) {}

  static Scene scene_of(const Material& material, Quadrature quadrature) {
    Scene scene = plain_scene(material, 2, 2, dataset_h);
    scene.phase_field.plasticity = PlasticityModel::j2;
    scene.phase_field.integrator = Integrator::quasi_static;
    scene.phase_field.quadrature = quadrature;
    return scene;
  }
  static Prescription boundary(bool shear, double yield_strain) {
    Prescription prescription;
    for (int j = 0; j <= 2; ++j)
      for (int i = 0; i <= 2; ++i)
        for (const Axis axis : {Axis::x, Axis::z})
          if (i != 1 || j != 1) prescription.told.push_back({i, j, axis});
    const auto told = prescription.told;
    prescription.displacement = [told, shear, yield_strain](std::size_t k, double time) {
      const bool moves = (told[k].axis == Axis::x) == shear;
      return moves ? strain_at(time, yield_strain) * told[k].row * dataset_h : 0.0;
    };
    return prescription;
  }
  // Along the upper side, Pa.
  double stress(Axis axis) const {
    double force = 0.0;
    for (int i = 0; i <= 2; ++i) force += run.reaction(i, 2, axis);
    return force / (2.0 * h);
  }
};

struct Miss {
  double stress = 0.0, ledger = 0.0;
};

Miss strained(const Material& metal, Quadrature quadrature, bool shear) {
  const Elasticity& C = metal.elasticity;
  const double mu = C.C55, K = C.C13 + 2.0 / 3.0 * mu, stiffness = shear ? std::sqrt(3.0) * mu : 2.0 * mu;
  HardeningLine line(stiffness, mu, *metal.plasticity);
  const double yield_strain = metal.plasticity->yield / stiffness;
  Square square(metal, quadrature, shear, yield_strain);
  Miss worst;
  if (!square.run.start(1.0)) return {INFINITY, INFINITY};
  for (int n = 0; n < steps_of_leg * static_cast<int>(turns.size()); ++n) {
    if (!square.run.step(n, 1.0)) return {INFINITY, INFINITY};
    const double e = strain_at(n + 1, yield_strain), q = line.strained_to(e);
    const double target = shear ? q / std::sqrt(3.0) : K * e + 2.0 / 3.0 * q;
    worst.stress = std::max(worst.stress, std::abs(square.stress(shear ? Axis::x : Axis::z) - target) / metal.plasticity->yield);
  }
  const SampleRow row = square.run.sample(0, 1.0);
  worst.ledger = std::abs(row.energy_residual) / row.external_work;
  return worst;
}

}  // namespace

std::vector<Row> hardening_curve_j2() {
  std::vector<Row> rows;
  for (const char* name : {"tungsten", "aluminum", "steel"})
    for (const bool shear : {true, false}) {
      Material metal = tough(name);
      metal.Gc = 1e20;  // at 20 yields of uniaxial strain 1e15 leaves psi = 1e-8
      const Miss corner = strained(metal, Quadrature::gll, shear), gauss = strained(metal, Quadrature::gauss, shear);
      rows.push_back(
          compare(fmt::format("{}: {} to and fro, worst stress over the yield stress", name, shear ? "simple shear" : "uniaxial strain"),
                  "1", 0.0, std::max(corner.stress, gauss.stress), 1e-8));
      rows.push_back(compare(fmt::format("{}: {} to and fro, open share of the ledger with its plastic work", name,
                                         shear ? "simple shear" : "uniaxial strain"),
                             "1", 0.0, std::max(corner.ledger, gauss.ledger), 1e-8));
    }
  return rows;
}

}  // namespace fracfarm::verification
