// Every function of HDAPI with every wrong argument and in any order returns an error, and never
// crashes.
#include <HD/hd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <thread>
#include <vector>

#include "compat/exec_rig.h"
#include "compat/hd/hd_parameters.h"
#include "support/seed.h"

namespace thimble::compat {
namespace {

void clear_errors() {
  while (HD_DEVICE_ERROR(hdGetError())) {
  }
}

/// Returns the error of a call; HD_SUCCESS if there was none.
template <class Call>
HDerror error_of(Call call) {
  clear_errors();
  call();
  return hdGetError().errorCode;
}

HDCallbackCode done(void*) {
  return HD_CALLBACK_DONE;
}

struct CompatHdWrongCalls : ::testing::Test {
  ~CompatHdWrongCalls() override {
    hdStopScheduler();
    for (HHD device = 0; device < kArmsMax; ++device) hdDisableDevice(device);
    clear_errors();
  }
  ExecRig rig;
  std::array<double, 64> d{};
  std::array<float, 64> f{};
  std::array<int, 64> i{};
  std::array<long, 64> l{};
  std::array<HDboolean, 64> b{};
};

TEST_F(CompatHdWrongCalls, ReturnBadHandleWithoutAnOpenArm) {
  const HDenum force = HD_CURRENT_FORCE;
  const std::vector<std::function<void()>> calls{
      [&] { hdGetDoublev(force, d.data()); },
      [&] { hdGetFloatv(force, f.data()); },
      [&] { hdGetIntegerv(force, i.data()); },
      [&] { hdGetLongv(force, l.data()); },
      [&] { hdGetBooleanv(force, b.data()); },
      [&] { hdSetDoublev(force, d.data()); },
      [&] { hdSetFloatv(force, f.data()); },
      [&] { hdSetIntegerv(force, i.data()); },
      [&] { hdSetLongv(force, l.data()); },
      [&] { hdSetBooleanv(force, b.data()); },
      [] { EXPECT_STREQ(hdGetString(HD_DEVICE_MODEL_TYPE), ""); },
      [] { hdEnable(HD_FORCE_OUTPUT); },
      [] { hdDisable(HD_FORCE_OUTPUT); },
      [] { EXPECT_EQ(hdIsEnabled(HD_FORCE_OUTPUT), HD_FALSE); },
      [] { hdBeginFrame(0); },
      [] { hdEndFrame(0); },
      [] { hdMakeCurrentDevice(0); },
      [] { hdDisableDevice(0); },
      [] { EXPECT_EQ(hdCheckCalibration(), HD_CALIBRATION_NEEDS_UPDATE); },
      [] { hdUpdateCalibration(HD_CALIBRATION_AUTO); },
      [] { hdUpdateCalibrationMessage(HD_CALIBRATION_AUTO); },
      [&] { hdScaleGimbalAngles(1, 1, 1, d.data()); }};
  for (std::size_t k = 0; k < calls.size(); ++k) {
    EXPECT_EQ(error_of(calls[k]), HD_BAD_HANDLE) << "call " << k;
  }
}

TEST_F(CompatHdWrongCalls, ReturnInvalidValueForNullPointers) {
  ASSERT_EQ(hdInitDevice(nullptr), 0u);
  const HDenum force = HD_CURRENT_FORCE;
  const std::vector<std::function<void()>> calls{
      [&] { hdGetDoublev(force, nullptr); },
      [&] { hdGetFloatv(force, nullptr); },
      [&] { hdGetIntegerv(force, nullptr); },
      [&] { hdGetLongv(force, nullptr); },
      [&] { hdGetBooleanv(force, nullptr); },
      [&] { hdSetDoublev(force, nullptr); },
      [&] { hdSetFloatv(force, nullptr); },
      [&] { hdSetIntegerv(force, nullptr); },
      [&] { hdSetLongv(force, nullptr); },
      [&] { hdSetBooleanv(force, nullptr); },
      [] { hdScaleGimbalAngles(1, 1, 1, nullptr); },
      [] { EXPECT_EQ(hdScheduleAsynchronous(nullptr, nullptr, 1), 0u); },
      [] { hdScheduleSynchronous(nullptr, nullptr, 1); },
      [] { hdUnschedule(0); },
      [] { hdUnschedule(~0ul); },
      [] { hdSetSchedulerRate(0); },
      [] { hdUpdateCalibration(0xffff); }};
  for (std::size_t k = 0; k < calls.size(); ++k) {
    EXPECT_EQ(error_of(calls[k]), HD_INVALID_VALUE) << "call " << k;
  }
  EXPECT_EQ(error_of([] { hdDeploymentLicense(nullptr, "a", "b"); }), HD_INVALID_LICENSE);
  EXPECT_EQ(hdDeploymentLicense("a", "b", "c"), HD_TRUE);
}

TEST_F(CompatHdWrongCalls, ReturnInvalidEnumForUnknownConstants) {
  ASSERT_EQ(hdInitDevice(nullptr), 0u);
  for (const HDenum number : {0u, 1u, 0x1fffu, 0x2fffu, 0x4005u, HD_INVALID_HANDLE}) {
    EXPECT_EQ(error_of([&] { hdGetDoublev(number, d.data()); }), HD_INVALID_ENUM) << number;
    EXPECT_EQ(error_of([&] { hdSetDoublev(number, d.data()); }), HD_INVALID_ENUM) << number;
    EXPECT_EQ(error_of([&] { hdGetString(number); }), HD_INVALID_ENUM) << number;
    EXPECT_EQ(error_of([&] { hdEnable(number); }), HD_INVALID_ENUM) << number;
    EXPECT_EQ(error_of([&] { hdDisable(number); }), HD_INVALID_ENUM) << number;
    EXPECT_EQ(error_of([&] { hdIsEnabled(number); }), HD_INVALID_ENUM) << number;
  }
  EXPECT_EQ(error_of([&] { hdGetDoublev(HD_VERSION, d.data()); }), HD_INVALID_INPUT_TYPE);
  EXPECT_EQ(error_of([&] { hdGetString(HD_CURRENT_FORCE); }), HD_INVALID_INPUT_TYPE);
  EXPECT_EQ(error_of([&] { hdSetDoublev(HD_CURRENT_POSITION, d.data()); }), HD_INVALID_ENUM);
}

TEST_F(CompatHdWrongCalls, CannotBypassTheGate) {
  ASSERT_EQ(hdInitDevice(nullptr), 0u);
  hdEnable(HD_FORCE_OUTPUT);
  for (long& value : l) value = 30'000;
  for (int k = 0; k < 20; ++k) {
    hdBeginFrame(0);
    EXPECT_EQ(error_of([&] { hdSetLongv(HD_CURRENT_MOTOR_DAC_VALUES, l.data()); }),
              HD_INVALID_OPERATION);
    hdEndFrame(0);
    ExecRig::wait(0, 1);
  }
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
}

TEST_F(CompatHdWrongCalls, WriteOnlyTheValuesOfTheParameter) {
  ASSERT_EQ(hdInitDevice(nullptr), 0u);
  for (const hd::Parameter& parameter : hd::parameters()) {
    d.fill(1e300);
    i.fill(-77);
    hdGetDoublev(parameter.number, d.data());
    hdGetIntegerv(parameter.number, i.data());
    for (std::size_t k = 0; k < d.size(); ++k) {
      EXPECT_EQ(d[k] == 1e300, k >= parameter.count) << std::hex << parameter.number << " " << k;
      if (k >= parameter.count) {
        EXPECT_EQ(i[k], -77) << std::hex << parameter.number;
      }
    }
    EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS) << std::hex << parameter.number;
  }
}

TEST_F(CompatHdWrongCalls, EveryErrorHasAText) {
  for (HDerror error = 0; error < 0x700; ++error) {
    ASSERT_NE(hdGetErrorString(error), nullptr);
    EXPECT_GT(std::string(hdGetErrorString(error)).size(), 5u);
  }
}

/// Calls a random function with random arguments.
void any_call(std::mt19937& random, std::vector<HDSchedulerHandle>& handles) {
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  const auto number = [&]() -> HDenum {
    const auto all = hd::parameters();
    if (below(8) == 0) return static_cast<HDenum>(random());
    return all[below(static_cast<std::uint32_t>(all.size()))].number;
  };
  const auto handle = [&]() -> HHD {
    return below(6) == 0 ? static_cast<HHD>(random()) : below(3);
  };
  std::array<double, 36> d;
  for (double& value : d) {
    switch (below(6)) {
      case 0:
        value = std::nan("");
        break;
      case 1:
        value = 1e308;
        break;
      default:
        value = (static_cast<double>(below(2001)) - 1000) * 1e-3;
    }
  }
  std::array<float, 36> f{};
  std::array<int, 36> i{};
  std::array<long, 36> l{};
  std::array<HDboolean, 36> b{};
  const HDenum capability = HD_FORCE_OUTPUT + below(6);
  switch (below(34)) {
    case 0:
      hdInitDevice(below(2) == 0 ? nullptr : "Phantom2");
      break;
    case 1:
      if (below(4) == 0) hdDisableDevice(handle());
      break;
    case 2:
      hdMakeCurrentDevice(handle());
      break;
    case 3:
      hdGetCurrentDevice();
      break;
    case 4:
    case 5:
      hdBeginFrame(handle());
      break;
    case 6:
    case 7:
      hdEndFrame(handle());
      break;
    case 8:
      hdEnable(capability);
      break;
    case 9:
      hdDisable(capability);
      break;
    case 10:
      hdIsEnabled(capability);
      break;
    case 11:
      hdGetDoublev(number(), d.data());
      break;
    case 12:
      hdGetFloatv(number(), f.data());
      break;
    case 13:
      hdGetIntegerv(number(), i.data());
      break;
    case 14:
      hdGetLongv(number(), l.data());
      break;
    case 15:
      hdGetBooleanv(number(), b.data());
      break;
    case 16:
    case 17:
      hdSetDoublev(below(2) == 0 ? HD_CURRENT_FORCE : number(), d.data());
      break;
    case 18:
      hdSetFloatv(number(), f.data());
      break;
    case 19:
      hdSetIntegerv(number(), i.data());
      break;
    case 20:
      hdSetLongv(number(), l.data());
      break;
    case 21:
      hdSetBooleanv(number(), b.data());
      break;
    case 22:
      hdGetString(below(2) == 0 ? HD_VERSION : number());
      break;
    case 23:
      hdGetError();
      break;
    case 24:
      hdGetErrorString(static_cast<HDerror>(random()));
      break;
    case 25:
      hdCheckCalibration();
      break;
    case 26:
      hdUpdateCalibration(below(10));
      break;
    case 27:
      hdStartScheduler();
      break;
    case 28:
      if (below(4) == 0) hdStopScheduler();
      break;
    case 29:
      hdSetSchedulerRate(below(3) == 0 ? random() : 500);
      break;
    case 30:
      if (handles.size() < 20) {
        handles.push_back(hdScheduleAsynchronous(done, nullptr, static_cast<HDushort>(random())));
      }
      break;
    case 31:
      hdScheduleSynchronous(done, nullptr, static_cast<HDushort>(random()));
      break;
    case 32:
      if (!handles.empty() && below(2) == 0) {
        hdUnschedule(handles.back());
        handles.pop_back();
      } else {
        hdUnschedule(random());
      }
      break;
    default:
      hdWaitForCompletion(random(), HD_WAIT_CHECK_STATUS);
      hdGetSchedulerTimeStamp();
      hdScaleGimbalAngles(1, 1, 1, below(2) == 0 ? nullptr : d.data());
  }
}

TEST(CompatHdFuzz, SurvivesAnyCallsFromSeveralThreads) {
  ExecRig rig({.arms = {{.arm_file = "vintage_phantom"}, {.arm_file = "polhem"}}});
  constexpr int kCalls = 3000;
  constexpr unsigned kThreads = 3;
  std::vector<std::thread> threads;
  std::atomic<int> calls{0};
  for (unsigned t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      std::mt19937 random(static_cast<std::uint32_t>(support::seed_of(t + 1)));
      std::vector<HDSchedulerHandle> handles;
      for (int k = 0; k < kCalls; ++k) {
        any_call(random, handles);
        ++calls;
      }
      for (const HDSchedulerHandle handle : handles) hdUnschedule(handle);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(calls.load(), kCalls * static_cast<int>(kThreads));
  hdStopScheduler();
  for (HHD device = 0; device < kArmsMax; ++device) hdDisableDevice(device);
  clear_errors();
  // The library is still usable.
  ASSERT_EQ(hdInitDevice(nullptr), 0u);
  hdEnable(HD_FORCE_OUTPUT);
  const std::array<double, 3> f{0, 0.1, 0};
  for (int k = 0; k < 450; ++k) {
    hdBeginFrame(0);
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
    hdEndFrame(0);
    arms::wait_until_taken(0);
  }
  EXPECT_NEAR(rig.motors.force_W().z(), 0.1, 0.005);
  hdDisableDevice(0);
  clear_errors();
}

}  // namespace
}  // namespace thimble::compat
