#include "solver/phasefield/assembled/linear.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>

namespace fracfarm::phasefield::assembled {
namespace {

constexpr int iterations_limit = 60;
constexpr double rounding = 1e-14;  // of a residual over its right side

// Eigen's preconditioner interface around a factor that is kept elsewhere. Its triangular solves are written out: the transposed one as
// four partial sums, because one sum waits for itself.
class KeptFactor {
 public:
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
  Eigen::ComputationInfo info() const { return Eigen::Success; }
  void keep(const FactoredSolver::Factor& factor) { factor_ = &factor; }

  template <class Right>
  Eigen::VectorXd solve(const Right& b) const {
    Eigen::VectorXd x = factor_->permutationP() * b;
    down(x);
    x.array() /= factor_->vectorD().array();
    up(x);
    return factor_->permutationPinv() * x;
  }

 private:
  void down(Eigen::VectorXd& x) const {
    const auto& L = factor_->matrixL().nestedExpression();
    const int *start = L.outerIndexPtr(), *row = L.innerIndexPtr();
    for (Eigen::Index j = 0; j < L.cols(); ++j) {
      const double value = x[j];
      for (int k = start[j]; k < start[j + 1]; ++k) x[row[k]] -= L.valuePtr()[k] * value;
    }
  }
  void up(Eigen::VectorXd& x) const {
    const auto& L = factor_->matrixL().nestedExpression();
    const int *start = L.outerIndexPtr(), *row = L.innerIndexPtr();
    const double* value = L.valuePtr();
    for (Eigen::Index j = L.cols() - 1; j >= 0; --j) {
      double part[4] = {};
      int k = start[j];
      for (; k + 4 <= start[j + 1]; k += 4)
        for (int l = 0; l < 4; ++l) part[l] += value[k + l] * x[row[k + l]];
      for (; k < start[j + 1]; ++k) part[0] += value[k] * x[row[k]];
      x[j] -= (part[0] + part[1]) + (part[2] + part[3]);
    }
  }

  const FactoredSolver::Factor* factor_ = nullptr;
};

using KeptFactorSolver = Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower, KeptFactor>;

// Multiplications of a factorisation over those of one iteration.
double price_of(const FactoredSolver::Factor& factor) {
  const auto& L = factor.matrixL().nestedExpression();
  double once = 0.0, twice = 0.0;
  for (Eigen::Index j = 0; j < L.cols(); ++j) {
    const double entries = L.outerIndexPtr()[j + 1] - L.outerIndexPtr()[j];
    once += entries, twice += entries * entries;
  }
  return once > 0.0 ? 0.25 * twice / once : 0.0;
}

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
  solves_ = iterations_ = 0;
  const bool positive = factor_->info() == Eigen::Success && (lower.rows() == 0 || factor_->vectorD().minCoeff() > 0.0);
  price_ = positive ? price_of(*factor_) : 0.0;
  return positive;
}

// A factor is worn when a solve takes more iterations than the mean solve did with the price of the factor shared among them: from there on
// the mean can only rise.
bool FactoredSolver::is_worn(long long iterations) const {
  return static_cast<double>(iterations * solves_) > price_ + static_cast<double>(iterations_);
}

Result<Eigen::VectorXd> FactoredSolver::solve(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& b, double limit) {
  const double size = b.norm();
  if (size <= limit) return Eigen::VectorXd::Zero(b.size());
  const auto not_positive = [] {
    return fail(Fault::solver_numeric,
                "the stiffness matrix is not positive definite: a part of the body is loose (a residual_stiffness above 0 holds it)");
  };
  const bool fresh = factored_.empty();
  if (fresh && !factor(lower)) return not_positive();
  KeptFactorSolver solver(lower);
  solver.preconditioner().keep(*factor_);
  solver.setTolerance(std::max(limit / size, rounding));
  solver.setMaxIterations(iterations_limit);
  Eigen::VectorXd x = solver.solve(b);
  ++solves_;
  iterations_ += solver.iterations();
  if (solver.info() != Eigen::Success && !fresh) {
    if (!factor(lower)) return not_positive();
    return Eigen::VectorXd(solver.solveWithGuess(b, x));
  }
  if (is_worn(solver.iterations())) factored_.clear();
  return x;
}

void FactoredSolver::save(ArchiveWriter& archive) const {
  archive.put_array(factored_);
  archive.put(solves_);
  archive.put(iterations_);
}

bool FactoredSolver::load(ArchiveReader& archive, const Eigen::SparseMatrix<double>& pattern) {
  std::vector<double> values;
  archive.get_array(values);
  const auto solves = archive.get<long long>(), iterations = archive.get<long long>();
  factored_.clear();
  if (archive.failed() || (!values.empty() && values.size() != static_cast<std::size_t>(pattern.nonZeros()))) return false;
  if (values.empty()) return true;
  Eigen::SparseMatrix<double> matrix = pattern;
  std::copy(values.begin(), values.end(), matrix.valuePtr());
  if (!factor(matrix)) return false;
  solves_ = solves, iterations_ = iterations;
  return true;
}

}  // namespace fracfarm::phasefield::assembled
