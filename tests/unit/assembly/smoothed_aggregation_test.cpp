#include "lacon/assembly/petsc/smoothed_aggregation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "lacon/assembly/petsc/near_null_space.hpp"

namespace lacon {
namespace {

class PetscEnvironment : public testing::Environment {
 public:
  void SetUp() override { checked(PetscInitializeNoArguments()); }
  void TearDown() override { PetscFinalize(); }
};
const testing::Environment* const environment = testing::AddGlobalTestEnvironment(new PetscEnvironment);

/// A truss on a bent lattice: bars from each node to all around it. Its rigid motions take no forces, and no others do.
template <int dim>
struct Truss {
  std::vector<std::array<double, 3>> nodes;
  OwnNodes own;
  Eigen::MatrixXd stiffness;

  explicit Truss(bool is_held, int n = dim == 3 ? 6 : 12) {
    std::vector<std::array<int, 3>> place;
    for (int k = 0; k < (dim == 3 ? n : 1); ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          place.push_back({i, j, k});
          const double x = i / (n - 1.0), y = j / (n - 1.0), z = k / (n - 1.0);
          nodes.push_back({x + 0.1 * y * y, 0.9 * y + 0.2 * z * z, 1.1 * z + 0.05 * x * y});
        }
    const auto n_nodes = static_cast<int>(nodes.size());
    stiffness = Eigen::MatrixXd::Zero(n_nodes * dim, n_nodes * dim);
    for (int a = 0; a < n_nodes; ++a) {
      for (int r = 0; r < dim; ++r) {
        own.coordinates.push_back(nodes[a][r]);
        own.is_free.push_back(!(is_held && place[a][dim - 1] == 0));
        own.middle[r] += nodes[a][r] / n_nodes;
      }
      for (int b = 0; b < a; ++b) {
        if (std::abs(place[a][0] - place[b][0]) > 1 || std::abs(place[a][1] - place[b][1]) > 1 ||
            std::abs(place[a][2] - place[b][2]) > 1)
          continue;
        Eigen::Matrix<double, dim, 1> along;
        for (int r = 0; r < dim; ++r) along[r] = nodes[b][r] - nodes[a][r];
        along.normalize();
        const Eigen::Matrix<double, dim, dim> bar = (1 + 0.1 * ((a + b) % 3)) * along * along.transpose();
        stiffness.template block<dim, dim>(a * dim, a * dim) += bar;
        stiffness.template block<dim, dim>(b * dim, b * dim) += bar;
        stiffness.template block<dim, dim>(a * dim, b * dim) -= bar;
        stiffness.template block<dim, dim>(b * dim, a * dim) -= bar;
      }
    }
    for (std::size_t i = 0; i < own.is_free.size(); ++i)
      if (!own.is_free[i]) {
        const auto at = static_cast<Eigen::Index>(i);
        stiffness.row(at).setZero(), stiffness.col(at).setZero();
        stiffness(at, at) = 1;
      }
  }

  SplitBlocks<double> blocks(bool is_half) const {
    SplitBlocks<double> made;
    made.own.rows = made.own.columns = dim;
    made.own.is_half = is_half;
    const auto n_nodes = static_cast<int>(nodes.size());
    for (int a = 0; a < n_nodes; ++a) {
      for (int b = is_half ? a : 0; b < n_nodes; ++b) {
        const Eigen::Matrix<double, dim, dim> block = stiffness.template block<dim, dim>(a * dim, b * dim);
        if (block.isZero(0) && a != b) continue;
        made.own.column.push_back(b);
        for (int c = 0; c < dim; ++c)
          for (int r = 0; r < dim; ++r) made.own.value.push_back(is_half ? block(c, r) : block(r, c));
      }
      made.own.offset.push_back(static_cast<std::int32_t>(made.own.column.size()));
    }
    made.own.value.resize(made.own.value.size() + read_behind, 0);
    return made;
  }

  struct Coarse {
    Eigen::MatrixXd interpolation, matrix, motions, fine_motions;
  };
  Coarse coarse(bool is_half) const {
    constexpr int n_motions = dim == 3 ? 6 : 3;
    OwnedMat shape;  // vectors of displacements
    const auto n_rows = static_cast<PetscInt>(stiffness.rows());
    checked(MatCreateSeqAIJ(PETSC_COMM_WORLD, n_rows, n_rows, 1, nullptr, shape.out()));
    checked(MatSetUp(shape));
    const std::vector<OwnedVec> motions = rigid_motions(shape, dim, own);
    const SplitBlocks<double> rows = blocks(is_half);
    const std::vector<std::uint8_t> is_link(rows.own.column.size(), 1);
    Eigen::VectorXd inverse = stiffness.diagonal().cwiseInverse();
    const double largest = (inverse.asDiagonal() * stiffness).eigenvalues().real().maxCoeff();
    const CoarseLevel level = coarse_level(PETSC_COMM_WORLD, rows, is_link, own.is_free, own.coordinates, motions, largest);
    PetscInt n_coarse = 0;
    checked(MatGetSize(level.matrix, &n_coarse, nullptr));
    Coarse made{Eigen::MatrixXd::Zero(n_rows, n_coarse), Eigen::MatrixXd::Zero(n_coarse, n_coarse),
                Eigen::MatrixXd::Zero(n_coarse, std::ssize(motions)), Eigen::MatrixXd::Zero(n_rows, std::ssize(motions))};
    const BlockEntries<float>& p = level.interpolation.own;
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::int32_t k = p.offset[a]; k < p.offset[a + 1]; ++k)
        for (int c = 0; c < n_motions; ++c)
          for (int r = 0; r < dim; ++r)
            made.interpolation(a * dim + r, p.column[k] * n_motions + c) = p.value[(k * n_motions + c) * dim + r];
    for (PetscInt i = 0; i < n_coarse; ++i)
      for (PetscInt j = 0; j < n_coarse; ++j) checked(MatGetValues(level.matrix, 1, &i, 1, &j, &made.matrix(i, j)));
    MatNullSpace space = nullptr;
    const Vec* vectors = nullptr;
    PetscInt n_vectors = 0;
    checked(MatGetNearNullSpace(level.matrix, &space));
    checked(MatNullSpaceGetVecs(space, nullptr, &n_vectors, &vectors));
    EXPECT_EQ(n_vectors, std::ssize(motions));
    for (PetscInt v = 0; v < n_vectors; ++v) {
      for (PetscInt i = 0; i < n_coarse; ++i) checked(VecGetValues(vectors[v], 1, &i, &made.motions(i, v)));
      for (PetscInt i = 0; i < n_rows; ++i) checked(VecGetValues(motions[v], 1, &i, &made.fine_motions(i, v)));
    }
    return made;
  }
};

constexpr double single_precision = 1e-6;  // of interpolations

template <int dim>
void expect_rigid_motions() {
  const Truss<dim> truss(false);
  for (const bool is_half : {false, true}) {
    const auto coarse = truss.coarse(is_half);
    ASSERT_LT(coarse.interpolation.cols(), coarse.interpolation.rows() / 2);
    const Eigen::MatrixXd turned = coarse.interpolation * coarse.motions;
    EXPECT_LE((turned - coarse.fine_motions).cwiseAbs().maxCoeff(), single_precision);
    EXPECT_LE((coarse.matrix * coarse.motions).cwiseAbs().maxCoeff(), 10 * single_precision);
  }
}

// A body that nothing holds moves rigidly with its aggregates, and no forces act on these.
TEST(SmoothedAggregation, KeepsRigidMotions) {
  expect_rigid_motions<2>();
  expect_rigid_motions<3>();
}

template <int dim>
void expect_galerkin() {
  const Truss<dim> truss(true);
  const auto whole = truss.coarse(false), half = truss.coarse(true);
  EXPECT_LE((whole.interpolation - half.interpolation).cwiseAbs().maxCoeff(), single_precision);
  for (const auto& coarse : {whole, half}) {
    Eigen::MatrixXd expected = coarse.interpolation.transpose() * truss.stiffness * coarse.interpolation;
    EXPECT_EQ((expected.diagonal().array() == 0).count(), 0);
    EXPECT_LE((coarse.matrix - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
    for (Eigen::Index i = 0; i < coarse.interpolation.rows(); ++i)
      EXPECT_EQ(coarse.interpolation.row(i).isZero(0), !truss.own.is_free[i]);
  }
}

TEST(SmoothedAggregation, ItsMatrixIsThatOfWhatItInterpolates) {
  expect_galerkin<2>();
  expect_galerkin<3>();
}

/// What a sweep over two levels leaves of an error at most, and what Jacobi's iteration alone leaves of it. (Both are
/// self-adjoint in energy.)
std::pair<double, double> left_of_errors(int n) {
  const Truss<2> truss(true, n);
  const auto coarse = truss.coarse(true);
  const Eigen::MatrixXd& k = truss.stiffness;
  const Eigen::MatrixXd& p = coarse.interpolation;
  const Eigen::LDLT<Eigen::MatrixXd> coarse_factor(coarse.matrix);
  const auto largest_of = [&](const auto& sweep) {
    Eigen::VectorXd error = Eigen::VectorXd::Random(k.rows());
    for (int i = 0; i < 2000; ++i) error = sweep(error).normalized();
    return sweep(error).norm();
  };
  const Eigen::VectorXd inverse = k.diagonal().cwiseInverse();
  const double step =
      4.0 / 3 / largest_of([&](const Eigen::VectorXd& e) -> Eigen::VectorXd { return inverse.cwiseProduct(k * e); });
  const auto smoothed = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd { return e - step * inverse.cwiseProduct(k * e); };
  const auto corrected = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    return e - p * coarse_factor.solve(p.transpose() * (k * e));
  };
  return {largest_of([&](const Eigen::VectorXd& e) -> Eigen::VectorXd { return smoothed(corrected(smoothed(e))); }),
          largest_of([&](const Eigen::VectorXd& e) -> Eigen::VectorXd { return smoothed(smoothed(e)); })};
}

// On a finer mesh Jacobi's iteration takes as much longer as its square has more cells; two levels take as long as before, or
// little longer where meshes are as coarse as these.
TEST(SmoothedAggregation, WhatTwoLevelsLeaveDoesNotDependOnTheMesh) {
  const auto [coarse_levels, coarse_jacobi] = left_of_errors(8);
  const auto [fine_levels, fine_jacobi] = left_of_errors(14);
  const double slower = (1 - fine_jacobi) / (1 - coarse_jacobi);
  EXPECT_LT(slower, 0.35);
  EXPECT_GT((1 - fine_levels) / (1 - coarse_levels), std::sqrt(slower));
}

// An aggregate of one node has no turns; their equations are there all the same, and regular.
TEST(SmoothedAggregation, MotionsThatAnAggregateDoesNotHaveAreHeld) {
  OwnNodes own{.coordinates = {0, 0, 0, 5, 0, 0}, .is_free = {1, 1, 1, 1, 1, 1}};
  SplitBlocks<double> rows;
  rows.own.rows = rows.own.columns = 3;
  for (int node = 0; node < 2; ++node) {
    rows.own.column.push_back(node);
    for (int i = 0; i < 9; ++i) rows.own.value.push_back(i % 4 == 0 ? 2 : 0);
    rows.own.offset.push_back(node + 1);
  }
  rows.own.value.resize(rows.own.value.size() + read_behind, 0);
  OwnedMat shape;
  checked(MatCreateSeqAIJ(PETSC_COMM_WORLD, 6, 6, 1, nullptr, shape.out()));
  checked(MatSetUp(shape));
  const std::vector<OwnedVec> motions = rigid_motions(shape, 3, own);
  const CoarseLevel level =
      coarse_level(PETSC_COMM_WORLD, rows, std::vector<std::uint8_t>(2, 1), own.is_free, own.coordinates, motions, 1.0);
  PetscInt n = 0;
  checked(MatGetSize(level.matrix, &n, nullptr));
  ASSERT_EQ(n, 12);
  for (PetscInt i = 0; i < n; ++i) {
    double d = 0;
    checked(MatGetValues(level.matrix, 1, &i, 1, &i, &d));
    EXPECT_GT(d, 0) << i;
  }
}

}  // namespace
}  // namespace lacon
