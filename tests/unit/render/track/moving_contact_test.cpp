#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "support/contact_walk.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/meshes/dents.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "track/blended.h"
#include "track/god_object.h"
#include "track/mesh_contact.h"
#include "track/moving_contact.h"

// Contact with a surface that changes shape.

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kBallRadius = 0.05;  // m

driver::DeviceState at(const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return state;
}

std::shared_ptr<MovingMesh> moving(const TriangleMesh& shape) {
  return std::make_shared<MovingMesh>(ContactMesh::build(shape, {.room = 0.5}).value(),
                                      MovingMeshOptions{.normals = NormalWeights::kAngle});
}

// Calls test(surface, contact) for each kind of contact with a moving surface.
template <class Test>
void for_each_way(const TriangleMesh& shape, Test test) {
  {
    SCOPED_TRACE("edge planes");
    const auto surface = moving(shape);
    test(surface, MovingContact(surface, TrackedContact<SurfaceTracker>(mesh_of(surface),
                                                                        search_of(surface))));
  }
  {
    SCOPED_TRACE("edge planes, phong");
    const auto surface = moving(shape);
    test(surface, MovingContact(surface, Blended(MeshContact(mesh_of(surface), search_of(surface)),
                                                 Phong(), normals_of(surface))));
  }
  {
    SCOPED_TRACE("offset");
    const auto surface = moving(shape);
    test(surface, MovingContact(surface, OffsetContact(mesh_of(surface), search_of(surface),
                                                       normals_of(surface))));
  }
  {
    SCOPED_TRACE("god-object");
    const auto surface = moving(shape);
    test(surface, MovingContact(surface, GodObjectContact(mesh_of(surface), search_of(surface))));
  }
}

TEST(MovingContact, FollowsADeformingSurface) {
  const TriangleMesh shape = support::icosphere(4, kBallRadius);
  for_each_way(shape, [&](const auto& surface, auto contact) {
    support::Random random(1);
    contact.update(at({0, 0.001, 0.06}));
    contact.update(at({0, 0.001, kBallRadius - 0.0005}));
    ASSERT_TRUE(contact.state().touching);
    const std::int32_t centre = surface->mesh().corners(contact.state().triangle)[0];
    std::vector<VertexMove> dented;
    // Tip and surface move 5 mm in, across and out again; the tip stays about 0.5 mm below.
    for (int tick = 0; tick < 400; ++tick) {
      const double depth = 0.005 * std::sin(M_PI * tick / 400);
      std::vector<VertexMove> moves;
      for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
        const Vector3d& p = shape.vertices[v];
        const double share = (p - shape.vertices[static_cast<std::size_t>(centre)]).norm() / 0.02;
        if (!(share < 1)) continue;
        moves.push_back({static_cast<std::int32_t>(v),
                         p - Vector3d(0, 0, depth * std::pow(1 - share * share, 2))});
      }
      contact.move_vertices(moves);
      const Vector3d p(0.0005 * std::sin(0.05 * tick), 0.001, kBallRadius - 0.0005 - depth);
      const ContactState& state = contact.update(at(p));
      ASSERT_TRUE(state.touching) << tick;
      ASSERT_GT(state.depth, 0.0001) << tick;
      ASSERT_LT(state.depth, 0.0012) << tick;
      dented = moves;
    }
    // It springs back in one tick while the tip does not move: deeper, and still in contact.
    contact.move_vertices(support::back_to(shape.vertices, dented));
    const ContactState& state = contact.update(at({0, 0.001, kBallRadius - 0.003}));
    EXPECT_TRUE(state.touching);
    EXPECT_NEAR(state.depth, 0.003, 0.0005);
    // It recedes farther than the tip follows.
    std::vector<VertexMove> gone;
    for (const VertexMove& move : dented) {
      gone.push_back({move.vertex, shape.vertices[static_cast<std::size_t>(move.vertex)] -
                                       Vector3d(0, 0, 0.01)});
    }
    contact.move_vertices(gone);
    EXPECT_FALSE(contact.update(at({0, 0.001, kBallRadius - 0.003})).touching);
  });
}

// For any motion, however far in one step: a tip that rests outside and is inside afterwards
// touches. One that is outside without a wall having passed does not.
TEST(MovingContact, MovingSurfaceCannotPassARestingTip) {
  for (const TriangleMesh& shape :
       {support::icosphere(3, kBallRadius), support::torus(0.035, 0.015, 30, 16)}) {
    for_each_way(shape, [&](const auto& surface, auto contact) {
      support::Random random(2);
      const int rounds = support::long_form() ? 1000 : 150;
      int caught = 0;
      for (int round = 0; round < rounds; ++round) {
        const auto centre = static_cast<std::int32_t>(
            random.bits() % static_cast<std::uint64_t>(surface->mesh().vertex_count()));
        const Vector3d out = support::outwards_at(surface->mesh(), centre);
        const Vector3d tip = surface->mesh().position(centre) + 0.002 * out + random.in_box(0.002);
        contact.update(at(Vector3d::Constant(NAN)));
        contact.update(at(tip));
        const bool inside = surface->search().inside(tip);
        // Up to ten times the edge length in one step; then back.
        const auto moves =
            support::dent(surface->mesh(), centre, out, random.uniform(0, 0.02), 0.02, random);
        contact.move_vertices(moves);
        const bool inside_now = surface->search().inside(tip);
        // A tip that begins inside was never outside: it has no contact.
        EXPECT_EQ(contact.state().touching, !inside && inside_now) << round;
        const bool touching = contact.update(at(tip)).touching;
        EXPECT_EQ(touching, !inside && inside_now) << round;
        caught += touching;
        if (round % 2 == 0) {
          // Back out of it: released, unless another wall passed.
          contact.move_vertices(support::back_to(shape.vertices, moves));
          const bool still = surface->search().inside(tip);
          EXPECT_EQ(contact.update(at(tip)).touching, touching && still) << round;
        } else {
          contact.move_vertices(support::back_to(shape.vertices, moves));
        }
      }
      EXPECT_GT(caught, rounds / 10);
    });
  }
}

// A plate of 1 mm jumps by 20 mm, past a tip that was above it and is far below it afterwards.
TEST(MovingContact, PlateThatSweepsOverTheTipIsFelt) {
  const TriangleMesh shape = support::plate(0.1, 0.001, 8);
  for_each_way(shape, [&](const auto& surface, auto contact) {
    support::Random random(3);
    for (int round = 0; round < 50; ++round) {
      const Vector3d tip{random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03),
                         random.uniform(0.001, 0.01)};
      contact.update(at(Vector3d::Constant(NAN)));
      contact.update(at(tip));
      std::vector<VertexMove> up;
      for (std::int32_t v = 0; v < surface->mesh().vertex_count(); ++v) {
        up.push_back({v, surface->mesh().position(v) + Vector3d(0, 0, 0.02)});
      }
      // In any order of the vertices.
      for (std::size_t i = up.size() - 1; i > 0; --i) std::swap(up[i], up[random.bits() % (i + 1)]);
      contact.move_vertices(up);
      ASSERT_FALSE(surface->search().inside(tip));
      const ContactState& state = contact.update(at(tip));
      ASSERT_TRUE(state.touching) << round;
      EXPECT_NEAR(state.depth, 0.0205 - tip.z(), 1e-9);
      EXPECT_GT(state.n_W.z(), 0.99);
      contact.move_vertices(support::back_to(shape.vertices, up));
    }
  });
}

// A free tip remembers a ball without triangles: a surface that grows into the ball must still be
// felt.
TEST(MovingContact, GrowingSurfaceInvalidatesFreeSpace) {
  const TriangleMesh shape = support::icosphere(3, kBallRadius);
  for_each_way(shape, [&](const auto& surface, auto contact) {
    for (int i = 0; i < 200; ++i) contact.update(at({0, 0, 0.07 + 1e-5 * i}));
    std::vector<VertexMove> grown;
    for (std::int32_t v = 0; v < surface->mesh().vertex_count(); ++v) {
      grown.push_back({v, 1.3 * surface->mesh().position(v)});
    }
    contact.move_vertices(grown);
    EXPECT_FALSE(contact.update(at({0, 0, 0.072})).touching);
    EXPECT_TRUE(contact.update(at({0, 0, 0.064})).touching);
  });
}

TEST(MovingContact, MovesWithoutAllocation) {
  for_each_way(support::icosphere(3, kBallRadius), [&](const auto& surface, auto contact) {
    support::Random random(4);
    contact.update(at({0, 0, 0.06}));
    const auto moves = support::dent(surface->mesh(), 5, Vector3d(0, 0, 1), 0.02, 0.04, random);
    const int calls = support::heap_calls_of([&] {
      contact.move_vertices(moves);
      contact.update(at({0, 0, 0.049}));
    });
    EXPECT_EQ(calls, 0);
  });
}

}  // namespace
}  // namespace thimble::render
