// Identification never requests more force than its limit, and none outside the workspace, whatever
// the arm, its hand and its faults are. tests/acceptance/FAULTS.md has a row for each fault.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "bringup/identify/identify.h"
#include "bringup/identify/record_motion.h"
#include "gravity_terms.h"
#include "support/fault_cell.h"
#include "support/identify/identified_arm.h"
#include "support/long_form.h"
#include "support/random.h"

namespace thimble::bringup {
namespace {

using support::hidden_arm;
using support::HiddenArm;
using support::long_form;
using support::Random;

using HandPath = std::vector<std::pair<double, Eigen::Vector3d>>;

/// A hidden arm, its hand, and the start of its tip (W, m).
struct Case {
  HiddenArm arm;
  HandPath hand_W;
};

/// A fault of an arm during its identification.
struct Trouble {
  std::string name;
  std::function<void(Case&, Random&)> bring;
};

void take_in_hand(Case& held, Random& random) {
  auto& hand = held.arm.file.simulated.hand;
  hand.mass = random.uniform(0, 0.05);
  hand.stiffness = random.uniform(10, 500);
  hand.damping = random.uniform(0.5, 8);
  hand.tremor_amplitude = random.uniform(0, 2e-4);
}

/// Returns the point at the distance `far` (m) outside the middle of a side of the workspace.
Eigen::Vector3d beyond_side(const scene::WorkspaceBox& box, double far, Random& random) {
  Eigen::Vector3d p_W = box.middle();
  const auto axis = static_cast<Eigen::Index>(random.bits() % 3);
  const bool up = random.bits() % 2 == 0;
  p_W[axis] = up ? box.max_W[axis] + far : box.min_W[axis] - far;
  return p_W;
}

std::vector<Trouble> troubles() {
  const auto simulated = [](Case & one) -> auto& {
    return one.arm.file.simulated;
  };
  return {
      {"nothing", [](Case&, Random&) {}},
      {"a hand that holds", take_in_hand},
      {"a hand that carries the tip away",
       [](Case& one, Random& random) {
         take_in_hand(one, random);
         const double start = random.uniform(0.2, 4), ms = random.uniform(0.1, 1);
         const Eigen::Vector3d from = one.hand_W.front().second;
         const Eigen::Vector3d to = beyond_side(one.arm.file.workspace, 0.02, random);
         one.hand_W.emplace_back(start, from);
         one.hand_W.emplace_back(start + ms, to);
         one.hand_W.emplace_back(start + 2 * ms, from);
       }},
      {"a tip near a side of the workspace",
       [](Case& one, Random& random) {
         const double inside = random.uniform(0.0005, 0.006);
         one.hand_W.front().second = beyond_side(one.arm.file.workspace, -inside, random);
       }},
      {"a tip outside the workspace",
       [](Case& one, Random& random) {
         const double far = random.uniform(0.001, 0.01);
         one.hand_W.front().second = beyond_side(one.arm.file.workspace, far, random);
       }},
      {"a weight or a string that pulls",
       [&](Case& one, Random& random) {
         const double pull = random.uniform(0.05, 8);
         simulated(one).weight_B = pull * random.direction();
       }},
      {"motors three times as strong as the file says",
       [&](Case& one, Random&) { simulated(one).firmware.wiring.motor_gain *= 3; }},
      {"a motor turned round",
       [&](Case& one, Random& random) {
         const auto motor = static_cast<Eigen::Index>(random.bits() % 3);
         simulated(one).firmware.wiring.motor_gain[motor] *= -1;
       }},
      {"all motors turned round",
       [&](Case& one, Random&) { simulated(one).firmware.wiring.motor_gain *= -1; }},
      {"two motors swapped",
       [&](Case& one, Random& random) {
         auto& motors = simulated(one).firmware.wiring.motor_of;
         std::swap(motors[random.bits() % 2], motors[2]);
       }},
      {"a dead encoder",
       [&](Case& one, Random& random) {
         const auto encoder = static_cast<Eigen::Index>(random.bits() % 3);
         simulated(one).firmware.wiring.encoder_gain[encoder] = 0;
       }},
      {"an encoder turned round",
       [&](Case& one, Random& random) {
         const auto encoder = static_cast<Eigen::Index>(random.bits() % 3);
         simulated(one).firmware.wiring.encoder_gain[encoder] = -1;
       }},
      {"encoders that miss edges",
       [&](Case& one, Random& random) {
         simulated(one).firmware.missed_edges = random.uniform(0.001, 0.05);
       }},
      {"reports and messages that are lost or late",
       [&](Case& one, Random& random) {
         simulated(one).wire.loss = random.uniform(0, 0.3);
         simulated(one).wire.jitter_ns = static_cast<std::int64_t>(random.uniform(0, 3e6));
       }},
      {"cogging, lag and play",
       [&](Case& one, Random& random) {
         auto& train = simulated(one).drive_train;
         train.cogging.setConstant(random.uniform(0, 0.005));
         train.periods_per_turn = 7;
         train.current_lag = random.uniform(0, 2e-3);
         train.stiffness.setConstant(random.uniform(20, 2000));
         train.inertia.setConstant(random.uniform(1e-5, 5e-4));
         train.play.setConstant(random.uniform(0, 0.01));
       }},
  };
}

/// Observations of one arm.
struct Seen {
  bool whole = false;  ///< It moved until the end, with and without the known mass.
  bool outside = false;
  double asked = 0, sent = 0;  ///< Max. requested and sent force, N.
  double asked_outside = 0, sent_outside = 0;
  std::string said;
};

Seen watched(const Case& one, std::uint64_t seed) {
  Seen seen;
  const scene::ArmFile& file = one.arm.file;
  // Once outside, it counts as outside until the arm is opened again.
  bool out = false;
  const auto watch = [&](const driver::TickRecord& tick) {
    const Eigen::Vector3d wanted(tick.f_wanted_W.data()), sent(tick.f_sent_W.data());
    out = out || !file.workspace.holds(Eigen::Vector3d(tick.p_WT.data()));
    seen.outside = seen.outside || out;
    // Written so that NaN is more than any limit.
    if (!(wanted.norm() <= seen.asked)) seen.asked = wanted.norm();
    if (!(sent.norm() <= seen.sent)) seen.sent = sent.norm();
    if (!out) return;
    if (!(wanted.norm() <= seen.asked_outside)) seen.asked_outside = wanted.norm();
    if (!(sent.norm() <= seen.sent_outside)) seen.sent_outside = sent.norm();
  };
  const std::atomic<bool> never{false};
  // All forces of an identification except the pushes for the watchdog (identify_link_test).
  for (const bool loaded : {false, true}) {
    out = false;
    scene::ArmFile bench_file = file;
    if (loaded) {
      // Fixed to the tip as by simulated_bench, without a supporting hand.
      bench_file.simulated.hand.mass += support::kKnownMass;
      bench_file.simulated.weight_B +=
          file.R_WB.transpose() * Eigen::Vector3d(0, 0, -scene::kGravity * support::kKnownMass);
      bench_file.limits.soft_start = driver::GateLimits::kSoftStartMin;
    }
    auto bench = BenchArm::open(bench_file, {}, {}, one.hand_W, kIdentifyForceMax);
    if (!bench) {
      seen.said = bench.error().message;
      break;
    }
    (*bench)->watch(watch);
    const auto motion = record_motion(**bench, file,
                                      {.seconds = long_form() ? 20.0 : 3.0,
                                       .lead = 0.5,
                                       .added_mass = loaded ? support::kKnownMass : 0,
                                       .seed = seed},
                                      never);
    EXPECT_TRUE((*bench)->device().zero_assured() || !motion);
    seen.whole = motion.ok();
    seen.said = motion ? "" : motion.error().message;
    if (!motion) break;
  }
  return seen;
}

TEST(IdentifyBounds, HoldForAnyArmHandAndFault) {
  const int arms = long_form() ? 40 : 2;
  for (const Trouble& trouble : troubles()) {
    SCOPED_TRACE(trouble.name);
    int whole = 0, outside = 0;
    double most = 0;
    for (int k = 0; k < arms; ++k) {
      const auto seed = static_cast<std::uint64_t>(9000 + k);
      SCOPED_TRACE(seed);
      Random random(seed);
      Case one{hidden_arm(seed), {{0, {0, 0, 0}}}};
      one.arm.file.simulated.hand = {};
      one.hand_W.front().second = one.arm.file.workspace.middle();
      trouble.bring(one, random);
      const Seen seen = watched(one, seed);
      EXPECT_LE(seen.asked, kIdentifyForceMax);
      EXPECT_LE(seen.sent, kIdentifyForceMax);
      EXPECT_EQ(seen.asked_outside, 0);
      EXPECT_EQ(seen.sent_outside, 0);
      // Leaving the workspace is an error, without a result.
      EXPECT_FALSE(seen.outside && seen.whole);
      EXPECT_EQ(seen.whole, seen.said.empty());
      whole += seen.whole ? 1 : 0;
      outside += seen.outside ? 1 : 0;
      most = std::max(most, seen.asked);
    }
    char result[120];
    std::snprintf(result, sizeof result,
                  "kept: %.2f N at most; %d of %d arms moved to the end, %d were outside", most,
                  whole, arms, outside);
    std::printf("%-48s %s\n", trouble.name.c_str(), result);
    support::record_fault(trouble.name, "hidden arms", "identify",
                          "1 N at most, none outside the workspace", result, "");
  }
}

}  // namespace
}  // namespace thimble::bringup
