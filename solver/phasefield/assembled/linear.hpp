// Sparse symmetric systems: element matrices added into a fixed pattern, and a solver that keeps its last factorisation as long as that is
// worth more than a new one.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <span>
#include <vector>

#include "common/base/result.hpp"
#include "solver/archive.hpp"

namespace fracfarm::phasefield::assembled {

// The lower triangle, with the place of every entry of every element's matrix in its values.
class SymmetricMatrix {
 public:
  SymmetricMatrix() = default;
  // Equations of each element, `per_element` of them at a time; -1: none.
  SymmetricMatrix(std::span<const int> element_equations, int per_element, int equations);

  void clear() { std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0); }
  // Adds the (symmetric) matrix of one element, row by row.
  void add(int element, std::span<const double> values);
  void add_diagonal(int equation, double value) { matrix_.valuePtr()[matrix_.outerIndexPtr()[equation]] += value; }
  const Eigen::SparseMatrix<double>& lower() const { return matrix_; }

 private:
  Eigen::SparseMatrix<double> matrix_;
  std::vector<int> places_;  // of entry (a, b) of an element, or -1
  int per_element_ = 0;
};

// Conjugate gradients with the factor of an earlier matrix; a new factor as soon as the old one costs more than it saves.
class FactoredSolver {
 public:
  // To |b - A x| <= limit. Errors: SOLVER_NUMERIC where A is not positive definite.
  Result<Eigen::VectorXd> solve(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& b, double limit);

  // What a restart needs to give the same bits: the values of the matrix that was factored, and how often the factor served.
  void save(ArchiveWriter& archive) const;
  bool load(ArchiveReader& archive, const Eigen::SparseMatrix<double>& pattern);

  using Factor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>;

 private:
  bool factor(const Eigen::SparseMatrix<double>& lower);
  bool is_worn(long long iterations) const;

  std::unique_ptr<Factor> factor_;
  std::vector<double> factored_;           // empty: no factor
  double price_ = 0.0;                     // of the factorisation, in iterations
  long long solves_ = 0, iterations_ = 0;  // with this factor
};

}  // namespace fracfarm::phasefield::assembled
