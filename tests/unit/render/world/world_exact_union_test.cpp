// Scenes of several solids against one mesh of their exact union.

#include <gtest/gtest.h>

#include "support/long_form.h"
#include "support/meshes/exact_union.h"
#include "support/meshes/random_solids.h"
#include "support/random.h"
#include "support/union_walk.h"

#ifdef THIMBLE_CGAL

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/closest_point.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/scene_touch.h"
#include "track/god_object.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::ExactUnion;
using support::Random;

constexpr double kStiffness = 800;
constexpr double kSize = 0.04;  // m, of a scene
constexpr double kTolerance = 1e-9 * kSize;

SceneTouch scene_of(const std::vector<TriangleMesh>& solids) {
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  for (const TriangleMesh& solid : solids) {
    objects.push_back(build_object_touch(solid, {.tracker = TrackerChoice::kGodObject},
                                         {.spring = {.stiffness = kStiffness}})
                          .value());
  }
  return SceneTouch(std::move(objects));
}

/// The god-object over the mesh of the union.
class UnionReference {
 public:
  explicit UnionReference(GodObjectContact contact) : contact_(std::move(contact)) {}

  Vector3d follow(const Vector3d& p) {
    const ContactState& found = contact_.update(support::tip_at(p));
    return found.touching ? found.p_WP : p;
  }
  bool touching() const { return contact_.state().touching; }
  bool inside(const Vector3d& q) const { return contact_.search().inside(q); }

  /// Whether q - p is a combination without negative parts of the normals of up to three faces at
  /// q.
  bool is_minimum(const Vector3d& p, const Vector3d& q) const {
    const Vector3d d = q - p;
    if (d.norm() < kTolerance) return true;
    const ContactMesh& mesh = contact_.mesh();
    std::vector<Vector3d> normals;
    for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
      if (!(std::abs(mesh.depth(t, q)) < kTolerance)) continue;
      const Vector3d c =
          closest_point(q, mesh.position(t, 0), mesh.position(t, 1), mesh.position(t, 2));
      if (!((q - c).norm() < kTolerance)) continue;
      const Vector3d& n = mesh.cell(t).face.n;
      const auto same = [&](const Vector3d& other) { return (other - n).norm() < 1e-12; };
      if (std::none_of(normals.begin(), normals.end(), same)) normals.push_back(n);
    }
    const auto fits = [&](std::initializer_list<std::size_t> chosen) {
      Eigen::MatrixXd N(3, static_cast<Eigen::Index>(chosen.size()));
      Eigen::Index column = 0;
      for (const std::size_t i : chosen) N.col(column++) = normals[i];
      const Eigen::VectorXd lambda = N.colPivHouseholderQr().solve(d);
      return lambda.minCoeff() >= -kTolerance && (N * lambda - d).norm() < kTolerance;
    };
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if (fits({i})) return true;
      for (std::size_t k = i + 1; k < normals.size(); ++k) {
        if (fits({i, k})) return true;
        for (std::size_t m = k + 1; m < normals.size(); ++m) {
          if (fits({i, k, m})) return true;
        }
      }
    }
    return false;
  }

 private:
  GodObjectContact contact_;
};

/// A scene, and its union as a mesh that can be touched.
struct Case {
  std::vector<TriangleMesh> solids;
  bool exact_in_doubles = false;
  std::size_t triangles = 0;  ///< Of the union.
  std::optional<UnionReference> reference;
};

/// What was drawn again.
struct Redrawn {
  int solids = 0;  ///< Solids that shared only an edge or a vertex with the others.
  int scenes = 0;  ///< Scenes whose rounded triangles intersect, or have no area.
};

/// Draws 2 to 20 solids.
Case draw_case(Random& random, bool on_lattice, Redrawn& redrawn) {
  for (;;) {
    Case drawn;
    ExactUnion whole;
    const auto count = static_cast<std::size_t>(random.uniform(2, 21));
    while (drawn.solids.size() < count) {
      TriangleMesh solid = support::next_solid(random, drawn.solids, on_lattice);
      if (whole.add(solid)) {
        drawn.solids.push_back(std::move(solid));
      } else {
        ++redrawn.solids;
      }
    }
    drawn.exact_in_doubles = whole.exact_in_doubles();
    const TriangleMesh mesh = whole.mesh();
    drawn.triangles = mesh.triangles.size();
    auto contact = GodObjectContact::build(mesh);
    if (!contact || (!drawn.exact_in_doubles && whole.intersects_itself())) {
      ++redrawn.scenes;
      continue;
    }
    drawn.reference.emplace(std::move(contact).value());
    return drawn;
  }
}

/// Walks through scenes of one kind.
void expect_alike(bool on_lattice, int scenes, int ticks, double proxy_bound, double force_bound) {
  Random random(scenes + (on_lattice ? 1 : 0));
  support::UnionComparison all;
  Redrawn redrawn;
  int exact = 0;
  std::size_t solids = 0, triangles = 0;
  for (int i = 0; i < scenes; ++i) {
    Case drawn = draw_case(random, on_lattice, redrawn);
    exact += drawn.exact_in_doubles ? 1 : 0;
    solids += drawn.solids.size();
    triangles += drawn.triangles;
    SceneTouch scene = scene_of(drawn.solids);
    const support::UnionComparison one =
        support::compare_with_union(scene, kStiffness, *drawn.reference, random, ticks);
    all.add(one);
    if (one.proxy_off > proxy_bound || one.force_off > force_bound || one.inside > 0 ||
        one.no_minimum > 0) {
      std::printf(
          "scene %d of %zu solids: proxy off by %.1e m, force by %.1e N, %d ticks inside, "
          "%d at no minimum\n",
          i, drawn.solids.size(), one.proxy_off, one.force_off, one.inside, one.no_minimum);
    }
  }
  std::printf(
      "%d scenes of %zu solids, unions of %zu triangles, %d exact in doubles; drawn again: %d "
      "solids, %d scenes\n"
      "%d ticks, %d with several solids; proxy within %.1e m, force within %.1e N; at another "
      "minimum in %d ticks of %d scenes; %d unsettled\n",
      scenes, solids, triangles, exact, redrawn.solids, redrawn.scenes, scenes * ticks, all.several,
      all.proxy_off, all.force_off, all.parted, all.scenes_parted, all.unsettled);
  if (on_lattice) {
    EXPECT_EQ(exact, scenes);
  }
  EXPECT_GT(all.several, scenes * 50);
  EXPECT_EQ(all.inside, 0);
  EXPECT_EQ(all.no_minimum, 0);
  EXPECT_LT(all.proxy_off, proxy_bound);
  EXPECT_LT(all.force_off, force_bound);
  EXPECT_LE(all.parted, scenes / 100 * ticks);
  EXPECT_LE(all.unsettled, scenes * ticks / 100'000);
}

int scenes_of_a_kind() {
  return support::long_form() ? 5000 : 150;
}
int ticks_of_a_scene() {
  return support::long_form() ? 5000 : 1000;
}

TEST(WorldExactUnion, SolidsOnALatticeAreFeltAsTheMeshOfTheirUnion) {
  expect_alike(true, scenes_of_a_kind(), ticks_of_a_scene(), kTolerance, 1e-6);
}

TEST(WorldExactUnion, SolidsOfAnyPoseAreFeltAsTheMeshOfTheirUnion) {
  expect_alike(false, scenes_of_a_kind(), ticks_of_a_scene(), kTolerance, 1e-6);
}

}  // namespace
}  // namespace thimble::render

#else

TEST(WorldExactUnion, SolidsOnALatticeAreFeltAsTheMeshOfTheirUnion) {
  GTEST_SKIP() << "install libcgal-dev, which computes exact unions of meshes";
}

#endif
