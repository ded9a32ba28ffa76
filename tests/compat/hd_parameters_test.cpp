// Every parameter and capability of HDAPI: the number of its values, and how it is answered.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "compat/hd_frames.h"

namespace thimble::compat {
namespace {

/// The documented number of values of each numeric parameter. An arm here has three motors, so its
/// temperatures and motor values are three.
const std::map<HDenum, std::size_t> kCounts{{HD_CURRENT_BUTTONS, 1},
                                            {HD_CURRENT_SAFETY_SWITCH, 1},
                                            {HD_CURRENT_INKWELL_SWITCH, 1},
                                            {HD_CURRENT_ENCODER_VALUES, 6},
                                            {HD_CURRENT_PINCH_VALUE, 1},
                                            {HD_LAST_PINCH_VALUE, 1},
                                            {HD_CURRENT_POSITION, 3},
                                            {HD_CURRENT_VELOCITY, 3},
                                            {HD_CURRENT_TRANSFORM, 16},
                                            {HD_CURRENT_ANGULAR_VELOCITY, 3},
                                            {HD_CURRENT_JACOBIAN, 36},
                                            {HD_CURRENT_JOINT_ANGLES, 3},
                                            {HD_CURRENT_GIMBAL_ANGLES, 3},
                                            {HD_LAST_BUTTONS, 1},
                                            {HD_LAST_SAFETY_SWITCH, 1},
                                            {HD_LAST_INKWELL_SWITCH, 1},
                                            {HD_LAST_ENCODER_VALUES, 6},
                                            {HD_LAST_POSITION, 3},
                                            {HD_LAST_VELOCITY, 3},
                                            {HD_LAST_TRANSFORM, 16},
                                            {HD_LAST_ANGULAR_VELOCITY, 3},
                                            {HD_LAST_JACOBIAN, 36},
                                            {HD_LAST_JOINT_ANGLES, 3},
                                            {HD_LAST_GIMBAL_ANGLES, 3},
                                            {HD_DEVICE_FIRMWARE_VERSION, 1},
                                            {HD_MAX_WORKSPACE_DIMENSIONS, 6},
                                            {HD_USABLE_WORKSPACE_DIMENSIONS, 6},
                                            {HD_TABLETOP_OFFSET, 1},
                                            {HD_INPUT_DOF, 1},
                                            {HD_OUTPUT_DOF, 1},
                                            {HD_CALIBRATION_STYLE, 1},
                                            {HD_UPDATE_RATE, 1},
                                            {HD_INSTANTANEOUS_UPDATE_RATE, 1},
                                            {HD_NOMINAL_MAX_STIFFNESS, 1},
                                            {HD_NOMINAL_MAX_DAMPING, 1},
                                            {HD_NOMINAL_MAX_FORCE, 1},
                                            {HD_NOMINAL_MAX_CONTINUOUS_FORCE, 1},
                                            {HD_MOTOR_TEMPERATURE, 3},
                                            {HD_SOFTWARE_VELOCITY_LIMIT, 1},
                                            {HD_SOFTWARE_FORCE_IMPULSE_LIMIT, 1},
                                            {HD_FORCE_RAMPING_RATE, 1},
                                            {HD_NOMINAL_MAX_TORQUE_STIFFNESS, 1},
                                            {HD_NOMINAL_MAX_TORQUE_DAMPING, 1},
                                            {HD_NOMINAL_MAX_TORQUE_FORCE, 1},
                                            {HD_NOMINAL_MAX_TORQUE_CONTINUOUS_FORCE, 1},
                                            {HD_CURRENT_FORCE, 3},
                                            {HD_CURRENT_TORQUE, 3},
                                            {HD_JOINT_ANGLE_REFERENCES, 3},
                                            {HD_CURRENT_JOINT_TORQUE, 3},
                                            {HD_CURRENT_GIMBAL_TORQUE, 3},
                                            {HD_CURRENT_MOTOR_DAC_VALUES, 3},
                                            {HD_LAST_FORCE, 3},
                                            {HD_LAST_TORQUE, 3},
                                            {HD_LAST_JOINT_TORQUE, 3},
                                            {HD_LAST_GIMBAL_TORQUE, 3},
                                            {HD_LAST_MOTOR_DAC_VALUES, 3},
                                            {HD_USER_STATUS_LIGHT, 1}};

/// The parameters that a program may set; motor values are refused (no force bypasses the gate).
const std::set<HDenum> kWritable{HD_SOFTWARE_VELOCITY_LIMIT, HD_SOFTWARE_FORCE_IMPULSE_LIMIT,
                                 HD_FORCE_RAMPING_RATE,      HD_CURRENT_FORCE,
                                 HD_CURRENT_TORQUE,          HD_JOINT_ANGLE_REFERENCES,
                                 HD_CURRENT_JOINT_TORQUE,    HD_CURRENT_GIMBAL_TORQUE,
                                 HD_USER_STATUS_LIGHT};

constexpr HDenum kCapabilities[] = {HD_FORCE_OUTPUT,
                                    HD_MAX_FORCE_CLAMPING,
                                    HD_FORCE_RAMPING,
                                    HD_SOFTWARE_FORCE_LIMIT,
                                    HD_ONE_FRAME_LIMIT,
                                    HD_SOFTWARE_VELOCITY_LIMIT,
                                    HD_SOFTWARE_FORCE_IMPULSE_LIMIT};

constexpr HDenum kTexts[] = {HD_VERSION, HD_DEVICE_MODEL_TYPE, HD_DEVICE_DRIVER_VERSION,
                             HD_DEVICE_VENDOR, HD_DEVICE_SERIAL_NUMBER};

/// Memory that ends at a page that no code may touch.
class GuardedMemory {
 public:
  GuardedMemory() : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) {
    void* at = mmap(nullptr, 2 * page_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) throw std::runtime_error("no memory");
    bytes_ = static_cast<std::byte*>(at);
    if (mprotect(bytes_ + page_, page_, PROT_NONE) != 0) throw std::runtime_error("no guard");
  }
  ~GuardedMemory() { munmap(bytes_, 2 * page_); }
  GuardedMemory(const GuardedMemory&) = delete;
  GuardedMemory& operator=(const GuardedMemory&) = delete;

  /// Returns memory for `count` numbers, which ends at the guard.
  template <class T>
  T* last(std::size_t count) {
    return reinterpret_cast<T*>(bytes_ + page_ - count * sizeof(T));
  }

 private:
  std::size_t page_;
  std::byte* bytes_ = nullptr;
};

/// Returns how many values a getter writes: those that two calls with other contents make equal.
template <class T>
std::size_t written(void (*get)(HDenum, T*), HDenum parameter) {
  constexpr std::size_t kRoom = 64;
  std::array<T, kRoom> one, two;
  std::memset(one.data(), 0x55, sizeof one);
  std::memset(two.data(), 0x2a, sizeof two);
  get(parameter, one.data());
  get(parameter, two.data());
  std::size_t count = 0;
  while (count < kRoom && std::memcmp(&one[count], &two[count], sizeof(T)) == 0) ++count;
  for (std::size_t i = count; i < kRoom; ++i) {
    EXPECT_NE(std::memcmp(&one[i], &two[i], sizeof(T)), 0) << std::hex << parameter;
  }
  return count;
}

struct CompatHdParameters : HdTest, ::testing::WithParamInterface<const char*> {
  void SetUp() override {
    rig.emplace(in_step(GetParam()));
    ASSERT_EQ(hdInitDevice(nullptr), 0u);
  }
  std::optional<ExecRig> rig;
};

TEST_P(CompatHdParameters, GettersWriteTheDocumentedNumbers) {
  hdBeginFrame(0);
  for (const auto& [parameter, count] : kCounts) {
    EXPECT_EQ(written(hdGetDoublev, parameter), count) << std::hex << parameter;
    EXPECT_EQ(written(hdGetFloatv, parameter), count) << std::hex << parameter;
    EXPECT_EQ(written(hdGetIntegerv, parameter), count) << std::hex << parameter;
    EXPECT_EQ(written(hdGetLongv, parameter), count) << std::hex << parameter;
    EXPECT_EQ(written(hdGetBooleanv, parameter), count) << std::hex << parameter;
    EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS) << std::hex << parameter;
  }
  hdEndFrame(0);
}

TEST_P(CompatHdParameters, CountOfMotorsIsTheOutputDof) {
  HDint motors = 0;
  hdGetIntegerv(HD_OUTPUT_DOF, &motors);
  for (const HDenum parameter :
       {HD_MOTOR_TEMPERATURE, HD_CURRENT_MOTOR_DAC_VALUES, HD_LAST_MOTOR_DAC_VALUES}) {
    EXPECT_EQ(written(hdGetDoublev, parameter), static_cast<std::size_t>(motors));
  }
}

TEST_P(CompatHdParameters, SettersReadNoMoreThanTheDocumentedNumbers) {
  GuardedMemory memory;
  hdBeginFrame(0);
  for (const auto& [parameter, count] : kCounts) {
    double* d = memory.last<double>(count);
    std::fill_n(d, count, 0.01);
    hdSetDoublev(parameter, d);
    float* f = memory.last<float>(count);
    std::fill_n(f, count, 0.01f);
    hdSetFloatv(parameter, f);
    int* i = memory.last<int>(count);
    std::fill_n(i, count, 1);
    hdSetIntegerv(parameter, i);
    long* l = memory.last<long>(count);
    std::fill_n(l, count, 1);
    hdSetLongv(parameter, l);
    HDboolean* b = memory.last<HDboolean>(count);
    std::fill_n(b, count, HD_TRUE);
    hdSetBooleanv(parameter, b);
    const bool writable = drain_hd_errors().errorCode == HD_SUCCESS;
    EXPECT_EQ(writable, kWritable.contains(parameter)) << std::hex << parameter;
  }
  hdEndFrame(0);
}

TEST_P(CompatHdParameters, EveryCapabilityCanBeSwitched) {
  for (const HDenum capability : kCapabilities) {
    for (const bool on : {true, false, true}) {
      on ? hdEnable(capability) : hdDisable(capability);
      EXPECT_EQ(hdIsEnabled(capability), on ? HD_TRUE : HD_FALSE) << std::hex << capability;
      EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS) << std::hex << capability;
    }
  }
}

TEST_P(CompatHdParameters, EveryTextIsAnswered) {
  for (const HDenum parameter : kTexts) {
    EXPECT_STRNE(hdGetString(parameter), "") << std::hex << parameter;
    EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS) << std::hex << parameter;
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, CompatHdParameters,
                         ::testing::Values("vintage_phantom", "polhem", "falcon"),
                         [](const auto& arm) { return std::string(arm.param); });

using CompatHdLimits = HdTest;

TEST_F(CompatHdLimits, SerialNumberNamesTheArm) {
  ExecOptions options = in_step();
  options.arms = {{.arm_file = "vintage_phantom"}, {.arm_file = "vintage_phantom"}};
  ExecRig rig(options);
  hdInitDevice("PHANToM 1");
  const std::string first = hdGetString(HD_DEVICE_SERIAL_NUMBER);
  hdInitDevice("PHANToM 2");
  EXPECT_NE(hdGetString(HD_DEVICE_SERIAL_NUMBER), first);
  EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS);
}

/// Returns how often each error was reported in `ticks` frames with a force.
std::map<HDerror, int> errors_of(int ticks, const std::array<double, 3>& f) {
  std::map<HDerror, int> seen;
  hd_frames(0, ticks, [&] {
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
    for (HDErrorInfo e = hdGetError(); HD_DEVICE_ERROR(e); e = hdGetError()) ++seen[e.errorCode];
  });
  return seen;
}

TEST_F(CompatHdLimits, ExceededForceIsReportedOnlyWhileItIsChecked) {
  ExecRig rig(in_step());
  hdInitDevice(nullptr);
  hdEnable(HD_FORCE_OUTPUT);
  const std::array<double, 3> strong{0, 30, 0};
  hdDisable(HD_SOFTWARE_FORCE_LIMIT);
  EXPECT_EQ(errors_of(60, strong)[HD_EXCEEDED_MAX_FORCE], 0);
  hdEnable(HD_SOFTWARE_FORCE_LIMIT);
  EXPECT_GT(errors_of(60, strong)[HD_EXCEEDED_MAX_FORCE], 0);
}

TEST_F(CompatHdLimits, SpeedLimitOfTheProgramAppliesOnlyWhileChecked) {
  ExecOptions options = in_step();
  options.hand = THIMBLE_SOURCE_DIR "/tests/compat/fast_hand.txt";
  ExecRig rig(options);
  hdInitDevice(nullptr);
  hdEnable(HD_FORCE_OUTPUT);
  const double slow = 20;  // mm/s; the hand moves ten times as fast
  hdDisable(HD_SOFTWARE_VELOCITY_LIMIT);
  hdSetDoublev(HD_SOFTWARE_VELOCITY_LIMIT, &slow);
  const std::array<double, 3> none{0, 0, 0};
  EXPECT_EQ(errors_of(150, none)[HD_EXCEEDED_MAX_VELOCITY], 0);
  hdEnable(HD_SOFTWARE_VELOCITY_LIMIT);
  EXPECT_EQ(errors_of(150, none)[HD_EXCEEDED_MAX_VELOCITY], 1);
}

TEST_F(CompatHdLimits, ImpulseLimitSlowsARiseAndNotADecrease) {
  ExecRig rig(in_step());
  hdInitDevice(nullptr);
  hdEnable(HD_FORCE_OUTPUT);
  const std::array<double, 3> weak{0.1, 0, 0}, strong{0.5, 0, 0};
  errors_of(500, weak);
  const double limit = 0.01;  // N/ms
  hdSetDoublev(HD_SOFTWARE_FORCE_IMPULSE_LIMIT, &limit);
  ArmReading reading;
  EXPECT_GT(errors_of(10, strong)[HD_EXCEEDED_MAX_FORCE_IMPULSE], 0);
  arms::read(0, reading);
  // Each frame is two ticks long.
  EXPECT_NEAR(reading.f_client_W[1], 0.1 + 20 * limit, 3 * limit);
  errors_of(1, weak);
  arms::read(0, reading);
  EXPECT_NEAR(reading.f_client_W[1], 0.1, 1e-9);
  hdDisable(HD_SOFTWARE_FORCE_IMPULSE_LIMIT);
  drain_hd_errors();
  EXPECT_EQ(errors_of(1, strong)[HD_EXCEEDED_MAX_FORCE_IMPULSE], 0);
  arms::read(0, reading);
  EXPECT_NEAR(reading.f_client_W[1], 0.5, 1e-9);
}

}  // namespace
}  // namespace thimble::compat
