#include "track/packed_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "search/tree_search.h"
#include "support/heap_guard.h"
#include "support/meshes/shapes.h"
#include "track/packed_contact_in_memory.h"
#include "track/packed_contact_steps.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Absent parts at present, according to a script.
struct Absence {
  std::function<bool(const PackedTriangle&)> triangles = [](const PackedTriangle&) {
    return false;
  };
  bool searches = false;
};

// Store that drops packed triangles according to a script, as a surface on disk does.
class ScriptedStore {
 public:
  static constexpr bool kComplete = false;

  ScriptedStore(const PackedSurface& surface, const TreeSearch<PackedSurface>& search,
                const Absence& absence)
      : surface_(&surface), search_(&search), absence_(&absence) {}

  const PackedTriangle* find(std::int32_t t) const noexcept {
    const PackedTriangle& packed = surface_->triangle(t);
    return absence_->triangles(packed) ? nullptr : &packed;
  }
  Vector3d to_lattice(const Vector3d& p_W) const noexcept { return surface_->to_lattice(p_W); }
  double step() const noexcept { return surface_->step(); }
  double reach() const noexcept { return 0.002; }
  double rise() const noexcept { return surface_->rise(); }
  FoundEntry first_entry(const Vector3d& from, const Vector3d& to) const noexcept {
    if (absence_->searches) return {.entry = {}, .complete = false};
    return {.entry = search_->first_entry(from, to)};
  }
  Known inside(const Vector3d& p_W) const noexcept {
    if (absence_->searches) return Known::kUnknown;
    return search_->inside(p_W) ? Known::kYes : Known::kNo;
  }
  FoundTriangle closest(const Vector3d& p_W, double radius) const noexcept {
    if (absence_->searches) return {.triangle = -1, .complete = false};
    return {.triangle = search_->closest(p_W, radius).triangle};
  }

 private:
  const PackedSurface* surface_;
  const TreeSearch<PackedSurface>* search_;
  const Absence* absence_;
};
static_assert(PackedStore<ScriptedStore> && PackedStore<InMemoryStore>);

struct PackedScene {
  explicit PackedScene(const TriangleMesh& mesh)
      : surface(PackedSurface::build(mesh).value()),
        search(surface),
        contact(ScriptedStore(surface, search, absence)) {}
  const ContactState& move(const Vector3d& p_WT) {
    driver::DeviceState state;
    state.p_WT = p_WT;
    return contact.update(state);
  }
  Absence absence;
  PackedSurface surface;
  TreeSearch<PackedSurface> search;
  PackedContact<ScriptedStore> contact;
};

// On a ball of 50 mm, 1 mm deep, by angle from the top.
Vector3d on_stroke(double angle) {
  return 0.049 * Vector3d(std::sin(angle), 0.01, std::cos(angle)).normalized();
}

TEST(PackedContact, MatchesTheContactInMemory) {
  const TriangleMesh mesh = support::bumpy_sphere(3, 0.05, 0.2, 4);
  PackedScene scene(mesh);
  InMemoryContact reference = InMemoryContact::build(mesh).value();
  int touched = 0;
  for (int i = 0; i < 20000; ++i) {
    const double along = 0.004 * i;
    const double size = 0.05 + 0.012 * std::sin(0.37 * along);
    driver::DeviceState state;
    state.p_WT = size * Vector3d(std::cos(along), std::sin(along), std::sin(0.3 * along));
    const ContactState& wanted = reference.update(state);
    const ContactState& found = scene.contact.update(state);
    ASSERT_EQ(found.touching, wanted.touching);
    ASSERT_EQ(found.depth, wanted.depth);
    ASSERT_EQ(found.n_W, wanted.n_W);
    touched += found.touching;
  }
  EXPECT_GT(touched, 1000);
  EXPECT_EQ(scene.contact.ticks_held(), 0u);
}

TEST(PackedContact, AbsentRecordsHoldThePlane) {
  PackedScene scene(support::icosphere(4, 0.05));
  // Nothing is loaded beyond 0.28 rad from the top, until the loader catches up.
  scene.absence.triangles = [&](const PackedTriangle& packed) {
    return packed.corner(0).x() > 0.28 * kLatticeHalf;
  };
  scene.move(1.2 * on_stroke(0));
  ContactState before = scene.move(on_stroke(0));
  ASSERT_TRUE(before.touching);
  constexpr double kTurn = 2e-4;  // rad per tick: 10 um
  double held_depth = 0;
  const auto stroke = [&](int first, int last) {
    for (int i = first; i <= last; ++i) {
      const ContactState& now = scene.move(on_stroke(kTurn * i));
      ASSERT_TRUE(now.touching);
      ASSERT_NEAR(now.n_W.norm(), 1, 1e-12);
      // A move of 10 um and, while the plane fades, a thirtieth of its error.
      ASSERT_LT(std::abs(now.depth - before.depth), 1.2e-5 + std::abs(held_depth - 1e-3) / 30);
      ASSERT_LT((now.n_W - before.n_W).norm(), 0.02);
      before = now;
    }
  };
  stroke(1, 1000);
  EXPECT_EQ(scene.contact.ticks_held(), 0u);
  EXPECT_NEAR(before.depth, 1e-3, 2e-5);
  stroke(1001, 2300);
  EXPECT_GT(scene.contact.ticks_held(), 300u);
  EXPECT_LT(scene.contact.ticks_held(), 1200u);
  held_depth = before.depth;
  EXPECT_GT(std::abs(held_depth - 1e-3), 5e-5);  // a plane differs from the ball
  scene.absence.triangles = [](const PackedTriangle&) { return false; };
  const std::uint64_t held = scene.contact.ticks_held();
  stroke(2301, 2400);
  EXPECT_EQ(scene.contact.ticks_held(), held);
  EXPECT_NEAR(before.depth, 1e-3, 2e-5);
}

TEST(PackedContact, UnknownSearchKeepsContact) {
  PackedScene scene(support::icosphere(3, 0.05));
  scene.move({0, 0, 0.06});
  ASSERT_TRUE(scene.move({0, 0, 0.049}).touching);
  scene.absence.searches = true;
  for (int i = 0; i <= 100; ++i) {
    // Out through the surface: the plane predicts no contact there.
    const ContactState& state = scene.move({0, 0, 0.049 + 2e-5 * i});
    ASSERT_TRUE(state.touching);
    ASSERT_GE(state.depth, 0);
  }
  EXPECT_EQ(scene.contact.state().depth, 0);
  scene.absence.searches = false;
  EXPECT_FALSE(scene.move({0, 0, 0.052}).touching);
}

TEST(PackedContact, UnknownPathIsExaminedLater) {
  PackedScene scene(support::icosphere(3, 0.05));
  scene.move({0, 0, 0.06});
  scene.absence.searches = true;
  EXPECT_FALSE(scene.move({0, 0, 0.055}).touching);
  EXPECT_FALSE(scene.move({0, 0, 0.049}).touching);  // through the surface, which is absent
  EXPECT_EQ(scene.contact.ticks_held(), 2u);
  scene.absence.searches = false;
  const ContactState& state = scene.move({0, 0, 0.0489});
  EXPECT_TRUE(state.touching);
  EXPECT_LT(state.depth, 1e-4);  // no jump,
  for (int i = 0; i < HeldPlane::kFadeTicks; ++i) scene.move({0, 0, 0.0489});
  EXPECT_NEAR(state.depth, 1.1e-3, 2e-5);  // but soon
}

// A coarse ball with a smooth surface millimetres above its triangles: contact begins there.
struct Bulge {
  Bulge() : scene(support::icosphere(1, 0.05)) {
    // Down through the middle of a triangle.
    const PackedTriangle& packed = scene.surface.triangle(0);
    const Vector3d middle = (packed.corner(0) + packed.corner(1) + packed.corner(2)) / 3;
    way = middle.normalized();
    triangles = middle.norm() * scene.surface.step();
    // Start of the contact if everything is loaded.
    PackedScene whole(support::icosphere(1, 0.05));
    smooth = 0.06;
    while (!whole.move(smooth * way).touching && smooth > triangles) smooth -= 1e-5;
  }
  const ContactState& move(double height) { return scene.move(height * way); }

  PackedScene scene;
  Vector3d way{0, 0, 0};
  double triangles = 0;  // heights above the middle, m: of the triangle,
  double smooth = 0;     // and of the smooth surface above it
};

TEST(PackedContact, BeginsOnTheSmoothBulge) {
  Bulge bulge;
  EXPECT_GT(bulge.smooth - bulge.triangles, 0.001);
  bulge.move(0.06);
  double before = 0;
  for (double height = 0.06; height > bulge.triangles; height -= 1e-5) {
    const ContactState& state = bulge.move(height);
    ASSERT_LT(state.depth - before, 1.2e-5);  // the tip's own motion
    before = state.depth;
  }
  EXPECT_NEAR(before, bulge.smooth - bulge.triangles, 3e-5);
}

// While the tip goes down into the bulge nothing is loaded there, or its packed triangle is absent,
// or only those around it are. It is felt as soon as they are loaded, or when the tip passes
// through the triangles, and then as if they had never been absent. (PagedContact is responsible
// for the slow return of the depth.)
TEST(PackedContact, LoadedRecordsShowABulge) {
  enum class Absent { kSearches, kAllRecords, kRecordsAround };
  for (const Absent absent : {Absent::kSearches, Absent::kAllRecords, Absent::kRecordsAround}) {
    for (const double share : {0.1, 0.5, 0.9}) {
      Bulge bulge;
      PackedScene whole(support::icosphere(1, 0.05));
      const PackedTriangle* const own = &bulge.scene.surface.triangle(0);
      bulge.scene.absence.searches = absent == Absent::kSearches;
      bulge.scene.absence.triangles = [=](const PackedTriangle& packed) {
        return absent == Absent::kAllRecords ||
               (absent == Absent::kRecordsAround && &packed != own);
      };
      const double seen = bulge.smooth - share * (bulge.smooth - bulge.triangles);
      double height = 0.06;
      for (; height > seen; height -= 1e-5) {
        const bool touching = bulge.move(height).touching;
        const bool wanted = whole.move(height * bulge.way).touching;
        // Over the middle of its own packed triangle, none of those around is needed.
        ASSERT_EQ(touching, wanted && absent == Absent::kRecordsAround) << height;
      }
      bulge.scene.absence = {};
      bool touching = false;
      for (; height > bulge.triangles - 0.001; height -= 1e-5) {
        const ContactState& wanted = whole.move(height * bulge.way);
        const ContactState& found = bulge.move(height);
        ASSERT_TRUE(found.touching || (!touching && height > bulge.triangles - 1e-5)) << height;
        touching = found.touching;
        if (touching) {
          ASSERT_EQ(found.depth, wanted.depth);
        }
      }
      EXPECT_TRUE(touching);
    }
  }
}

TEST(PackedContact, DoesNotAllocateWhileItHolds) {
  PackedScene scene(support::icosphere(3, 0.05));
  scene.move({0, 0, 0.06});
  scene.move(on_stroke(0));
  scene.absence.triangles = [](const PackedTriangle&) { return true; };
  const int calls = support::heap_calls_of([&] {
    for (int i = 0; i < 1000; ++i) scene.move(on_stroke(1e-3 * i));
  });
  EXPECT_EQ(calls, 0);
  EXPECT_GT(scene.contact.ticks_held(), 500u);
}

}  // namespace
}  // namespace thimble::render
