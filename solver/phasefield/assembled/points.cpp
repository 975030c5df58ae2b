#include "solver/phasefield/assembled/points.hpp"

#include <algorithm>
#include <cmath>

#include "solver/law/degradation.hpp"

namespace fracfarm::phasefield::assembled {
namespace {

// Visits the elements of row j with their nodes and the place of their first point.
template <class Visit>
void along_row(const Model& model, int j, Visit visit) {
  for (int i = 0; i < model.grid.cells_x(); ++i) {
    const int element = j * model.grid.cells_x() + i;
    visit(element, model.nodes_of(i, j), static_cast<std::size_t>(4 * element));
  }
}

template <class Visit>
void each_row(const Model& model, Visit visit) {
  for (int j = 0; j < model.grid.cells_z(); ++j) visit(j, model.element_rows[static_cast<std::size_t>(j)]);
}

ElementVector gather(const Vector& u, const std::array<int, 4>& nodes) {
  ElementVector local;
  for (int k = 0; k < 4; ++k) local[2 * k] = u[2 * nodes[k]], local[2 * k + 1] = u[2 * nodes[k] + 1];
  return local;
}

Eigen::Vector4d gather_nodes(const Vector& psi, const std::array<int, 4>& nodes) {
  return {psi[nodes[0]], psi[nodes[1]], psi[nodes[2]], psi[nodes[3]]};
}

Strain strain_at(const Point& point, const ElementVector& u) {
  const Eigen::Vector3d e = point.strain * u;
  return {e[0], e[1], e[2]};
}

Stress stress_of(const Response& r, double g) {
  return {g * r.degraded.xx + r.kept.xx, g * r.degraded.zz + r.kept.zz, g * r.degraded.xz + r.kept.xz};
}

// Degraded stress of one answer on the elastic strain of another.
double power(const Response& stress, const ElasticStrain& e) {
  return stress.degraded.xx * e.xx + stress.degraded.zz * e.zz + stress.degraded_yy * e.yy + stress.degraded.xz * e.xz;
}

}  // namespace

void respond(const Model& model, const State& state, const Vector& u, Flow flow, Scratch& scratch) {
  each_row(model, [&](int j, const ElementRow& row) {
    std::visit(
        [&](const auto& law) {
          along_row(model, j, [&](int element, const std::array<int, 4>& nodes, std::size_t first) {
            if (model.is_cut_out(element)) return;  // its answers stay zero
            const ElementVector local = gather(u, nodes);
            for (std::size_t k = 0; k < 4; ++k) {
              const Strain e = strain_at(model.element.points[k], local);
              const Plastic old = law.yields ? state.plastic[first + k] : Plastic{};
              scratch.now[first + k] = law.answer(e, flow == Flow::on ? law.grow(e, old) : old);
            }
          });
        },
        row.law);
  });
}

void update_history(const Model&, const State& state, Scratch& scratch) {
  for (std::size_t p = 0; p < scratch.now.size(); ++p) scratch.history[p] = std::max(scratch.now[p].drive, state.history[p]);
}

void degrade(const Model& model, const State& state, Scratch& scratch) {
  each_row(model, [&](int j, const ElementRow&) {
    along_row(model, j, [&](int, const std::array<int, 4>& nodes, std::size_t first) {
      const Eigen::Vector4d psi = gather_nodes(state.psi, nodes);
      for (std::size_t k = 0; k < 4; ++k)
        scratch.g[first + k] = law::degradation(model.element.points[k].shape.dot(psi), model.settings.residual_stiffness);
    });
  });
}

void compute_force(const Model& model, double time, Scratch& scratch) {
  const double weight = model.element.weight;
  double square = 0.0;
  scratch.force.setZero();
  scratch.stress = {};
  each_row(model, [&](int j, const ElementRow&) {
    StressSum sum;
    along_row(model, j, [&](int, const std::array<int, 4>& nodes, std::size_t first) {
      ElementVector f = ElementVector::Zero();
      for (std::size_t k = 0; k < 4; ++k) {
        const Stress s = stress_of(scratch.now[first + k], scratch.g[first + k]);
        f.noalias() -= weight * (model.element.points[k].strain.transpose() * Eigen::Vector3d(s.xx, s.zz, s.xz));
        sum.xx += weight * s.xx, sum.zz += weight * s.zz;
      }
      for (int n = 0; n < 4; ++n) scratch.force[2 * nodes[n]] += f[2 * n], scratch.force[2 * nodes[n] + 1] += f[2 * n + 1];
      square += f.squaredNorm();
    });
    scratch.stress.xx += sum.xx, scratch.stress.zz += sum.zz;
  });
  scratch.force_scale = std::sqrt(square);
  for (const Traction& traction : model.boundary.tractions) {
    const double share = traction.share(time);
    for (std::size_t k = 0; k < traction.nodes.size(); ++k) {
      scratch.force[static_cast<Eigen::Index>(2 * traction.nodes[k])] += share * traction.fx[k];
      scratch.force[static_cast<Eigen::Index>(2 * traction.nodes[k] + 1)] += share * traction.fz[k];
    }
  }
}

void assemble_stiffness(const Model& model, const State& state, const Vector& u, double inertia, Scratch& scratch) {
  using Matrix8 = Eigen::Matrix<double, 8, 8, Eigen::RowMajor>;
  scratch.stiffness.clear();
  each_row(model, [&](int j, const ElementRow& row) {
    std::visit(
        [&](const auto& law) {
          along_row(model, j, [&](int element, const std::array<int, 4>& nodes, std::size_t first) {
            if (model.is_cut_out(element)) return;
            const ElementVector local = gather(u, nodes);
            Matrix8 K = Matrix8::Zero();
            for (std::size_t k = 0; k < 4; ++k) {
              const Point& point = model.element.points[k];
              const Tangent t =
                  law.tangent(strain_at(point, local), law.yields ? state.plastic[first + k] : Plastic{}, scratch.g[first + k]);
              Eigen::Matrix3d D;
              D << t.xx_xx, t.xx_zz, t.xx_xz, t.xx_zz, t.zz_zz, t.zz_xz, t.xx_xz, t.zz_xz, t.xz_xz;
              K.noalias() += model.element.weight * (point.strain.transpose() * (D * point.strain));
            }
            scratch.stiffness.add(element, {K.data(), 64});
          });
        },
        row.law);
  });
  if (inertia == 0.0) return;
  for (std::size_t d = 0; d < model.equation.size(); ++d)
    if (model.equation[d] >= 0) scratch.stiffness.add_diagonal(model.equation[d], inertia * model.mass[static_cast<Eigen::Index>(d)]);
}

// mass psi - slope lap psi = 2 (1 - psi) H - threshold, held nodes moved to the right side.
void assemble_damage(const Model& model, Scratch& scratch) {
  using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  scratch.damage.clear();
  scratch.damage_source.setZero();
  each_row(model, [&](int j, const ElementRow& row) {
    Matrix4 slopes = Matrix4::Zero();
    for (const Point& point : model.element.points)
      slopes += model.element.weight * row.surface.slope * (point.slope.transpose() * point.slope);
    along_row(model, j, [&](int element, const std::array<int, 4>& nodes, std::size_t first) {
      if (model.is_cut_out(element)) return;
      Matrix4 K = slopes;
      Eigen::Vector4d source = Eigen::Vector4d::Zero();
      for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector4d& N = model.element.points[k].shape;
        const double drive = 2.0 * scratch.history[first + k];
        K.noalias() += model.element.weight * (row.surface.mass + drive) * (N * N.transpose());
        source += model.element.weight * (drive - row.surface.threshold) * N;
      }
      scratch.damage.add(element, {K.data(), 16});
      for (int a = 0; a < 4; ++a) {
        const int equation = model.psi_equation[static_cast<std::size_t>(nodes[a])];
        if (equation < 0) continue;
        scratch.damage_source[equation] += source[a];
        for (int b = 0; b < 4; ++b)
          if (model.psi_equation[static_cast<std::size_t>(nodes[b])] < 0) scratch.damage_source[equation] -= K(a, b);
      }
    });
  });
}

// Released: (g_n - g_n+1) 1/2 sigma(eps_n) : eps_n+1 with both orders averaged is what the trapezoidal rule exchanges where the law is
// linear; a law whose energy is no quadratic form takes the geometric mean of its energies.
StepEnergies energies_of_step(const Model& model, const State& state, const Scratch& scratch) {
  StepEnergies sum;
  each_row(model, [&](int j, const ElementRow& row) {
    std::visit(
        [&](const auto& law) {
          along_row(model, j, [&](int, const std::array<int, 4>&, std::size_t first) {
            for (std::size_t p = first; p < first + 4; ++p) {
              const Response &now = scratch.now[p], &before = scratch.before[p];
              const double mean = law.quadratic ? 0.25 * (power(now, before.elastic) + power(before, now.elastic))
                                                : std::sqrt(std::max(now.degraded_energy * before.degraded_energy, 0.0));
              sum.released += (scratch.g_before[p] - scratch.g[p]) * mean;
              if (!law.yields) continue;
              const Plastic &grown = now.plastic, &old = state.plastic[p];
              const double xx = grown.xx - old.xx, zz = grown.zz - old.zz;
              const ElasticStrain step{xx, zz, -(xx + zz), grown.xz - old.xz};
              sum.plastic += 0.5 * (scratch.g_before[p] * power(before, step) + scratch.g[p] * power(now, step));
            }
          });
        },
        row.law);
  });
  return {model.element.weight * sum.released, model.element.weight * sum.plastic};
}

double elastic_energy(const Model& model, const Scratch& scratch) {
  double sum = 0.0;
  for (std::size_t p = 0; p < scratch.now.size(); ++p) sum += scratch.g[p] * scratch.now[p].degraded_energy + scratch.now[p].kept_energy;
  return model.element.weight * sum;
}

SurfaceSum surface(const Model& model, const Vector& psi) {
  SurfaceSum sum;
  const bool at1 = model.settings.surface == SurfaceModel::at1;
  each_row(model, [&](int j, const ElementRow& row) {
    double local = 0.0, slope = 0.0;
    along_row(model, j, [&](int, const std::array<int, 4>& nodes, std::size_t) {
      const Eigen::Vector4d psi_of = gather_nodes(psi, nodes);
      for (const Point& point : model.element.points) {
        const double value = point.shape.dot(psi_of);
        local += model.element.weight * (at1 ? value : value * value);
        slope += model.element.weight * (point.slope * psi_of).squaredNorm();
      }
    });
    const double factor = at1 ? 0.375 : 0.5;  // of G_c (psi or psi^2 / w_0 + w_0 |grad psi|^2)
    sum.energy += factor * row.Gc * (local / row.width + row.width * slope);
    sum.length += 2.0 * factor * row.width * slope;
  });
  return sum;
}

}  // namespace fracfarm::phasefield::assembled
