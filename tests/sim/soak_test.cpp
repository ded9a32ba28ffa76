// Every shipped scene for a long time under a hand that moves anywhere: no fault, no NaN, no growth
// of memory, and bit-identical results on any number of threads. THIMBLE_LONG: 10^8 ticks in total
// (or THIMBLE_SOAK_TICKS).
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "setup.h"
#include "support/covered.h"
#include "support/long_form.h"
#include "support/random.h"
#include "support/run_hash.h"
#include "support/seed.h"
#include "support/shipped_scenes.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

using Eigen::Vector3d;

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> names = support::scenes_of_one_arm();
  if (!std::filesystem::exists(THIMBLE_MESHES "/elephant.off")) std::erase(names, "elephant");
  return names;
}

/// Returns the bytes of the heap in use. Resident pages are not counted: memory allocated before
/// the first tick, such as clay's for later triangles, counts from the start, not when its pages
/// are first written.
std::size_t heap_in_use() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

/// Results of a scene's ticks.
struct Soaked {
  std::uint64_t ticks = 0;
  std::uint64_t hash = 0;
  std::uint64_t in_contact = 0;
  driver::Fault fault = driver::Fault::kNone;
  bool finite = true;
  bool within_limit = true;
  std::size_t heap_early = 0, heap_late = 0;  ///< heap in use after a tenth, and at the end, bytes
};

/// Moves the hand of a session to a sequence of places near the contacts of its scene.
class Wanderer {
 public:
  static constexpr std::uint64_t kTicksPerPlace = 300;

  Wanderer(session::Session& session, std::uint64_t seed) : session_(session), random_(seed) {
    for (const scene::HandWaypoint& waypoint : session.scene().arms.front().hand)
      places_.push_back(waypoint.p_W);
  }
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    if (state.tick % kTicksPerPlace == 0) {
      const scene::ArmFile& arm = session_.scene().arms.front().arm;
      const Vector3d place = places_[random_.bits() % places_.size()] + random_.in_box(0.012);
      const Vector3d inside =
          place.cwiseMax(0.9 * arm.workspace.min_W).cwiseMin(0.9 * arm.workspace.max_W);
      session_.simulation()->lead(inside);
    }
    return session_.touch()(state);
  }

 private:
  session::Session& session_;
  support::Random random_;
  std::vector<Vector3d> places_;
};

/// Stores the results of a scene.
class Witness {
 public:
  Witness(std::uint64_t ticks, double force_max) : early_(ticks / 10), force_max_(force_max) {}

  void operator()(const driver::TickRecord& tick) noexcept {
    hash_.add(tick);
    soaked_.in_contact += tick.in_contact ? 1 : 0;
    double square = 0;
    for (const double f : tick.f_sent_W) square += f * f;
    soaked_.finite = soaked_.finite && std::isfinite(square) && std::isfinite(tick.p_WT[0]);
    soaked_.within_limit = soaked_.within_limit && std::sqrt(square) <= force_max_ + 1e-9;
    if (tick.fault != driver::Fault::kNone) soaked_.fault = tick.fault;
    if (++soaked_.ticks == early_) soaked_.heap_early = heap_in_use();
  }
  Soaked close() {
    soaked_.hash = hash_.value();
    soaked_.heap_late = heap_in_use();
    return soaked_;
  }

 private:
  std::uint64_t early_;
  double force_max_;
  support::RunHash hash_;
  Soaked soaked_;
};

Soaked soak(const std::string& scene, std::uint64_t ticks) {
  session::SessionOptions options;
  options.mesh_folder = THIMBLE_MESHES;
  options.hand_by_mouse = true;  // the hand follows the test's commands
  options.duration = 1;
  auto opened = session::Session::open(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" / (scene + ".yaml"), options);
  if (!opened) {
    ADD_FAILURE() << opened.error().message;
    return {};
  }
  session::Session& session = **opened;
  Wanderer wanderer(session, support::seed_of(404));
  Witness witness(ticks, session.scene().arms.front().arm.limits.force_max);
  driver::run_servo(session.device(), session.setup().clock(), driver::ForceLaw(wanderer),
                    driver::TickSink(witness),
                    {.period_ns = session.setup().period_ns(), .ticks = ticks},
                    std::atomic<bool>{false});
  return witness.close();
}

/// Runs all scenes on this number of threads.
std::vector<Soaked> soak_all(const std::vector<std::string>& scenes, std::uint64_t ticks,
                             unsigned threads) {
  std::vector<Soaked> results(scenes.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < scenes.size(); i = next++) results[i] = soak(scenes[i], ticks);
  };
  std::vector<std::thread> team;
  for (unsigned i = 1; i < threads; ++i) team.emplace_back(work);
  work();
  for (std::thread& one : team) one.join();
  return results;
}

std::uint64_t hash_of(const std::vector<Soaked>& results) {
  support::RunHash hash;
  for (const Soaked& one : results) hash.add(one.hash);
  return hash.value();
}

bool watched() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#else
  return false;
#endif
}

std::uint64_t ticks_in_all() {
  if (const char* const asked = std::getenv("THIMBLE_SOAK_TICKS"))
    return std::strtoull(asked, nullptr, 10);
  if (watched()) return 8'000;
  return support::long_form() ? 100'000'000 : 140'000;
}

TEST(Soak, EverySceneSurvivesARandomHand) {
  // Memory that a service thread or the C++ library keeps once; one leaked byte per tick would
  // exceed it.
  constexpr std::size_t kGrowthMax = 8192;  // bytes
  const auto scenes = shipped_scenes();
  ASSERT_GE(scenes.size(), 13U);
  const std::uint64_t ticks = ticks_in_all() / scenes.size();
  const bool is_long = ticks > 100'000;
  const unsigned threads = is_long ? std::max(1U, std::thread::hardware_concurrency()) : 1;
  if (!watched()) soak_all(scenes, 100, 1);  // allocations that happen once for all runs
  const std::size_t heap_before = heap_in_use();
  const auto results = soak_all(scenes, ticks, threads);
  std::uint64_t in_contact = 0, done = 0;
  support::Covered covered("scenes");
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    SCOPED_TRACE(scenes[i]);
    const Soaked& one = results[i];
    EXPECT_EQ(one.ticks, ticks);
    EXPECT_TRUE(one.finite);
    EXPECT_TRUE(one.within_limit);
    EXPECT_EQ(name(one.fault), name(driver::Fault::kNone));
    if (!watched() && threads == 1) {  // another thread opens a scene at the same time
      EXPECT_LE(one.heap_late, one.heap_early + kGrowthMax) << "the heap grows with the ticks";
    }
    covered.add(scenes[i]);
    in_contact += one.in_contact;
    done += one.ticks;
  }
  if (!watched()) {
    EXPECT_LE(heap_in_use(), heap_before + kGrowthMax) << "scenes leak memory";
  }
  EXPECT_GT(in_contact, done / 20) << "hands without contact test nothing";
  std::printf(
      "soaked: %llu ticks of %zu scenes on %u threads, %.0f %% in contact, hash %016llx, %.1f kB "
      "of heap\n",
      static_cast<unsigned long long>(done), scenes.size(), threads,
      100.0 * static_cast<double>(in_contact) / static_cast<double>(done),
      static_cast<unsigned long long>(hash_of(results)), static_cast<double>(heap_in_use()) / 1e3);
}

TEST(Soak, IsBitIdenticalOnAnyNumberOfThreads) {
  const auto scenes = shipped_scenes();
  const std::uint64_t ticks = watched() ? 100 : 2'000;
  const auto alone = soak_all(scenes, ticks, 1);
  const auto together = soak_all(scenes, ticks, 3);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    EXPECT_EQ(alone[i].hash, together[i].hash) << scenes[i];
  }
  EXPECT_EQ(hash_of(alone), hash_of(together));
}

}  // namespace
}  // namespace thimble
