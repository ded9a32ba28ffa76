// Every fault of cable, wiring and host, on every arm, in every phase of a touch. The promise
// (fault_promises.h) is tested at the motors of the simulated arm, not in the driver's state.
// tests/acceptance/FAULTS.md is the table of these measurements.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sim/fault_promises.h"
#include "sim/fault_rig.h"
#include "support/covered.h"
#include "support/fault_cell.h"
#include "support/scratch.h"

namespace thimble::fault_test {
namespace {

constexpr int kBefore = 260;  // ticks: the hand has reached its place, and the soft start is over
constexpr int kAfter = 180;   // ticks after the fault in which the motors are observed

/// Returns the watchdog time of an arm's board, ms: mbed boards 500 [S woody-experimental main.cpp,
/// haptikfabrikenapi firmware/main.cpp], boards with text lines 100.
int watchdog_of(const TestedArm& arm) {
  return arm.name == "woodenhaptics" || arm.name == "polhem" ? 500 : 100;
}

/// Observations of one cell of the table.
struct Seen {
  std::int64_t off_after = 0;  ///< ms until the motors permanently had no current; -1: never
  driver::Fault cause = driver::Fault::kNone;
  bool named_late = false;    ///< the driver sent a force after it had reported a cause
  bool zero_reported = true;  ///< at the end: the driver knows whether the arm accepted zero force
};

device_sim::WiringSettings wiring_of(const TestedFault& fault) {
  device_sim::WiringSettings wiring;
  if (fault.name == "dead encoder") wiring.encoder_gain[1] = 0;
  if (fault.name == "encoder turned round") wiring.encoder_gain[1] = -1;
  if (fault.name == "dead motor") wiring.motor_gain[1] = 0;
  if (fault.name == "motor turned round") wiring.motor_gain[1] = -1;
  if (fault.name == "two motors swapped") wiring.motor_of = {0, 2, 1};
  if (fault.name == "all motors turned round") wiring.motor_gain = {-1, -1, -1};
  return wiring;
}

std::string in_words(const Promised& promised) {
  switch (promised.promise) {
    case Promise::kOff:
      return "off: " + std::string(name(promised.cause));
    case Promise::kArmOff:
      return "the arm switches off" + (promised.cause == driver::Fault::kNone
                                           ? ""
                                           : ": " + std::string(name(promised.cause)));
    case Promise::kNotKnown:
      return promised.cause == driver::Fault::kNone
                 ? "not known; nothing is promised"
                 : "named: " + std::string(name(promised.cause)) +
                       "; motors not known, nothing is promised";
    case Promise::kBound:
      break;
  }
  return "within the limit";
}

void note(const TestedFault& fault, const TestedArm& arm, Phase phase, const Promised& promised,
          const std::string& measured) {
  support::record_fault(std::string(fault.name), std::string(arm.name),
                        std::string(kPhaseNames[static_cast<std::size_t>(phase)]),
                        in_words(promised), measured,
                        promised.ticks > 0 ? std::to_string(promised.ticks) : "");
}

/// Triggers the fault and observes the motors.
Seen watch(FaultRig& rig, const TestedFault& fault, int promised_ticks = 0) {
  Seen seen;
  const std::int64_t begin_ns = rig.watch().time_ns();
  const bool dies = fault.name == "host dies", ends = fault.name.ends_with("at the end");
  if (fault.place == Place::kCable) {
    rig.cable().order(*device_sim::usb::parse_fault(fault.order));
  }
  if (fault.name == "host stands still for 50 ms") rig.stall(50'000'000);
  if (fault.name == "host stands still for 150 ms") rig.stall(150'000'000);
  if (fault.name == "computer sleeps for 2 s") rig.sleep(2'000'000'000);
  if (fault.place == Place::kBoard) rig.restart_board(60);
  if (fault.name == "clock steps back 10 ms") rig.step_back(10'000'000);
  if (ends) {
    rig.cable().order(*device_sim::usb::parse_fault(fault.order));
    rig.end();
    seen.zero_reported = rig.device().zero_assured() ? rig.device().f_sent_W().norm() == 0
                                                     : rig.device().fault() != driver::Fault::kNone;
  }
  for (int i = 0; i < std::max(kAfter, promised_ticks + 20); ++i) {
    const bool named = rig.device().fault() != driver::Fault::kNone;
    const Eigen::Vector3d stands_W = rig.device().f_sent_W();
    if (dies || ends) {
      rig.pass_frame();
    } else {
      rig.tick(i == 0 && fault.name == "force law without a number");
      // A force may persist if the arm accepts no message; no new force may be sent.
      const Eigen::Vector3d sent_W = rig.device().f_sent_W();
      seen.named_late |= named && sent_W.norm() != 0 && sent_W != stands_W;
    }
  }
  const std::int64_t last_on_ns = rig.watch().last_on_ns();
  if (last_on_ns > begin_ns) seen.off_after = (last_on_ns - begin_ns) / 1'000'000 + 1;
  if (rig.motors() != 0) seen.off_after = -1;
  seen.cause = rig.device().fault();
  return seen;
}

std::string measured(const Seen& seen) {
  const std::string ticks = seen.off_after < 0 ? "continues" : std::to_string(seen.off_after);
  return seen.cause == driver::Fault::kNone ? ticks : ticks + " " + std::string(name(seen.cause));
}

void check_opening(const TestedFault& fault, const TestedArm& arm) {
  FaultRig rig(arm, Phase::kOpening, wiring_of(fault));
  if (fault.place == Place::kCable) {
    rig.cable().order(*device_sim::usb::parse_fault(fault.order));
  }
  const auto opened = rig.open();
  if (const auto refused = refused_at_opening(fault.name, arm.kind)) {
    EXPECT_EQ(!opened, *refused);
  }
  std::string what = "refused";
  if (!opened) {
    EXPECT_GT(opened.error().message.size(), 20U) << "the error must give a remedy";
  } else {
    const Seen seen = watch(
        rig,
        {fault.name, fault.place == Place::kCable ? Place::kWiring : fault.place, fault.order});
    EXPECT_FALSE(seen.named_late);
    what = "opened, " + measured(seen);
    if (fault.name == "stall out") {
      EXPECT_NE(seen.cause, driver::Fault::kNone) << "the fault existed from the start";
    }
  }
  EXPECT_TRUE(rig.within_limit());
  note(fault, arm, Phase::kOpening, {}, what);
  // After a repair the arm can be opened.
  if (fault.place != Place::kCable) return;
  rig.cable().heal();
  for (int i = 0; i < 5; ++i) rig.pass_frame();
  const auto again = rig.open();
  ASSERT_TRUE(again) << again.error().message;
  for (int i = 0; i < 30; ++i) rig.tick();
  EXPECT_EQ(rig.device().fault(), driver::Fault::kNone) << "after the repair";
}

void check_touch(const TestedFault& fault, const TestedArm& arm, Phase phase) {
  FaultRig rig(arm, phase, wiring_of(fault));
  const auto opened = rig.open();
  ASSERT_TRUE(opened) << opened.error().message;
  const bool recording = phase == Phase::kRecording;
  if (recording) rig.record(support::scratch_folder() / "fault.h5");
  for (int i = 0; i < kBefore; ++i) rig.tick();
  if (fault.place != Place::kWiring) {
    ASSERT_EQ(rig.device().fault(), driver::Fault::kNone);
    ASSERT_EQ(rig.depth() > 0, phase != Phase::kFree) << "wrong phase";
    ASSERT_EQ(rig.motors() > 0, phase != Phase::kFree);
  }
  const Promised promise = promised(fault.name, arm.kind, phase, watchdog_of(arm));
  const Seen seen = watch(rig, fault, promise.ticks);

  EXPECT_TRUE(rig.within_limit());
  EXPECT_FALSE(seen.named_late) << "a force was sent after the cause was reported";
  EXPECT_TRUE(seen.zero_reported) << "the arm did not accept zero force, and this was not reported";
  if (promise.promise == Promise::kOff || promise.promise == Promise::kArmOff) {
    EXPECT_GE(seen.off_after, 0) << "the motors still pull";
    EXPECT_LE(seen.off_after, promise.ticks);
  }
  // In free motion the force is already zero, so a zero message that is not accepted does no harm.
  const bool stands =
      (promise.promise == Promise::kArmOff || promise.promise == Promise::kNotKnown) &&
      fault.name.ends_with("at the end") && phase == Phase::kFree;
  if (promise.cause != driver::Fault::kNone && !stands) {
    EXPECT_EQ(name(seen.cause), name(promise.cause));
  }
  if (fault.place == Place::kBoard) {
    const bool counts_from_elsewhere = arm.kind != driver::ArmKind::kFalcon;
    EXPECT_EQ(rig.device().home_needed(), counts_from_elsewhere);
    EXPECT_EQ(!rig.device().activate(), counts_from_elsewhere);
  }
  if (recording) {
    EXPECT_EQ(rig.recorded(), rig.ticks()) << "ticks are missing from the recording";
  }
  note(fault, arm, phase, promise, measured(seen));
}

class FaultMatrix : public testing::TestWithParam<TestedArm> {};

TEST_P(FaultMatrix, PromisesHoldInEveryPhase) {
  support::Covered("arms").add(GetParam().file);
  for (const TestedFault& fault : kTestedFaults) {
    for (std::size_t phase = 0; phase < kPhaseNames.size(); ++phase) {
      SCOPED_TRACE(std::string(fault.name) + ", " + std::string(kPhaseNames[phase]));
      if (static_cast<Phase>(phase) == Phase::kOpening) {
        check_opening(fault, GetParam());
      } else {
        check_touch(fault, GetParam(), static_cast<Phase>(phase));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, FaultMatrix, testing::ValuesIn(kTestedArms),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

}  // namespace
}  // namespace thimble::fault_test
