// Forces and torques of HDAPI's frames: read back, sent to the arm, and kept between frames.
#include "compat/hd_frames.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

namespace thimble::compat {
namespace {

using Vector = std::array<double, 3>;

constexpr Vector kNone{0, 0, 0};
constexpr Vector kForce{0.2, 0, 0};  // N, to the right: y of our world
constexpr HDenum kCommands[] = {HD_CURRENT_FORCE, HD_CURRENT_TORQUE, HD_CURRENT_JOINT_TORQUE,
                                HD_CURRENT_GIMBAL_TORQUE};

/// An open arm whose ticks wait for the program.
struct CompatHdFrames : HdTest {
  CompatHdFrames() {
    hdInitDevice(nullptr);
    hdEnable(HD_FORCE_OUTPUT);
  }
  /// Returns the program's force to the right in the newest tick, N.
  static double sent() {
    ArmReading reading;
    arms::read(0, reading);
    return reading.f_client_W[1];
  }
  static void push() { hdSetDoublev(HD_CURRENT_FORCE, kForce.data()); }
  /// Passes the soft start.
  static void open_force() { hd_frames(0, 500, push); }

  ExecRig rig{in_step()};
};

TEST_F(CompatHdFrames, CommandsAreZeroUntilTheyAreSetInTheFrame) {
  for (const HDenum parameter : kCommands) {
    hd_frames(0, 3, [&] {
      EXPECT_EQ(hd_vector(parameter), kNone) << std::hex << parameter;
      hdSetDoublev(parameter, kForce.data());
      EXPECT_NEAR(hd_vector(parameter)[0], kForce[0], 1e-9) << std::hex << parameter;
    });
  }
}

TEST_F(CompatHdFrames, ClientThatAddsToItsForceDoesNotAccumulateIt) {
  double most = 0;
  hd_frames(0, 100, [&] {
    Vector f = hd_vector(HD_CURRENT_FORCE);
    f[0] += 0.01;
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
    most = std::max(most, sent());
  });
  EXPECT_LE(most, 0.01);
  EXPECT_GT(most, 0);
}

TEST_F(CompatHdFrames, FrameWithoutACommandSendsNoForce) {
  open_force();
  ASSERT_NEAR(sent(), kForce[0], 1e-9);
  hd_frames(0, 1, [] {});
  EXPECT_EQ(sent(), 0);
  EXPECT_EQ(hd_vector(HD_CURRENT_FORCE), kNone);
}

TEST_F(CompatHdFrames, ForceStaysBetweenFramesUntilItIsStale) {
  open_force();
  ExecRig::wait(0, 10);
  EXPECT_NEAR(sent(), kForce[0], 1e-9);
  EXPECT_EQ(hd_vector(HD_CURRENT_FORCE), kForce) << "outside of a frame";
  ExecRig::wait(0, 20);  // longer than the gate's stall
  EXPECT_EQ(sent(), 0);
}

TEST_F(CompatHdFrames, SecondFrameOfATickKeepsTheForce) {
  open_force();
  for (int i = 0; i < 5; ++i) {
    hdBeginFrame(0);
    push();
    hdEndFrame(0);
    hdBeginFrame(0);
    EXPECT_EQ(hd_vector(HD_CURRENT_FORCE), kNone);
    hdEndFrame(0);
    EXPECT_EQ(hd_vector(HD_CURRENT_FORCE), kForce);
    arms::wait_until_taken(0);
    EXPECT_NEAR(sent(), kForce[0], 1e-9);
  }
}

TEST_F(CompatHdFrames, SecondFrameOfATickReplacesTheForce) {
  open_force();
  const Vector other{0.1, 0, 0};
  hdBeginFrame(0);
  push();
  hdEndFrame(0);
  hdBeginFrame(0);
  hdSetDoublev(HD_CURRENT_FORCE, other.data());
  hdEndFrame(0);
  arms::wait_until_taken(0);
  EXPECT_NEAR(sent(), other[0], 1e-9);
}

TEST_F(CompatHdFrames, CallbackThatOnlyReadsKeepsTheForce) {
  struct Seen {
    double in_frame = 7;  // the read command, N
    std::atomic<int> frames{0};
    double least = 7;  // the smallest force sent after the soft start, N
  } seen;
  const HDSchedulerHandle writes = hdScheduleAsynchronous(
      [](void*) -> HDCallbackCode {
        hdBeginFrame(0);
        push();
        hdEndFrame(0);
        return HD_CALLBACK_CONTINUE;
      },
      nullptr, HD_MAX_SCHEDULER_PRIORITY);
  const HDSchedulerHandle reads = hdScheduleAsynchronous(
      [](void* data) -> HDCallbackCode {
        Seen& all = *static_cast<Seen*>(data);
        hdBeginFrame(0);
        all.in_frame = hd_vector(HD_CURRENT_FORCE)[0];
        hdEndFrame(0);
        if (++all.frames > 600) all.least = std::min(all.least, sent());
        return HD_CALLBACK_CONTINUE;
      },
      &seen, HD_MIN_SCHEDULER_PRIORITY);
  hdStartScheduler();
  // Only the scheduler lets the time advance.
  while (seen.frames < 700 && arms::is_running(0)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  hdStopScheduler();
  hdUnschedule(writes);
  hdUnschedule(reads);
  EXPECT_EQ(seen.in_frame, 0);
  EXPECT_NEAR(seen.least, kForce[0], 1e-9);
}

TEST_F(CompatHdFrames, FrameCannotBeEndedByAnotherThread) {
  open_force();
  hdBeginFrame(0);
  std::thread([] { hdEndFrame(0); }).join();
  EXPECT_EQ(hdGetError().errorCode, HD_ILLEGAL_END);
  push();
  EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS) << "the frame is still open";
  hdEndFrame(0);
  arms::wait_until_taken(0);
  EXPECT_NEAR(sent(), kForce[0], 1e-9);
}

TEST_F(CompatHdFrames, DisabledOutputForgetsTheForce) {
  open_force();
  hdDisable(HD_FORCE_OUTPUT);
  EXPECT_EQ(hd_vector(HD_CURRENT_FORCE), kNone);
  hdEnable(HD_FORCE_OUTPUT);
  ExecRig::wait(0, 5);
  EXPECT_EQ(sent(), 0);
}

TEST_F(CompatHdFrames, OneFrameLimitCountsTheRunOfTheScheduler) {
  hdEnable(HD_ONE_FRAME_LIMIT);
  int frames = 0;
  const auto two_frames = [](void* data) -> HDCallbackCode {
    for (int i = 0; i < 2; ++i) {
      hdBeginFrame(0);
      if (hdGetError().errorCode == HD_SUCCESS) {
        ++*static_cast<int*>(data);
        hdEndFrame(0);
      }
      ExecRig::wait(0, 1);  // the next tick of the arm, in the same run
    }
    return HD_CALLBACK_DONE;
  };
  hdStartScheduler();
  hdScheduleSynchronous(two_frames, &frames, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStopScheduler();
  EXPECT_EQ(frames, 1);
}

TEST(CompatHdNestedFrames, TwoArmsHaveTheirOwnForces) {
  ExecOptions options = in_step();
  options.arms = {{.arm_file = "vintage_phantom"}, {.arm_file = "falcon"}};
  ExecRig rig(options);
  ASSERT_EQ(hdInitDevice("vintage_phantom"), 0u);
  hdEnable(HD_FORCE_OUTPUT);
  ASSERT_EQ(hdInitDevice("falcon"), 1u);
  hdEnable(HD_FORCE_OUTPUT);
  const Vector left{0.1, 0, 0}, right{0, 0.3, 0};
  for (int i = 0; i < 500; ++i) {
    hdBeginFrame(0);
    hdBeginFrame(1);
    EXPECT_EQ(hd_vector(HD_CURRENT_FORCE), kNone);
    hdSetDoublev(HD_CURRENT_FORCE, right.data());
    hdMakeCurrentDevice(0);
    EXPECT_EQ(hd_vector(HD_CURRENT_FORCE), kNone);
    hdSetDoublev(HD_CURRENT_FORCE, left.data());
    hdEndFrame(1);
    hdEndFrame(0);
    arms::wait_until_taken(0);
    arms::wait_until_taken(1);
  }
  ArmReading one, two;
  arms::read(0, one);
  arms::read(1, two);
  EXPECT_NEAR(one.f_client_W[1], 0.1, 1e-9);
  EXPECT_NEAR(two.f_client_W[2], 0.3, 1e-9);
  EXPECT_NEAR(two.f_client_W[1], 0, 1e-9);
  hdDisableDevice(0);
  hdDisableDevice(1);
  EXPECT_EQ(drain_hd_errors().errorCode, HD_SUCCESS);
}

}  // namespace
}  // namespace thimble::compat
