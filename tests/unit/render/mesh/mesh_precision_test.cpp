#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "load_text.h"
#include "support/meshes/shapes.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/repair_mesh.h"

namespace thimble::render {
namespace {

constexpr double kRadius = 0.03;  // m
const Eigen::Vector3d kSurvey(5e5, 4e6, 120.25);

TriangleMesh ball_in_survey() {
  TriangleMesh ball = support::icosphere(3, kRadius);
  for (Eigen::Vector3d& vertex : ball.vertices) vertex += kSurvey;
  return ball;
}

std::string as_obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x(), p.y(), p.z());
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return text;
}

std::string as_stl(const TriangleMesh& mesh) {
  std::string text = "solid ball\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t v : triangle) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(v)];
      text += fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", p.x(), p.y(), p.z());
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid ball\n";
}

// Returns the distance of a mesh's vertices from the ball, as a fraction of its size.
double distance_from_ball(const TriangleMesh& mesh) {
  double worst = 0;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    worst = std::max(worst, std::abs((vertex - kSurvey).norm() - kRadius));
  }
  return worst / (2 * kRadius);
}

class MeshPrecision : public testing::TestWithParam<const char*> {
 protected:
  static driver::Result<TriangleMesh> load() {
    const std::string name = GetParam();
    const TriangleMesh ball = ball_in_survey();
    return load_text("survey." + name, name == "obj" ? as_obj(ball) : as_stl(ball));
  }
};

// Doubles are 4.7e-10 apart at 4e6: 7.8e-9 of the ball. A file must be read as it was written.
TEST_P(MeshPrecision, KeepsABallInSurveyCoordinates) {
  const auto mesh = load();
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const TriangleMesh ball = ball_in_survey();
  EXPECT_EQ(mesh->vertices.size(), ball.vertices.size());
  double worst = 0;
  for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto of = [&](const TriangleMesh& from) {
        return from.vertices[static_cast<std::size_t>(from.triangles[t][k])];
      };
      worst = std::max(worst, (of(*mesh) - of(ball)).norm());
    }
  }
  EXPECT_LT(worst, 1e-9 * 2 * kRadius);
  EXPECT_TRUE(check_mesh(*mesh).touchable());
}

TEST_P(MeshPrecision, KeepsItThroughARepair) {
  const auto mesh = load();
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const RepairedMesh repaired = repair_mesh(*mesh);
  EXPECT_TRUE(repaired.changes.empty());
  EXPECT_LT(distance_from_ball(repaired.mesh), 1e-8);
}

TEST_P(MeshPrecision, KeepsNormalsWithinATenthOfADegree) {
  const auto mesh = load();
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const TriangleMesh ball = support::icosphere(3, kRadius);
  double worst = 1;
  for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
    const auto normal = [t](const TriangleMesh& from) {
      const auto corner = [&](std::size_t k) -> const Eigen::Vector3d& {
        return from.vertices[static_cast<std::size_t>(from.triangles[t][k])];
      };
      return (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized().eval();
    };
    worst = std::min(worst, normal(*mesh).dot(normal(ball)));
  }
  EXPECT_GT(worst, std::cos(0.1 * EIGEN_PI / 180));
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshPrecision, testing::Values("obj", "stl"),
                         [](const auto& param_info) { return std::string(param_info.param); });

}  // namespace
}  // namespace thimble::render
