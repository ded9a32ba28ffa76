#include "track/edge_blending.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "support/contact_walk.h"
#include "support/heap_guard.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/meshes/smooth_surfaces.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"
#include "track/blended.h"
#include "track/mesh_contact.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

struct Shaded {
  explicit Shaded(const TriangleMesh& shape)
      : mesh(ContactMesh::build(shape).value()), normals(mesh) {}
  ContactMesh mesh;
  SmoothNormals normals;
};

// Queries every shading, at widths from much less than a triangle to more than one.
template <class Ask>
void for_each_shading(double edge_length, Ask ask) {
  for (const BlendProfile profile : {BlendProfile::kLinear, BlendProfile::kSmooth}) {
    for (const double share : {0.02, 0.1, 0.3, 1.0, 3.0}) {
      ask(FixedBand{share * edge_length, profile});
    }
    for (const double share : {0.1, 0.5, 1.0}) ask(SizedBand{share, profile});
  }
  ask(Phong{});
}

Vector3d weights_of(std::size_t corner, double at_corner, double at_next) {
  Vector3d weights;
  weights[static_cast<Eigen::Index>(corner)] = at_corner;
  weights[static_cast<Eigen::Index>((corner + 1) % 3)] = at_next;
  weights[static_cast<Eigen::Index>((corner + 2) % 3)] = 1 - at_corner - at_next;
  return weights;
}

TEST(EdgeBlending, NormalIsContinuousOverSmoothEdges) {
  support::Random random(1);
  for (const TriangleMesh& shape : {support::icosphere(2, 0.05), support::torus(0.05, 0.02, 24, 10),
                                    support::bumpy_sphere(3, 0.05, 0.3, 6)}) {
    const Shaded on(shape);
    for_each_shading(0.01, [&](const auto& shading) {
      for (std::int32_t t = 0; t < on.mesh.triangle_count(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          if (on.normals.crease(t, k)) continue;
          const std::int32_t other = on.mesh.cell(t).neighbours[k];
          std::size_t j = 0;
          while (on.mesh.corners(other)[(j + 1) % 3] != on.mesh.corners(t)[k]) ++j;
          const double along = random.uniform(0, 1);
          const Vector3d here =
              shading.normal(on.mesh, on.normals, t, weights_of(k, 1 - along, along));
          const Vector3d there =
              shading.normal(on.mesh, on.normals, other, weights_of(j, along, 1 - along));
          ASSERT_LT((here - there).norm(), 1e-13) << shading.kName;
          ASSERT_NEAR(here.norm(), 1, 1e-14);
        }
      }
    });
  }
}

TEST(EdgeBlending, EveryTriangleReachesTheVertexNormal) {
  support::Random random(2);
  const Shaded on(support::bumpy_sphere(3, 0.05, 0.3, 6));
  for_each_shading(0.01, [&](const auto& shading) {
    for (std::int32_t t = 0; t < on.mesh.triangle_count(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d& wanted = on.normals.corners(t)[k];
        const double other = random.uniform(0, 1);
        double before = 1;
        for (const double away : {1e-3, 1e-5, 1e-7, 0.0}) {
          const Vector3d n =
              shading.normal(on.mesh, on.normals, t, weights_of(k, 1 - away, away * other));
          // No faster than linear in the distance; the narrowest band is 1/50 of an edge wide.
          ASSERT_LT((n - wanted).norm(), 500 * away + 1e-14) << shading.kName;
          ASSERT_LE((n - wanted).norm(), before + 1e-14);
          before = (n - wanted).norm();
        }
      }
    }
  });
}

TEST(EdgeBlending, ChangeInATriangleIsBoundedByItsBand) {
  support::Random random(3);
  const Shaded on(support::icosphere(2, 0.05));
  // Faces meet here at 0.3 rad at most: over a band the normal turns by half of that, near a vertex
  // in two directions at once.
  for (const double width : {0.0005, 0.002, 0.01}) {
    const FixedBand shading{width};
    for (int i = 0; i < 20000; ++i) {
      const auto t = static_cast<std::int32_t>(random.bits() % 320);
      const Vector3d start = weights_of(static_cast<std::size_t>(i % 3), random.uniform(0, 1), 0);
      Vector3d mixed = start + Vector3d{random.uniform(0, 1), random.uniform(0, 1), 0.1};
      mixed /= mixed.sum();
      const Vector3d turn = 1e-6 * (start / start.sum() - mixed);
      const Vector3d from = shading.normal(on.mesh, on.normals, t, mixed);
      const Vector3d to = shading.normal(on.mesh, on.normals, t, mixed + turn);
      const double path = (turn[0] * on.mesh.position(t, 0) + turn[1] * on.mesh.position(t, 1) +
                           turn[2] * on.mesh.position(t, 2))
                              .norm();
      ASSERT_LE((to - from).norm(), 4 * 0.15 * path / width + 1e-14);
    }
  }
}

// A change of weights, with sum 0.
Vector3d change_of(std::size_t corner, double at_corner, double at_next) {
  Vector3d change = weights_of(corner, at_corner, at_next);
  change[static_cast<Eigen::Index>((corner + 2) % 3)] -= 1;
  return change;
}

// Returns how far the normal turns per metre just before a place minus just after it, rad/m: a
// second difference over the length of one step. `turn` is a change of weights.
template <class Shading>
double rate_jump(const Shaded& on, const Shading& shading, std::int32_t t, const Vector3d& weights,
                 const Vector3d& turn) {
  const auto at = [&](const Vector3d& w) { return shading.normal(on.mesh, on.normals, t, w); };
  const double step = (turn[0] * on.mesh.position(t, 0) + turn[1] * on.mesh.position(t, 1) +
                       turn[2] * on.mesh.position(t, 2))
                          .norm();
  return (at(weights + turn) - 2 * at(weights) + at(weights - turn)).norm() / step;
}

TEST(EdgeBlending, SmoothProfileTurnsContinuouslyInside) {
  support::Random random(5);
  const Shaded on(support::icosphere(2, 0.05));
  double linear = 0, smooth = 0;
  // Places where a rate may jump: at the end of a band next to each edge, half-way along an edge,
  // and anywhere. Triangles are 7 to 8 mm wide.
  for (std::int32_t t = 0; t < on.mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d edge = on.mesh.position(t, (k + 1) % 3) - on.mesh.position(t, k);
      const Vector3d side = on.mesh.position(t, (k + 2) % 3) - on.mesh.position(t, k);
      const double end = 0.001 / (edge.cross(side).norm() / edge.norm());
      const double along = random.uniform(0.3, 0.7);
      const Vector3d out = change_of(k, -5e-6, -5e-6);
      const auto ask = [&](const auto& shading, const Vector3d& weights, const Vector3d& turn) {
        double& worst = shading.profile == BlendProfile::kSmooth ? smooth : linear;
        worst = std::max(worst, rate_jump(on, shading, t, weights, turn));
      };
      const double rest = 1 - end;
      const double first = random.uniform(0.1, 0.4);
      const Vector3d anywhere = weights_of(k, first, random.uniform(0.1, 0.4));
      for (const BlendProfile profile : {BlendProfile::kLinear, BlendProfile::kSmooth}) {
        ask(FixedBand{0.001, profile}, weights_of(k, rest * along, rest * (1 - along)), out);
        ask(SizedBand{1, profile}, weights_of(k, 0.5, 0.5), change_of(k, 1e-5, -1e-5));
        ask(SizedBand{1, profile}, anywhere, out);
      }
    }
  }
  // Steps of about 0.1 um: a continuous rate changes by its slope, at most 1 rad / mm^2 here.
  EXPECT_LT(smooth, 1e6 * 2e-7);
  EXPECT_GT(linear, 50);  // 0.1 rad within a band of 1 mm, or none
}

TEST(EdgeBlending, SmoothProfileTurnsContinuouslyOverEdges) {
  support::Random random(6);
  // Triangles of different sizes on both sides of an edge.
  const Shaded on(support::torus(0.05, 0.02, 24, 10));
  double linear = 0, smooth = 0;
  for (std::int32_t t = 0; t < on.mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double along = random.uniform(0.05, 0.95);
      const Vector3d edge = on.mesh.position(t, (k + 1) % 3) - on.mesh.position(t, k);
      const Vector3d side = on.mesh.position(t, (k + 2) % 3) - on.mesh.position(t, k);
      const double height = edge.cross(side).norm() / edge.norm();
      const double closest = side.dot(edge) / edge.squaredNorm();
      const double up = 1e-7 / height;
      // Perpendicular to the edge, by 0.1 um.
      const Vector3d away = weights_of(k, 1 - along - up * (1 - closest), along - up * closest);
      for (const BlendProfile profile : {BlendProfile::kLinear, BlendProfile::kSmooth}) {
        for (const double width : {0.0005, 0.002, 0.02}) {
          const FixedBand shading{width, profile};
          const double rate =
              (shading.normal(on.mesh, on.normals, t, away) -
               shading.normal(on.mesh, on.normals, t, weights_of(k, 1 - along, along)))
                  .norm() /
              1e-7;
          double& worst = profile == BlendProfile::kSmooth ? smooth : linear;
          worst = std::max(worst, rate);
        }
      }
    }
  }
  // Its rate is zero on every edge, so it is the same from both sides.
  EXPECT_LT(smooth, 1);
  EXPECT_GT(linear, 100);
}

TEST(EdgeBlending, ProfilesAgreeOnEdgesVerticesAndMiddle) {
  const Shaded on(support::icosphere(1, 0.05));
  const FixedBand linear{0.003}, smooth{0.003, BlendProfile::kSmooth};
  double apart = 0;
  for (std::int32_t t = 0; t < on.mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Vector3d& weights :
           {weights_of(k, 0.5, 0.5), weights_of(k, 1, 0), Vector3d(Vector3d::Constant(1.0 / 3))}) {
        EXPECT_EQ(linear.normal(on.mesh, on.normals, t, weights),
                  smooth.normal(on.mesh, on.normals, t, weights));
      }
      const Vector3d between = weights_of(k, 0.485, 0.485);
      apart = std::max(apart, (linear.normal(on.mesh, on.normals, t, between) -
                               smooth.normal(on.mesh, on.normals, t, between))
                                  .norm());
    }
  }
  EXPECT_GT(apart, 0.005);
}

TEST(EdgeBlending, FollowsTheFourPointRuleOfThePaper) {
  const Shaded on(support::icosphere(1, 0.05));
  for (std::int32_t t = 0; t < on.mesh.triangle_count(); ++t) {
    const FixedBand shading{0.003};  // edges are 27 to 31 mm long
    const auto at = [&](const Vector3d& weights) {
      return shading.normal(on.mesh, on.normals, t, weights);
    };
    const Vector3d& own = on.mesh.cell(t).face.n;
    EXPECT_LT((at(Vector3d::Constant(1.0 / 3)) - own).norm(), 1e-15);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& next = on.mesh.cell(on.mesh.cell(t).neighbours[k]).face.n;
      for (const double along : {0.2, 0.5, 0.8}) {
        EXPECT_LT((at(weights_of(k, 1 - along, along)) - (own + next).normalized()).norm(), 1e-14);
      }
      const Vector3d& vertex = on.normals.corners(t)[k];
      EXPECT_EQ(at(weights_of(k, 1, 0)), vertex);
      // Along an edge, half the band from its end: half-way between ip2 and ip4.
      const double length = (on.mesh.position(t, (k + 1) % 3) - on.mesh.position(t, k)).norm();
      const Vector3d near_end = at(weights_of(k, 1 - 0.0015 / length, 0.0015 / length));
      EXPECT_LT((near_end - ((own + next).normalized() + vertex).normalized()).norm(), 1e-4);
      // Half the band from an edge: half-way between ip1 and ip2.
      const Vector3d edge = on.mesh.position(t, (k + 1) % 3) - on.mesh.position(t, k);
      const Vector3d side = on.mesh.position(t, (k + 2) % 3) - on.mesh.position(t, k);
      const double height = edge.cross(side).norm() / edge.norm();
      const double up = 0.0015 / height;
      const Vector3d half = at(weights_of(k, (1 - up) / 2, (1 - up) / 2));
      EXPECT_LT((half - (own + (own + next).normalized()).normalized()).norm(), 1e-4);
    }
  }
}

TEST(EdgeBlending, NeverBlendsOverACrease) {
  support::Random random(4);
  for (const TriangleMesh& shape :
       {support::box({0.01, 0.02, 0.03}), support::wedge(0.5, 0.05, 0.05)}) {
    const Shaded on(shape);
    for_each_shading(0.02, [&](const auto& shading) {
      for (int i = 0; i < 2000; ++i) {
        const auto t = static_cast<std::int32_t>(
            random.bits() % static_cast<std::uint64_t>(on.mesh.triangle_count()));
        const double a = random.uniform(0, 1);
        const double b = random.uniform(0, 1 - a);
        const Vector3d n = shading.normal(on.mesh, on.normals, t, weights_of(0, a, b));
        ASSERT_LT((n - on.mesh.cell(t).face.n).norm(), 1e-15);
      }
    });
  }
}

TEST(CurvedDepth, KnowsHowFarASphereStandsAboveAnEdge) {
  for (const int level : {1, 2, 3, 4}) {
    const ContactMesh mesh = ContactMesh::build(support::icosphere(level, 0.03)).value();
    const SmoothNormals normals(mesh, kCreaseAngle, NormalWeights::kRound);
    for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
      const double length = (mesh.position(t, 0) - mesh.position(t, 1)).norm();
      const double sagitta = length * length / (8 * 0.03);
      const double height = height_above(mesh, normals, t, {0.5, 0.5, 0});
      // On a sphere the formula gives exactly L^2 / 8R, which is the true sagitta to second order.
      ASSERT_NEAR(height, sagitta, 1e-12 * sagitta);
      const double true_sagitta = 0.03 - (mesh.position(t, 0) + mesh.position(t, 1)).norm() / 2;
      ASSERT_NEAR(height, true_sagitta, length * length / (12 * 0.03 * 0.03) * sagitta);
    }
  }
}

TEST(CurvedDepth, IsPositiveOnConvexAndNegativeOnConcave) {
  const support::TorusSurface surface{0.05, 0.02};
  const Shaded on(support::torus(0.05, 0.02, 96, 48));
  int hills = 0;
  int hollows = 0;
  for (std::int32_t t = 0; t < on.mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d middle = (on.mesh.position(t, k) + on.mesh.position(t, (k + 1) % 3)) / 2;
      const double length = (on.mesh.position(t, k) - on.mesh.position(t, (k + 1) % 3)).norm();
      const double wanted = -surface.value(middle);
      const double height = height_above(on.mesh, on.normals, t, weights_of(k, 0.5, 0.5));
      // Relative to the sagitta at the largest curvature.
      ASSERT_NEAR(height, wanted, 0.03 * length * length / (8 * 0.02));
      hills += wanted > 0.2 * length * length / (8 * 0.02);
      hollows += wanted < -0.2 * length * length / (8 * 0.02);
    }
  }
  EXPECT_GT(hills, 1000);
  EXPECT_GT(hollows, 1000);
}

TEST(Blended, CurvedSurfaceBeginsWithoutAForceStep) {
  Blended<OffsetContact, Phong, CurvedDepth> contact(
      OffsetContact::build(support::icosphere(1, 0.03)).value());
  const ContactMesh& mesh = contact.mesh();
  const Vector3d n = mesh.cell(7).face.n;
  const Vector3d middle = (mesh.position(7, 0) + mesh.position(7, 1) + mesh.position(7, 2)) / 3;
  support::move_tip(contact, middle + 1e-3 * n);
  for (int i = 1; i < 2000; ++i) {
    const double depth = 1e-6 * i;
    const ContactState& state = support::move_tip(contact, middle - depth * n);
    ASSERT_TRUE(state.touching);
    ASSERT_LE(state.depth, 2 * depth + 1e-12);
    ASSERT_GE(state.depth, depth);
  }
  // The middle of a triangle with corners on the sphere.
  EXPECT_NEAR(contact.state().depth, 0.001999 + 0.03 - middle.norm(), 1e-4);
}

TEST(Blended, PushesAlongItsNormalWithoutAllocation) {
  ContactForceLaw touch(
      Blended<MeshContact, FixedBand>(MeshContact::build(support::icosphere(3, 0.05)).value(),
                                      FixedBand{0.001}),
      SpringDamper{1000, 0});
  driver::DeviceState state;
  state.p_WT = {0.06, 0.001, 0.002};
  touch(state);
  support::Random random(5);
  int off_face = 0;
  const int heap_calls = support::heap_calls_of([&] {
    state.p_WT = {0.049, 0.001, 0.002};
    for (int i = 0; i < 10000; ++i) {
      state.p_WT = 0.0485 * (state.p_WT + 0.0003 * random.direction()).normalized();
      const driver::ForceCommand command = touch(state);
      const ContactState& found = touch.contact().state();
      EXPECT_LT((command.f_T_W - 1000 * found.depth * found.n_W).norm(), 1e-12);
      const Vector3d& face_n = touch.contact().mesh().cell(found.triangle).face.n;
      off_face += (found.n_W - face_n).norm() > 1e-3;
    }
  });
  EXPECT_EQ(heap_calls, 0);
  EXPECT_GT(off_face, 1000);
  EXPECT_LT(off_face, 9000);
}

}  // namespace
}  // namespace thimble::render
