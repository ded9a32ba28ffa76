#include "body/spring/spring_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "body/spring/mesh_springs.h"
#include "support/dense_algebra.h"
#include "support/meshes/body_meshes.h"
#include "support/meshes/shapes.h"
#include "support/seed.h"
#include "thimble/render/body/spring_scheme.h"

namespace thimble::render {
namespace {

template <int kDof>
Eigen::MatrixXd dense(const SpringNetwork<kDof>& network, const NetworkWeights& weights) {
  const std::int32_t n = network.node_count();
  Eigen::MatrixXd matrix(n * kDof, n * kDof);
  std::vector<typename SpringNetwork<kDof>::Vector> unit(static_cast<std::size_t>(n));
  for (auto& x : unit) x.setZero();
  for (std::int32_t i = 0; i < n; ++i) {
    for (int k = 0; k < kDof; ++k) {
      unit[static_cast<std::size_t>(i)][k] = 1;
      for (std::int32_t j = 0; j < n; ++j) {
        matrix.template block<kDof, 1>(j * kDof, i * kDof + k) =
            network.row(weights, j, unit) / std::sqrt(network.mass(i) * network.mass(j));
      }
      unit[static_cast<std::size_t>(i)][k] = 0;
    }
  }
  return matrix;
}

template <int kDof>
void expect_bounds_of_the_dense_matrix(const SpringNetwork<kDof>& network) {
  const Eigen::MatrixXd k = dense(network, network.stiffness());
  EXPECT_LE((k - k.transpose()).norm(), 1e-12 * k.norm());
  const Eigen::VectorXd squares = support::symmetric_eigenvalues(k);
  EXPECT_GE(squares[0], -1e-9 * squares[squares.size() - 1]);
  const double truth = std::sqrt(squares[squares.size() - 1]);
  EXPECT_TRUE(network.bounds().converged);
  EXPECT_NEAR(network.bounds().omega_max, truth, 1e-6 * truth);
  EXPECT_GE(network.bounds().omega_max, truth * (1 - 1e-12));
  EXPECT_GE(network.bounds().omega_gershgorin, truth);
  const Eigen::MatrixXd c = dense(network, network.damping());
  const Eigen::VectorXd rates = support::symmetric_eigenvalues(c);
  const double fastest = rates[rates.size() - 1];
  EXPECT_NEAR(network.bounds().damping_rate_max, fastest, 1e-6 * fastest + 1e-9);
}

TEST(SpringNetwork, FindsTheHighestFrequency) {
  const MeshSpringSettings settings{1e-3, 50, 0.1, 1000, 0.2, true};
  expect_bounds_of_the_dense_matrix(join_vertices(support::icosphere(1, 0.03), settings).value());
  expect_bounds_of_the_dense_matrix(support::join_heights(support::icosphere(2, 0.03), settings));
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    expect_bounds_of_the_dense_matrix(
        support::wild_network<3>(40, 1e5, true, support::seed_of(seed)));
    expect_bounds_of_the_dense_matrix(
        support::wild_network<1>(60, 1e5, false, support::seed_of(seed)));
  }
}

TEST(SpringNetwork, KnowsTheLimitsOfTriangleGrids) {
  // [PHYSICS 4]: 5.92 (directed), 8.91 (heights), 12 (Gershgorin), in k/m. An infinite sheet would
  // have 6 and 9.
  const MeshSpringSettings settings{1e-3, 0, 0, 1000, 0, true};
  const TriangleMesh sheet = support::triangle_sheet(24, 5e-3);
  const double unit = settings.neighbour_stiffness / settings.mass;
  const NetworkBounds directed = join_vertices(sheet, settings)->bounds();
  const NetworkBounds heights = support::join_heights(sheet, settings).bounds();
  EXPECT_NEAR(directed.omega_max * directed.omega_max / unit, 5.92, 0.08);
  EXPECT_NEAR(heights.omega_max * heights.omega_max / unit, 8.91, 0.08);
  EXPECT_NEAR(heights.omega_gershgorin * heights.omega_gershgorin / unit, 12, 1e-9);
  // Maximum steps at k = 1 N/mm and 1 g per vertex: below the 1 ms of a tick.
  EXPECT_NEAR(largest_step(SpringScheme::kVerlet, directed), 0.82e-3, 0.01e-3);
  EXPECT_NEAR(largest_step(SpringScheme::kVerlet, heights), 0.67e-3, 0.01e-3);
}

TEST(SpringNetwork, HoldsAnUnusedVertex) {
  TriangleMesh mesh = support::icosphere(0, 0.03);
  mesh.vertices.emplace_back(1, 1, 1);
  const auto network = join_vertices(mesh, {1e-3, 100, 0, 1000, 0, true});
  ASSERT_TRUE(network);
  EXPECT_TRUE(network->neighbours(12).empty());
}

TEST(SpringNetwork, RefusesInvalidBodies) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const auto build = [](BodyNode node, BodySpring<3> spring) {
    const std::vector<BodyNode> nodes{{1e-3, 10, 0}, node};
    return SpringNetwork<3>::build(nodes, std::vector{spring});
  };
  EXPECT_TRUE(build({1e-3, 10, 0}, {0, 1, 100, 0}));
  EXPECT_TRUE(build({1e-9, 1e12, 1e9}, {0, 1, 1e12, 1e9}));
  for (const double bad : {0.0, -1.0, nan, inf}) {
    const auto answer = build({bad, 10, 0}, {0, 1, 100, 0});
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().message, "Node 1 of the body needs a mass above 0 kg.");
  }
  for (const double bad : {-1.0, nan, inf}) {
    EXPECT_FALSE(build({1e-3, bad, 0}, {0, 1, 100, 0}));
    EXPECT_FALSE(build({1e-3, 10, bad}, {0, 1, 100, 0}));
    EXPECT_FALSE(build({1e-3, 10, 0}, {0, 1, bad, 0}));
    EXPECT_FALSE(build({1e-3, 10, 0}, {0, 1, 100, bad}));
  }
  EXPECT_FALSE(build({1e-3, 10, 0}, {0, 2, 100, 0}));
  EXPECT_FALSE(build({1e-3, 10, 0}, {-1, 1, 100, 0}));
  EXPECT_FALSE(build({1e-3, 10, 0}, {1, 1, 100, 0}));
  EXPECT_FALSE(build({1e-3, 10, 0}, {0, 1, 100, 0, {2, 0, 0}}));
  EXPECT_FALSE(build({1e-3, 10, 0}, {0, 1, 100, 0, {nan, 0, 0}}));
  EXPECT_FALSE(SpringNetwork<3>::build({}, {}));
}

}  // namespace
}  // namespace thimble::render
