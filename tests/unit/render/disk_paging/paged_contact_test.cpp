#include "disk_paging/paged_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <thread>

#include "disk_paging/page_file.h"
#include "search/tree_search.h"
#include "support/contact_walk.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/scratch.h"
#include "support/seed.h"
#include "track/packed_contact_in_memory.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;       // s
constexpr double kRadius = 0.05;     // m
constexpr double kStiffness = 1000;  // N/m

/// A bumpy ball of 81,920 triangles: 80 pages.
const PackedSurface& ball() {
  static const PackedSurface surface =
      PackedSurface::build(support::bumpy_sphere(6, kRadius, 0.05, 6)).value();
  return surface;
}

std::filesystem::path ball_file() {
  static const std::filesystem::path file = [] {
    const auto path = support::scratch_folder() / "ball.pages";
    EXPECT_TRUE(write_page_file(ball(), path).ok());
    return path;
  }();
  return file;
}

std::shared_ptr<PagedSurface> open(const PagingSettings& settings,
                                   const std::filesystem::path& file = ball_file()) {
  auto opened = PagedSurface::open(file, settings);
  EXPECT_TRUE(opened.ok()) << (opened ? "" : opened.error().message);
  return std::move(opened).value();
}

/// As support::bumpy_sphere: measured on the surface itself, by the tree's answer.
double radius_at(const Vector3d& direction) {
  static const TreeSearch<PackedSurface> tree(ball());
  const Entry entry = tree.first_entry(2 * kRadius * direction, Vector3d::Zero());
  return 2 * kRadius * (1 - entry.parameter);
}

/// Moves a tip over a paged surface and checks that the force never jumps.
class Hand {
 public:
  explicit Hand(PagedContact paged) : contact(std::move(paged)) {}

  const ContactState& move(const Vector3d& p_WT) {
    const Vector3d moved = p_WT - state_.p_WT;
    state_.v_WT = state_.tick > 0 ? Vector3d(moved / kTick) : Vector3d::Zero();
    state_.dt = state_.tick > 0 ? kTick : 0;
    state_.p_WT = p_WT;
    const ContactState before = contact.state();
    const ContactState& now = contact.update(state_);
    if (state_.tick++ > 0 && now.touching) {
      const double depth_before = before.touching ? before.depth : 0;
      const Vector3d felt = now.depth * now.n_W, felt_before = depth_before * before.n_W;
      EXPECT_GE(now.depth, 0);
      EXPECT_LE(now.depth,
                depth_before + 1.5 * moved.norm() + PagedContact::kRiseSpeed * kTick + 1e-9);
      largest_jump = std::max(largest_jump, (felt - felt_before).norm() - 1.5 * moved.norm());
    }
    if (!now.touching && before.touching) largest_end = std::max(largest_end, before.depth);
    return now;
  }
  void serve() {
    while (contact.surface().serve() > 0) {
    }
  }
  const Vector3d& tip() const { return state_.p_WT; }

  PagedContact contact;
  double largest_jump = 0;  // of the depth vector, beyond the tip's motion, m
  double largest_end = 0;   // depth in the last tick of a contact, m

 private:
  driver::DeviceState state_;
};

/// A wandering path over the ball, `depth` below the sphere that was bumped.
class Way {
 public:
  explicit Way(std::uint64_t seed) : random_(seed) {}
  Vector3d next(double step, double depth) {
    axis_ = (axis_ + 0.05 * random_.direction()).normalized();
    at_ = (at_ + step / kRadius * axis_.cross(at_).normalized()).normalized();
    return (radius_at(at_) - depth) * at_;
  }

 private:
  support::Random random_;
  Vector3d at_{0, 0, 1}, axis_{1, 0, 0};
};

TEST(PagedContact, MatchesTheContactInMemory) {
  Hand hand(PagedContact(open({.frames = 24, .reach = 0.003, .horizon = 0.02})));
  InMemoryContact reference((PackedSurface(ball())));
  Way way(support::seed_of(1));
  int touching = 0;
  for (int i = 0; i < 20'000; ++i) {
    // In and out, as the depth oscillates.
    const Vector3d p = way.next(2e-4, 4e-4 + 6e-4 * std::sin(0.01 * i));
    const ContactState& felt = hand.move(p);
    const ContactState& expected = support::move_tip(reference, p);
    hand.serve();
    ASSERT_EQ(felt.touching, expected.touching) << i;
    if (!felt.touching) continue;
    ++touching;
    EXPECT_NEAR(felt.depth, expected.depth, 1e-12) << i;
    EXPECT_LT((felt.n_W - expected.n_W).norm(), 1e-12) << i;
    EXPECT_EQ(felt.triangle, expected.triangle) << i;
  }
  EXPECT_EQ(hand.contact.misses(), 0u);
  EXPECT_GT(hand.contact.surface().counters().evictions, 50u);
  EXPECT_GT(touching, 10'000);
}

TEST(PagedContact, PlacedMeshFeelsLikeAMovedOne) {
  const PagedPlace place{.scale = 0.7,
                         .R_WM = Eigen::AngleAxisd(0.8, Vector3d(1, 2, 3).normalized()).matrix(),
                         .p_WM = {0.02, -0.3, 0.1}};
  Hand placed(PagedContact(open({.frames = 100, .reach = 1, .horizon = 0}), place));
  Hand plain(PagedContact(open({.frames = 100, .reach = 1, .horizon = 0})));
  Way way(support::seed_of(2));
  for (int i = 0; i < 5'000; ++i) {
    const Vector3d p = way.next(2e-4, 4e-4 + 6e-4 * std::sin(0.01 * i));
    const ContactState& there = placed.move(place.p_WM + place.scale * (place.R_WM * p));
    const ContactState& here = plain.move(p);
    placed.serve();
    plain.serve();
    ASSERT_EQ(there.touching, here.touching);
    if (!there.touching) continue;
    EXPECT_NEAR(there.depth, place.scale * here.depth, 1e-9);
    EXPECT_LT((there.n_W - place.R_WM * here.n_W).norm(), 1e-6);
    EXPECT_LT((there.p_WP - place.p_WM - place.scale * (place.R_WM * here.p_WP)).norm(), 1e-9);
  }
}

TEST(PagedContact, LoadsTheTouchedSurfaceAtAnyDepth) {
  Hand hand(PagedContact(open({.frames = 8, .reach = 0.002, .horizon = 0.02})));
  Way way(support::seed_of(3));
  for (int i = 0; i < 4'000; ++i) {
    const double depth = std::min(-0.002 + 2e-5 * i, 0.012);
    hand.move(way.next(1e-4, depth));
    hand.serve();
  }
  EXPECT_TRUE(hand.contact.state().touching);
  EXPECT_NEAR(hand.contact.state().depth, 0.012, 0.002);
  EXPECT_EQ(hand.contact.misses(), 0u);
}

TEST(PagedContact, StalledLoaderCausesNoJump) {
  for (const double stall : {0.02, 0.1, 0.5}) {
    Hand hand(PagedContact(open({.frames = 80, .reach = 0.002, .horizon = 0.01})));
    Way way(support::seed_of(4));
    hand.move(way.next(1e-4, -0.002));
    hand.serve();
    for (int i = 0; i < 40; ++i) {
      hand.move(way.next(1e-4, -0.002 + 1e-4 * i));
      hand.serve();
    }
    ASSERT_TRUE(hand.contact.state().touching);
    const std::uint64_t missed = hand.contact.misses();
    // 0.3 m/s without a loader.
    const int ticks = static_cast<int>(stall / kTick);
    for (int i = 0; i < ticks; ++i) {
      const ContactState& felt = hand.move(way.next(3e-4, 0.0015));
      EXPECT_TRUE(felt.touching || felt.depth == 0);
    }
    if (stall > 0.05) {
      EXPECT_GT(hand.contact.misses(), missed + 10);
    }
    hand.serve();
    // A held plane fades; where the plane has left the tip, the surface returns slowly.
    for (int i = 0; i < 600; ++i) {
      hand.move(way.next(1e-5, 0.0015));
      hand.serve();
    }
    EXPECT_TRUE(hand.contact.state().touching);
    EXPECT_NEAR(hand.contact.state().depth, 0.0015, 2e-4) << stall;
    // A held plane may deviate by the ball's curvature; it fades over 32 ticks.
    EXPECT_LT(hand.largest_jump, 5e-4) << stall;
  }
}

TEST(PagedContact, TipThatEnteredUnseenIsNotThrownOut) {
  // A free mass at 0.5 m/s, no page in memory: it gets 8 mm deep before the loader runs.
  Hand hand(PagedContact(open({.frames = 80, .reach = 0.003, .horizon = 0.01})));
  const double mass = 0.1;  // kg, arm and fingers
  double z = radius_at({0, 0, 1}) + 0.002, v = -0.5;
  double fastest_out = 0, deepest = 0;
  for (int i = 0; i < 3000; ++i) {
    const ContactState& felt = hand.move({0, 0, z});
    const double force = felt.touching ? kStiffness * felt.depth - 2 * v : 0;
    if (i > 25) hand.serve();
    if (i == 20) v = 0;  // the hand stops there
    v += kTick * std::max(force, 0.0) / mass;
    z += kTick * v;
    fastest_out = std::max(fastest_out, v);
    deepest = std::max(deepest, radius_at({0, 0, 1}) - z);
  }
  EXPECT_GT(deepest, 0.007);
  EXPECT_GT(z, radius_at({0, 0, 1}) - 1e-3);               // the surface pushes it out,
  EXPECT_LT(fastest_out, 2.5 * PagedContact::kRiseSpeed);  // but slowly
}

TEST(PagedContact, ReturnsSlowlyAfterAnUnseenEntryIntoABulge) {
  // A coarse ball: over the middle of a triangle its smooth surface is 3 mm above it.
  const PackedSurface coarse = PackedSurface::build(support::icosphere(1, kRadius)).value();
  const auto file = support::scratch_folder() / "coarse.pages";
  ASSERT_TRUE(write_page_file(coarse, file).ok());
  const Vector3d middle =
      (coarse.triangle(0).corner(0) + coarse.triangle(0).corner(1) + coarse.triangle(0).corner(2)) /
      3;
  const double triangles = middle.norm() * coarse.step();
  ASSERT_GT(coarse.rise(), 0.002);
  for (const double share : {0.2, 0.8}) {
    // Hand checks that the depth never grows by more than the tip's motion plus 20 um per tick.
    Hand hand(PagedContact(open({.frames = 4, .reach = 0.003, .horizon = 0.01}, file)));
    InMemoryContact whole = InMemoryContact::build(support::icosphere(1, kRadius)).value();
    support::move_tip(whole, 0.06 * middle.normalized());
    const double seen = triangles + share * coarse.rise();
    double height = 0.06;
    for (; height > seen; height -= 5e-5) {
      EXPECT_FALSE(hand.move(height * middle.normalized()).touching);
      support::move_tip(whole, height * middle.normalized());
    }
    EXPECT_GT(hand.contact.misses(), 0u);
    for (int i = 0; i < 100; ++i) {
      hand.serve();
      hand.move(height * middle.normalized());
    }
    for (; height > triangles - 0.001; height -= 5e-5) {
      hand.serve();
      hand.move(height * middle.normalized());
      support::move_tip(whole, height * middle.normalized());
    }
    for (int i = 0; i < 300; ++i) hand.move(hand.tip());
    EXPECT_TRUE(hand.contact.state().touching);
    EXPECT_NEAR(hand.contact.state().depth, whole.state().depth, 1e-9) << share;
  }
}

TEST(PagedContact, BypassedSurfaceIsNotContact) {
  // From above to the side, outside the ball; the straight path between them crosses it.
  Hand hand(PagedContact(open({.frames = 80, .reach = 1, .horizon = 0})));
  hand.move({0, 0, 0.054});
  for (int i = 0; i <= 300; ++i) {
    const double turn = std::numbers::pi / 600 * i;
    EXPECT_FALSE(hand.move({0.056 * std::sin(turn), 0, 0.056 * std::cos(turn)}).touching);
  }
  EXPECT_GT(hand.contact.misses(), 0u);
  hand.serve();
  EXPECT_FALSE(hand.move({0.056, 0, 1e-4}).touching);
  const std::uint64_t misses = hand.contact.misses();
  EXPECT_FALSE(hand.move({0.056, 0, 0}).touching);
  EXPECT_TRUE(hand.move({radius_at({1, 0, 0}) - 5e-4, 0, 0}).touching);
  EXPECT_EQ(hand.contact.misses(), misses);
}

TEST(PagedContact, ReleasedHoldLeavesNoWallInFreeAir) {
  Hand hand(PagedContact(open({.frames = 80, .reach = 0.003, .horizon = 0})));
  const double top = radius_at({0, 0, 1});
  hand.move({0, 0, top + 0.001});
  hand.serve();
  hand.move({0, 0, top - 0.001});
  ASSERT_TRUE(hand.contact.state().touching);
  // Sideways over absent pages, up, and down next to the ball, where the held plane continues.
  for (int i = 0; i <= 200; ++i) hand.move({2e-4 * i, 0, top - 0.001});
  EXPECT_GT(hand.contact.misses(), 100u);
  for (int i = 0; i <= 50; ++i) hand.move({0.04, 0, top - 0.001 + 1e-4 * i});
  for (int i = 0; i <= 100; ++i) hand.move({0.04 + 5e-4 * i, 0, top + 0.004});
  for (int i = 0; i <= 200; ++i) {
    EXPECT_EQ(hand.move({0.09, 0, top + 0.004 - 5e-4 * i}).depth, 0);
  }
  hand.serve();
  hand.move({0.09, 0, 0});
  EXPECT_FALSE(hand.contact.state().touching);
}

TEST(PagedContact, NeverJumpsWhileItsPagesComeAndGoAtRandom) {
  support::Random random(11);
  const int ticks = support::long_form() ? 400'000 : 30'000;
  Hand hand(PagedContact(open({.frames = 10, .reach = 0.002, .horizon = 0.004})));
  Way way(support::seed_of(5));
  int touching = 0, serving = 0;
  for (int i = 0; i < ticks; ++i) {
    const double step = 3e-4 * (1 + std::sin(0.003 * i));
    const ContactState& felt = hand.move(way.next(step, 8e-4 + 1.2e-3 * std::sin(0.007 * i)));
    ASSERT_TRUE(std::isfinite(felt.depth) && felt.n_W.allFinite());
    touching += felt.touching;
    // The loader pauses at times, for up to some tenths of a second.
    if (serving <= 0 && random.bits() % 40 == 0) serving = static_cast<int>(random.bits() % 300);
    if (serving-- > 0) hand.contact.surface().serve();
  }
  EXPECT_GT(hand.contact.misses(), 100u);
  EXPECT_GT(hand.contact.surface().counters().evictions, 100u);
  EXPECT_GT(touching, ticks / 4);
  EXPECT_LT(hand.largest_jump, 5e-4);
  EXPECT_LT(hand.largest_end, 2e-4);
}

TEST(PagedContact, HoldsThePlaneOverADamagedPage) {
  const auto path = support::scratch_folder() / "damaged_ball.pages";
  std::filesystem::copy_file(ball_file(), path, std::filesystem::copy_options::overwrite_existing);
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path));
  const std::int64_t records_at =
      size - std::int64_t{ball().triangle_count()} * std::int64_t{sizeof(PackedTriangle)};
  support::Random random(12);
  {
    std::fstream stream(path, std::ios::binary | std::ios::in | std::ios::out);
    for (int page = 0; page < 80; page += 4) {
      const auto at =
          records_at + page * 65'536 + static_cast<std::int64_t>(random.bits() % 65'536);
      stream.seekg(at);
      const char byte = static_cast<char>(stream.get() ^ (1 << (random.bits() % 8)));
      stream.seekp(at);
      stream.put(byte);
    }
  }
  Hand hand(PagedContact(open({.frames = 24, .reach = 0.002, .horizon = 0.02}, path)));
  Way way(support::seed_of(6));
  for (int i = 0; i < 20'000; ++i) {
    const ContactState& felt = hand.move(way.next(2e-4, 4e-4 + 6e-4 * std::sin(0.01 * i)));
    ASSERT_TRUE(std::isfinite(felt.depth) && felt.n_W.allFinite());
    hand.contact.surface().serve();
  }
  EXPECT_GT(hand.contact.surface().counters().failures, 0u);
  EXPECT_GT(hand.contact.misses(), 100u);
  EXPECT_LT(hand.largest_jump, 5e-4);
}

TEST(PagedContact, EveryTickEndsOnInvalidRecords) {
  // Valid checksums, but invalid contents: neighbours that lead anywhere and around in circles,
  // corners and normals of random bits.
  support::Random random(13);
  for (int round = 0; round < (support::long_form() ? 200 : 12); ++round) {
    std::vector<PackedTriangle> records(ball().triangles().begin(), ball().triangles().end());
    const auto count = static_cast<std::uint64_t>(records.size());
    for (PackedTriangle& r : records) {
      if (random.bits() % 8 != 0) continue;
      const auto k = static_cast<std::size_t>(random.bits() % 3);
      switch ((random.bits() + static_cast<std::uint64_t>(round)) % 5) {
        case 0:
          r.neighbours[k] = static_cast<std::int32_t>(random.bits() % count);
          break;
        case 1:
          r.neighbours = {static_cast<std::int32_t>(&r - records.data()), r.neighbours[0],
                          r.neighbours[1]};
          break;
        case 2:
          r.x[k] = static_cast<std::int32_t>(random.bits());
          break;
        case 3:
          r.normals[k] = static_cast<std::uint32_t>(random.bits());
          break;
        default:
          r.x[1] = r.x[0], r.y[1] = r.y[0], r.z[1] = r.z[0];  // no area
      }
      r.flags ^= static_cast<std::uint32_t>(random.bits() % 8);
    }
    const auto path = support::scratch_folder() / "nonsense.pages";
    auto writer = PageFileWriter::create(path, {ball().origin(), ball().step()},
                                         static_cast<std::int64_t>(records.size()));
    ASSERT_TRUE(writer.ok());
    ASSERT_TRUE(writer->append(records).ok());
    ASSERT_TRUE(writer->finish().ok());
    PagedContact contact(open({.frames = 40, .reach = 0.002, .horizon = 0.02}, path));
    Way way(support::seed_of(7));
    driver::DeviceState state;
    state.dt = kTick;
    for (int i = 0; i < 2'000; ++i) {
      state.p_WT = way.next(2e-4, 4e-4 + 6e-4 * std::sin(0.01 * i));
      const ContactState felt = contact.update(state);
      // A depth of NaN means no force; a force has a direction.
      if (felt.touching && felt.depth > 0) {
        ASSERT_TRUE(std::isfinite(felt.depth));
      }
      contact.surface().serve();
    }
  }
}

TEST(PagedContact, DoesNotAllocateInATick) {
  Hand hand(PagedContact(open({.frames = 8, .reach = 0.002, .horizon = 0.004})));
  Way way(support::seed_of(8));
  std::vector<Vector3d> tips;
  for (int i = 0; i < 3'000; ++i) tips.push_back(way.next(2e-4, 1e-3 * std::sin(0.01 * i)));
  driver::DeviceState state;
  state.dt = kTick;
  int calls = 0;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    state.p_WT = tips[i];
    calls += support::heap_calls_of([&] { hand.contact.update(state); });
    if (i % 100 < 50) hand.contact.surface().serve();
  }
  EXPECT_EQ(calls, 0);
  EXPECT_GT(hand.contact.misses(), 10u);
}

TEST(PagedContact, FindsTheSurfaceAfterAnyUnseenMove) {
  // More of the ball lies between the last place known to be free and the present one than fits the
  // frames.
  Hand hand(PagedContact(open({.frames = 5, .reach = 0.002, .horizon = 0.01})));
  Way way(support::seed_of(9));
  int touching = 0;
  for (int i = 0; i < 20'000; ++i) {
    const ContactState& felt = hand.move(way.next(4e-4, 8e-4 + 1.2e-3 * std::sin(0.007 * i)));
    touching += felt.touching;
    if (i > 3'000) hand.contact.surface().serve();
  }
  EXPECT_GT(touching, 10'000);
  EXPECT_LT(hand.largest_jump, 5e-4);
}

TEST(PagedContact, NeverJumpsWhileAThreadLoadsForIt) {
  // Few frames and a fast tip, so that the loader is late and discards pages all the time.
  const auto surface = open({.frames = 5, .reach = 0.002, .horizon = 0.01});
  Hand hand((PagedContact(surface)));
  surface->start_loader();
  Way way(support::seed_of(9));
  std::vector<Vector3d> tips;
  for (int i = 0; i < 20'000; ++i) {
    tips.push_back(way.next(4e-4, 8e-4 + 1.2e-3 * std::sin(0.007 * i)));
  }
  int touching = 0;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    const ContactState& felt = hand.move(tips[i]);
    ASSERT_TRUE(std::isfinite(felt.depth) && felt.n_W.allFinite());
    touching += felt.touching;
    if (i % 64 != 0) continue;
    // Until the loader has done something, even on a busy machine; at times it has nothing to do.
    const auto before = surface->counters();
    for (int wait = 0; wait < 60; ++wait) {
      std::this_thread::sleep_for(std::chrono::microseconds(300));
      if (surface->counters().loads > before.loads) break;
    }
  }
  EXPECT_GT(touching, 1000);
  EXPECT_GT(surface->counters().evictions, 20u);
  EXPECT_LT(hand.largest_jump, 5e-4);
}

}  // namespace
}  // namespace thimble::render
