// Arms whose reports and messages are randomly late, and a computer whose ticks are.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "support/identify/identified_arm.h"
#include "support/long_form.h"
#include "support/random.h"

namespace thimble::bringup {
namespace {

using support::hidden_arm_of;
using support::HiddenArm;
using support::identified;

/// Returns a hidden arm whose wire has jitter (s) in both directions.
HiddenArm with_jitter(std::uint64_t seed, double jitter) {
  constexpr std::array kNames = {"vintage_phantom", "woodenhaptics_teensy", "polhem"};
  HiddenArm arm = hidden_arm_of(scene::load_arm(kNames[seed % kNames.size()]).value(), seed);
  arm.file.simulated.wire.jitter_ns = std::llround(1e9 * jitter);
  arm.delay += jitter;  // mean value: half of it in each direction
  return arm;
}

/// Identifies an arm behind a jitter (s), and compares the result with the true values.
void expect_found(std::uint64_t seed, double jitter) {
  SCOPED_TRACE(std::to_string(seed) + ", " + std::to_string(1e6 * jitter) + " us");
  const HiddenArm arm = with_jitter(seed, jitter);
  const auto found = identified(arm, {.seconds = 10, .link = true});
  ASSERT_TRUE(found.ok()) << found.error().message;
  for (const std::string& sentence : found->against) ADD_FAILURE() << sentence;
  const ArmConstants& is = found->constants;
  std::printf("%2d, %5.1f us: delay off by %6.2f us (+- %.2f)\n", static_cast<int>(seed),
              1e6 * jitter, 1e6 * (is.delay.value - arm.delay), 1e6 * is.delay.plus_minus);
  EXPECT_NEAR(is.delay.value, arm.delay, is.delay.plus_minus + 2e-5 + 0.05 * jitter);
  ASSERT_TRUE(found->reports.has_value());
  EXPECT_NEAR(found->reports->jitter.value, jitter / std::sqrt(12.0),
              2 * found->reports->jitter.plus_minus + 1e-8);
}

TEST(IdentifyJitter, FindsArmsBehindJitter) {
  if (!support::long_form()) {
    for (const double jitter : {5e-6, 1e-4, 5e-4}) expect_found(3, jitter);
    expect_found(4, 5e-6);  // a WoodenHaptics, whose motors are probed with many pushes
    return;
  }
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    support::Random random(9000 + seed);
    expect_found(seed, 1e-6 * std::exp(random.uniform(0, 1) * std::log(700.0)));
  }
}

/// Virtual time of a computer that wakes up late by 1.3 ms in one tick of `every`.
class LateClock final : public driver::Clock {
 public:
  explicit LateClock(int every) : every_(every) {}
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t time_ns) noexcept override {
    if (time_ns <= now_ns_) return;
    now_ns_ = time_ns + (++wakes_ % every_ == 0 ? 1'300'000 : 0);
  }

 private:
  int every_;
  int wakes_ = 0;
  std::int64_t now_ns_ = 0;
};

TEST(IdentifyLateTicks, AreNamedAsTheCause) {
  for (const int every : {30, 110, 400}) {
    scene::ArmFile file = scene::load_arm("vintage_phantom").value();
    file.simulated.hand = {};
    const OpenBench open = [&](bool) {
      return BenchArm::open(file, {}, {}, {{0, file.workspace.middle()}}, kIdentifyForceMax,
                            std::make_unique<LateClock>(every));
    };
    const std::atomic<bool> never{false};
    const auto found = identify(open, file, {.seconds = 10}, never);
    // A few late ticks do no harm; if they do, they are reported as the cause.
    if (found.ok() && found->against.empty()) continue;
    const std::string said = found.ok() ? found->against.front() : found.error().message;
    EXPECT_EQ(said.rfind("The computer was late in ", 0), 0u) << every << ": " << said;
    if (found.ok()) {
      EXPECT_EQ(found->against.size(), 1u) << every;
    }
  }
}

}  // namespace
}  // namespace thimble::bringup
