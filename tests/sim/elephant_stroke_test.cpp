#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lost_contacts.h"
#include "support/elephant.h"
#include "support/reference_geometry.h"

// The demo's whole stroke on the virtual clock, checked tick by tick against plain geometry that
// shares no code with the library: inside or outside by winding number, the cells of the paper's
// Fig. 4b from the mesh's vertices, force from depth and velocity.

namespace thimble {
namespace {

using Eigen::Vector3d;

Vector3d vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

class ElephantStroke : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!support::have_meshes()) return;
    auto session = support::open_elephant();
    ASSERT_TRUE(session);
    ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
    session_ = session.release();
  }
  static void TearDownTestSuite() {
    delete session_;
    session_ = nullptr;
  }

  void SetUp() override {
    THIMBLE_NEEDS_MESHES();
    ASSERT_TRUE(session_);
  }

  static std::span<const driver::TickRecord> rows() { return session_->trace().rows(); }
  static const render::TriangleMesh& mesh() { return session_->mesh_W(); }

  static app::Session* session_;
};
app::Session* ElephantStroke::session_ = nullptr;

TEST_F(ElephantStroke, TouchesForMostOfItsTimeAndMoreThanOnce) {
  EXPECT_EQ(rows().size(), 10'000u);
  EXPECT_GT(session_->statistics().contact_time(), 5.0);
  EXPECT_GE(session_->statistics().contacts(), 2u);
  EXPECT_GT(session_->statistics().force_max(), 0.5);
  EXPECT_LE(session_->statistics().force_max(), session_->scene().arm.limits.force_max);
}

TEST_F(ElephantStroke, LosesNoContactWhileTheTipIsInside) {
  // Every tick near a change of contact, and every 7th of the others.
  std::size_t checked = 0, lost = 0, felt_outside = 0;
  for (std::size_t i = 1; i < rows().size(); ++i) {
    const bool change = rows()[i].in_contact != rows()[i - 1].in_contact;
    if (!change && i % 7 != 0) continue;
    ++checked;
    const bool inside = support::is_inside(mesh(), vector(rows()[i].p_WT));
    if (inside && !rows()[i].in_contact) ++lost;
    // Contact may outlast the solid where it is thin, never elsewhere: the tip stays near it.
    if (!inside && rows()[i].in_contact) ++felt_outside;
  }
  EXPECT_GT(checked, 1400u);
  EXPECT_EQ(lost, 0u);
  EXPECT_EQ(felt_outside, 0u);
  // The report's own count says the same.
  EXPECT_EQ(app::count_lost_contacts(rows(), session_->touch()), 0u);
}

TEST_F(ElephantStroke, KeepsTheTriangleWhoseCellHoldsTheTip) {
  // Cells by brute force: the face's plane above the tip, and for each edge the plane through it
  // and the average of both faces' normals. Where no cell holds the tip (gaps at vertices) any
  // neighbour is right; such ticks must be rare.
  std::vector<Vector3d> normals;
  for (std::size_t t = 0; t < mesh().triangles.size(); ++t) {
    normals.push_back(support::outward_normal(mesh(), t));
  }
  const auto holds = [&](std::size_t t, const Vector3d& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = mesh().triangles[t][k], to = mesh().triangles[t][(k + 1) % 3];
      for (std::size_t other = 0; other < mesh().triangles.size(); ++other) {
        const auto& corners = mesh().triangles[other];
        if (other == t || std::count(corners.begin(), corners.end(), from) == 0 ||
            std::count(corners.begin(), corners.end(), to) == 0) {
          continue;
        }
        const Vector3d a = mesh().vertices[static_cast<std::size_t>(from)];
        const Vector3d edge = mesh().vertices[static_cast<std::size_t>(to)] - a;
        const Vector3d inward = (normals[t] + normals[other]).cross(edge).normalized();
        if (inward.dot(p - a) < -1e-12) return false;
      }
    }
    return normals[t].dot(p - support::corner(mesh(), t, 0)) <= 1e-12;
  };
  std::size_t checked = 0, outside_cell = 0, unexplained = 0;
  for (std::size_t i = 0; i < rows().size(); i += 11) {
    const auto& row = rows()[i];
    if (!row.in_contact) continue;
    ++checked;
    const Vector3d p = vector(row.p_WT);
    const auto active = static_cast<std::size_t>(row.feature);
    EXPECT_NEAR(row.depth, -normals[active].dot(p - support::corner(mesh(), active, 0)), 1e-12);
    if (holds(active, p)) continue;
    ++outside_cell;
    // Not in its own cell: then no cell near the tip may hold it.
    const auto nearest = support::nearest_on_mesh(mesh(), p);
    if (holds(nearest.triangle, p)) ++unexplained;
  }
  EXPECT_GT(checked, 400u);
  EXPECT_LT(outside_cell, checked / 50);
  EXPECT_EQ(unexplained, 0u);
}

TEST_F(ElephantStroke, ChangesDepthByNoMoreThanTheTipMoves) {
  // |d depth| <= |d p| within a triangle and over one edge, where the depth is continuous [BP 4b].
  // At a vertex the paper's cells overlap or leave gaps: the walk then crosses several edges in one
  // tick and the depth jumps to that of the face it lands on, the nearest. Such ticks are few.
  std::size_t steps = 0, several = 0;
  double worst = 0;
  for (std::size_t i = 1; i < rows().size(); ++i) {
    const auto &now = rows()[i], &before = rows()[i - 1];
    if (!now.in_contact || !before.in_contact) continue;
    ++steps;
    const double moved = (vector(now.p_WT) - vector(before.p_WT)).norm();
    const double excess = std::abs(now.depth - before.depth) - moved;
    if (now.hops <= 1) {
      EXPECT_LE(excess, 1e-12) << "tick " << now.tick;
    } else {
      ++several;
      worst = std::max(worst, excess);
      const double nearest = support::nearest_on_mesh(mesh(), vector(now.p_WT)).distance;
      EXPECT_NEAR(now.depth, nearest, 1e-9) << "tick " << now.tick;
    }
  }
  EXPECT_GT(steps, 5000u);
  EXPECT_LT(several, steps / 1000);
  // Measured: 0.19 mm of 2.1 mm, in a fold pressed deeper than its triangles are high.
  EXPECT_LT(worst, 0.25e-3);
}

TEST_F(ElephantStroke, PushesWithStiffnessTimesDepthPlusDampingTimesSpeedAlongTheNormal) {
  const auto& object = session_->scene().objects.front();
  for (const auto& row : rows()) {
    Vector3d expected{0, 0, 0};
    if (row.in_contact) {
      const Vector3d n = support::outward_normal(mesh(), static_cast<std::size_t>(row.feature));
      const double push = object.stiffness * row.depth - object.damping * n.dot(vector(row.v_WT));
      expected = std::max(push, 0.0) * n;
    }
    EXPECT_LT((vector(row.f_wanted_W) - expected).norm(), 1e-10) << "tick " << row.tick;
  }
}

TEST_F(ElephantStroke, JumpsInForceByNoMoreThanThePathImplies) {
  // Across a tick: k |d p| for the depth, b |d v| for the damping, and the turn of a flat normal.
  const auto& object = session_->scene().objects.front();
  for (std::size_t i = 1; i < rows().size(); ++i) {
    const auto &now = rows()[i], &before = rows()[i - 1];
    if (!now.in_contact || !before.in_contact || now.hops > 1) continue;
    const double moved = (vector(now.p_WT) - vector(before.p_WT)).norm();
    const double turned = (vector(now.n_W) - vector(before.n_W)).norm();
    const double faster = (vector(now.v_WT) - vector(before.v_WT)).norm();
    const double speed = vector(before.v_WT).norm();
    const double bound = object.stiffness * moved + object.damping * (faster + turned * speed) +
                         turned * vector(before.f_wanted_W).norm();
    EXPECT_LE((vector(now.f_wanted_W) - vector(before.f_wanted_W)).norm(), bound + 1e-10)
        << "tick " << now.tick;
  }
}

}  // namespace
}  // namespace thimble
