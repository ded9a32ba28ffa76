// Every function of HDAPI with every wrong argument returns an error, and never crashes.
#include <HD/hd.h>

#include <array>
#include <functional>
#include <vector>

#include "compat/exec_rig.h"
#include "compat/hd/hd_parameters.h"

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
    const std::size_t count = hd::count_of(parameter, arms::facts(0));
    d.fill(1e300);
    i.fill(-77);
    hdGetDoublev(parameter.number, d.data());
    hdGetIntegerv(parameter.number, i.data());
    for (std::size_t k = 0; k < d.size(); ++k) {
      EXPECT_EQ(d[k] == 1e300, k >= count) << std::hex << parameter.number << " " << k;
      if (k >= count) {
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

}  // namespace
}  // namespace thimble::compat
