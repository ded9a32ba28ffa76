// The scheduler of HDAPI: order of callbacks, their end, threads, and callbacks that hang.
#include <HD/hd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>
#include <vector>

#include "compat/exec_rig.h"

namespace thimble::compat {
namespace {

using namespace std::chrono_literals;

struct CompatHdScheduler : ::testing::Test {
  CompatHdScheduler() {
    while (HD_DEVICE_ERROR(hdGetError())) {
    }
  }
  ~CompatHdScheduler() override {
    hdStopScheduler();
    for (const HDSchedulerHandle handle : scheduled) hdUnschedule(handle);
    for (HHD device = 0; device < kArmsMax; ++device) hdDisableDevice(device);
    hdSetSchedulerRate(1000);
    while (HD_DEVICE_ERROR(hdGetError())) {
    }
  }
  void schedule(HDSchedulerCallback callback, void* data, HDushort priority) {
    scheduled.push_back(hdScheduleAsynchronous(callback, data, priority));
    EXPECT_NE(scheduled.back(), 0u);
  }

  ExecRig rig;
  std::vector<HDSchedulerHandle> scheduled;
};

struct Order {
  std::mutex mutex;
  std::vector<int> calls;
  void add(int who) {
    const std::lock_guard lock(mutex);
    calls.push_back(who);
  }
};
template <int Who>
HDCallbackCode note(void* data) {
  static_cast<Order*>(data)->add(Who);
  return HD_CALLBACK_CONTINUE;
}

TEST_F(CompatHdScheduler, RunsTheHighestPriorityFirstInEachTick) {
  hdInitDevice(nullptr);
  Order order;
  schedule(note<3>, &order, HD_MIN_SCHEDULER_PRIORITY);
  schedule(note<1>, &order, HD_MAX_SCHEDULER_PRIORITY);
  schedule(note<2>, &order, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  ExecRig::wait(0, 500);  // on a busy machine some ticks have no callbacks
  hdStopScheduler();
  ASSERT_GE(order.calls.size(), 90u);
  for (std::size_t i = 0; i < order.calls.size(); ++i) {
    EXPECT_EQ(order.calls[i], static_cast<int>(i % 3) + 1) << i;
  }
}

TEST_F(CompatHdScheduler, FrameMaySpanTwoCallbacks) {
  ASSERT_EQ(hdInitDevice(nullptr), 0u);
  hdEnable(HD_FORCE_OUTPUT);
  schedule(
      [](void*) -> HDCallbackCode {
        hdBeginFrame(0);
        return HD_CALLBACK_CONTINUE;
      },
      nullptr, HD_MAX_SCHEDULER_PRIORITY);
  schedule(
      [](void*) -> HDCallbackCode {
        const std::array<double, 3> f{0, 0.2, 0};
        hdSetDoublev(HD_CURRENT_FORCE, f.data());
        hdEndFrame(0);
        return HD_CALLBACK_CONTINUE;
      },
      nullptr, HD_MIN_SCHEDULER_PRIORITY);
  hdStartScheduler();
  ExecRig::wait(0, 500);
  EXPECT_NEAR(rig.motors.force_W().z(), 0.2, 0.005);
  hdStopScheduler();
  EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS);
  ExecRig::wait(0, 5);
  EXPECT_EQ(rig.motors.force_W().norm(), 0) << "a stopped scheduler leaves no force";
}

TEST_F(CompatHdScheduler, EndsAnOpenFrameAfterTheCallbacks) {
  hdInitDevice(nullptr);
  schedule(
      [](void*) -> HDCallbackCode {
        hdBeginFrame(0);
        return HD_CALLBACK_DONE;
      },
      nullptr, 5);
  hdStartScheduler();
  ExecRig::wait(0, 20);
  EXPECT_EQ(hdGetError().errorCode, HD_FRAME_ERROR);
  hdBeginFrame(0);
  hdEndFrame(0);
  EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS);
  scheduled.clear();
}

TEST_F(CompatHdScheduler, RunsAFinishedCallbackOnce) {
  hdInitDevice(nullptr);
  std::atomic<int> calls{0};
  const HDSchedulerHandle handle = hdScheduleAsynchronous(
      [](void* data) -> HDCallbackCode {
        ++*static_cast<std::atomic<int>*>(data);
        return HD_CALLBACK_DONE;
      },
      &calls, 7);
  EXPECT_EQ(hdWaitForCompletion(handle, HD_WAIT_CHECK_STATUS), HD_TRUE);
  hdStartScheduler();
  EXPECT_EQ(hdWaitForCompletion(handle, HD_WAIT_INFINITE), HD_TRUE);
  EXPECT_EQ(hdWaitForCompletion(handle, HD_WAIT_CHECK_STATUS), HD_FALSE);
  ExecRig::wait(0, 20);
  EXPECT_EQ(calls.load(), 1);
}

TEST_F(CompatHdScheduler, SynchronousCallbackRunsOnSchedulerThread) {
  hdInitDevice(nullptr);
  hdStartScheduler();
  struct Copy {
    std::thread::id thread;
    std::array<double, 3> p{1e9, 0, 0};
    double stamp = -1;
  } copy;
  hdScheduleSynchronous(
      [](void* data) -> HDCallbackCode {
        auto& to = *static_cast<Copy*>(data);
        hdBeginFrame(0);
        hdGetDoublev(HD_CURRENT_POSITION, to.p.data());
        hdEndFrame(0);
        to.thread = std::this_thread::get_id();
        to.stamp = hdGetSchedulerTimeStamp();
        return HD_CALLBACK_DONE;
      },
      &copy, HD_DEFAULT_SCHEDULER_PRIORITY);
  EXPECT_LT(std::abs(copy.p[0]), 5) << "mm";
  EXPECT_NE(copy.thread, std::this_thread::get_id());
  EXPECT_GE(copy.stamp, 0);
  EXPECT_LT(copy.stamp, 0.1);
}

TEST_F(CompatHdScheduler, UnscheduleWaitsForTheCallback) {
  hdInitDevice(nullptr);
  static std::atomic<bool> inside, gone;
  inside = gone = false;
  const HDSchedulerHandle handle = hdScheduleAsynchronous(
      [](void*) -> HDCallbackCode {
        inside = true;
        EXPECT_FALSE(gone.load());
        std::this_thread::sleep_for(20ms);
        inside = false;
        return HD_CALLBACK_CONTINUE;
      },
      nullptr, 1);
  hdStartScheduler();
  while (!inside.load()) std::this_thread::sleep_for(1ms);
  hdUnschedule(handle);
  EXPECT_FALSE(inside.load());
  gone = true;
  ExecRig::wait(0, 50);
  hdUnschedule(handle);
  EXPECT_EQ(hdGetError().errorCode, HD_INVALID_VALUE);
}

TEST_F(CompatHdScheduler, CallbacksMayStopAndStartTheScheduler) {
  hdInitDevice(nullptr);
  static std::atomic<int> calls;
  calls = 0;
  for (int again = 0; again < 3; ++again) {
    const HDSchedulerHandle handle = hdScheduleAsynchronous(
        [](void*) -> HDCallbackCode {
          ++calls;
          hdScheduleSynchronous([](void*) -> HDCallbackCode { return HD_CALLBACK_DONE; }, nullptr,
                                1);
          hdStopScheduler();
          return HD_CALLBACK_CONTINUE;
        },
        nullptr, 1);
    hdStartScheduler();
    for (int i = 0; i < 200 && calls.load() <= again; ++i) std::this_thread::sleep_for(5ms);
    ExecRig::wait(0, 20);
    EXPECT_EQ(calls.load(), again + 1);
    hdUnschedule(handle);
  }
}

TEST_F(CompatHdScheduler, ForceIsZeroAfterACallbackStopsTheScheduler) {
  hdInitDevice(nullptr);
  hdEnable(HD_FORCE_OUTPUT);
  static std::atomic<bool> stop, stopped;
  static std::atomic<int> others;
  stop = stopped = false;
  others = 0;
  const auto push = [] {
    const std::array<double, 3> f{0.3, 0, 0};
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
  };
  schedule(
      [](void*) -> HDCallbackCode {
        hdBeginFrame(0);
        if (stop.load() && !stopped.load()) hdStopScheduler();
        const std::array<double, 3> f{0.3, 0, 0};
        hdSetDoublev(HD_CURRENT_FORCE, f.data());
        hdEndFrame(0);
        if (!stop.load()) return HD_CALLBACK_CONTINUE;
        stopped = true;
        // It continues to request forces, for much longer than the gate's stall.
        for (int tick = 0; tick < 300; ++tick) {
          hdBeginFrame(0);
          hdSetDoublev(HD_CURRENT_FORCE, f.data());
          hdEndFrame(0);
          ExecRig::wait(0, 1);
        }
        stop = false;
        return HD_CALLBACK_CONTINUE;
      },
      nullptr, HD_MAX_SCHEDULER_PRIORITY);
  schedule(
      [](void*) -> HDCallbackCode {
        if (stopped.load()) ++others;
        return HD_CALLBACK_CONTINUE;
      },
      nullptr, HD_MIN_SCHEDULER_PRIORITY);
  hdStartScheduler();
  const auto pushed = [&] { return std::abs(rig.motors.force_W().y() - 0.3) < 0.005; };
  for (int tick = 0; tick < 5000 && !pushed(); ++tick) ExecRig::wait(0, 1);
  ASSERT_TRUE(pushed());
  stop = true;
  while (!stopped.load()) std::this_thread::sleep_for(1ms);
  ExecRig::wait(0, 30);
  double max_force = 0;
  while (stop.load()) {
    max_force = std::max(max_force, rig.motors.force_W().norm());
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(max_force, 0) << "a stopped scheduler leaves no force";
  ExecRig::wait(0, 50);
  EXPECT_EQ(others.load(), 0) << "later callbacks must not run any more";
  // Frames outside of a scheduler still request forces.
  bool pushes = false;
  for (int tick = 0; tick < 5000 && !pushes; ++tick) {
    hdBeginFrame(0);
    push();
    hdEndFrame(0);
    ExecRig::wait(0, 1);
    pushes = std::abs(rig.motors.force_W().y() - 0.3) < 0.005;
  }
  EXPECT_TRUE(pushes);
}

TEST_F(CompatHdScheduler, RunsEverySecondTickAtHalfTheRate) {
  hdInitDevice(nullptr);
  hdSetSchedulerRate(500);
  std::atomic<int> calls{0};
  schedule(
      [](void* data) -> HDCallbackCode {
        ++*static_cast<std::atomic<int>*>(data);
        return HD_CALLBACK_CONTINUE;
      },
      &calls, 1);
  hdStartScheduler();
  ExecRig::wait(0, 100);
  // On a busy machine callbacks are skipped: one undisturbed interval shows the rate, none is
  // faster.
  int max_calls = 0;
  for (int stretch = 0; stretch < 10 && max_calls < 150; ++stretch) {
    const int before = calls.load();
    ExecRig::wait(0, 400);
    max_calls = std::max(max_calls, calls.load() - before);
  }
  hdStopScheduler();
  EXPECT_LE(max_calls, 205);
  EXPECT_GE(max_calls, 150);
  for (const HDulong rate : {0ul, 7ul, 999ul, 1001ul, 100'000ul}) {
    hdSetSchedulerRate(rate);
    EXPECT_EQ(hdGetError().errorCode, HD_INVALID_VALUE) << rate;
  }
}

TEST_F(CompatHdScheduler, ForceOfAHangingCallbackBecomesZero) {
  hdInitDevice(nullptr);
  hdEnable(HD_FORCE_OUTPUT);
  static std::atomic<bool> hang, hangs;
  hang = hangs = false;
  schedule(
      [](void*) -> HDCallbackCode {
        const std::array<double, 3> f{0.3, 0, 0};
        hdBeginFrame(0);
        hdSetDoublev(HD_CURRENT_FORCE, f.data());
        hdEndFrame(0);
        while (hang.load()) {
          hangs = true;
          std::this_thread::sleep_for(1ms);
        }
        return HD_CALLBACK_CONTINUE;
      },
      nullptr, 1);
  hdStartScheduler();
  ExecRig::wait(0, 500);
  ASSERT_NEAR(rig.motors.force_W().y(), 0.3, 0.005);
  hang = true;
  while (!hangs.load()) std::this_thread::sleep_for(1ms);
  ExecRig::wait(0, 30);
  EXPECT_EQ(rig.motors.force_W().norm(), 0) << "the gate's stall is 20 ms";
  hang = false;
  ExecRig::wait(0, 500);
  EXPECT_NEAR(rig.motors.force_W().y(), 0.3, 0.005);
}

TEST_F(CompatHdScheduler, SynchronousCallbackRunsWithoutAScheduler) {
  int calls = 0;
  hdScheduleSynchronous(
      [](void* data) -> HDCallbackCode {
        ++*static_cast<int*>(data);
        return HD_CALLBACK_DONE;
      },
      &calls, 1);
  EXPECT_EQ(calls, 1);
  hdStopScheduler();
}

TEST_F(CompatHdScheduler, RefusesTooManyCallbacks) {
  std::vector<HDSchedulerHandle> handles;
  const auto callback = [](void*) -> HDCallbackCode { return HD_CALLBACK_CONTINUE; };
  for (int i = 0; i < 300; ++i) {
    const HDSchedulerHandle handle = hdScheduleAsynchronous(callback, nullptr, 1);
    if (handle != 0) handles.push_back(handle);
  }
  EXPECT_LT(handles.size(), 300u);
  EXPECT_EQ(hdGetError().errorCode, HD_SCHEDULER_FULL);
  for (const HDSchedulerHandle handle : handles) hdUnschedule(handle);
}

}  // namespace
}  // namespace thimble::compat
