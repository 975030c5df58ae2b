#include "solver/phasefield/assembled/linear.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>

namespace fracfarm::phasefield::assembled {
namespace {

// About as many iterations as one factorisation costs, on grids of 100 to 400 cells a side.
constexpr int iterations_worth_a_factor = 24;
constexpr double rounding = 1e-14;  // of a residual over its right side

// Eigen's preconditioner interface around a factor that is kept elsewhere.
struct KeptFactor {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>* factor = nullptr;
  template <class Matrix>
  KeptFactor& compute(const Matrix&) {
    return *this;
  }
  template <class Matrix>
  KeptFactor& analyzePattern(const Matrix&) {
    return *this;
  }
  template <class Matrix>
  KeptFactor& factorize(const Matrix&) {
    return *this;
  }
  template <class Right>
  Eigen::VectorXd solve(const Right& b) const {
    return factor->solve(b);
  }
  Eigen::ComputationInfo info() const { return Eigen::Success; }
};

using KeptFactorSolver = Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower, KeptFactor>;

}  // namespace

SymmetricMatrix::SymmetricMatrix(std::span<const int> element_equations, int per_element, int equations)
    : matrix_(equations, equations), per_element_(per_element) {
  const std::size_t n = static_cast<std::size_t>(per_element), elements = element_equations.size() / n;
  const auto each_entry = [&](auto visit) {
    for (std::size_t e = 0; e < elements; ++e)
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) visit(element_equations[e * n + a], element_equations[e * n + b]);
  };
  std::vector<Eigen::Triplet<double>> entries;
  each_entry([&](int row, int column) {
    if (column >= 0 && row >= column) entries.emplace_back(row, column, 0.0);
  });
  for (int k = 0; k < equations; ++k) entries.emplace_back(k, k, 0.0);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  each_entry([&](int row, int column) {
    if (column < 0 || row < column) return places_.push_back(-1);
    const int *begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column],
              *end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + 1];
    places_.push_back(static_cast<int>(std::lower_bound(begin, end, row) - matrix_.innerIndexPtr()));
  });
}

void SymmetricMatrix::add(int element, std::span<const double> values) {
  const int* place = places_.data() + static_cast<std::ptrdiff_t>(element) * per_element_ * per_element_;
  for (const double value : values) {
    if (*place >= 0) matrix_.valuePtr()[*place] += value;
    ++place;
  }
}

bool FactoredSolver::factor(const Eigen::SparseMatrix<double>& lower) {
  if (!factor_) {
    factor_ = std::make_unique<Factor>();
    factor_->analyzePattern(lower);
  }
  factor_->factorize(lower);
  factored_.assign(lower.valuePtr(), lower.valuePtr() + lower.nonZeros());
  return factor_->info() == Eigen::Success && (lower.rows() == 0 || factor_->vectorD().minCoeff() > 0.0);
}

Result<Eigen::VectorXd> FactoredSolver::solve(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& b, double limit) {
  const double size = b.norm();
  if (size <= limit) return Eigen::VectorXd::Zero(b.size());
  const bool fresh = factored_.empty();
  if (fresh && !factor(lower)) return fail(Fault::solver_numeric, "the stiffness matrix is not positive definite");
  KeptFactorSolver solver(lower);
  solver.preconditioner().factor = factor_.get();
  solver.setTolerance(std::max(limit / size, rounding));
  solver.setMaxIterations(iterations_worth_a_factor);
  Eigen::VectorXd x = solver.solve(b);
  if (solver.info() == Eigen::Success || fresh) return x;
  if (!factor(lower)) return fail(Fault::solver_numeric, "the stiffness matrix is not positive definite");
  return Eigen::VectorXd(solver.solveWithGuess(b, x));
}

bool FactoredSolver::load(ArchiveReader& archive, const Eigen::SparseMatrix<double>& pattern) {
  std::vector<double> values;
  archive.get_array(values);
  if (archive.failed() || (!values.empty() && values.size() != static_cast<std::size_t>(pattern.nonZeros()))) return false;
  factored_.clear();
  if (values.empty()) return true;
  Eigen::SparseMatrix<double> matrix = pattern;
  std::copy(values.begin(), values.end(), matrix.valuePtr());
  return factor(matrix);
}

}  // namespace fracfarm::phasefield::assembled
