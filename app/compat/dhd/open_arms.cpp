#include "compat/dhd/open_arms.h"

#include <Eigen/Geometry>
#include <string>
#include <string_view>

#include "compat/dhd/last_error.h"
#include "drdc.h"

namespace thimble::compat::dhd {
namespace {

struct Table {
  Table() {
    for (int i = 0; i < kArmsMax; ++i) arms[static_cast<std::size_t>(i)].number = i;
  }
  std::mutex opening;                  // serialises opening and closing
  std::array<OpenArm, kArmsMax> arms;  // one entry for each possible arm of `thimble exec`
  std::atomic<int> chosen{-1};
};

// Never destroyed: a thread of the program may use it during exit.
Table& table() noexcept {
  static Table* const kTable = new Table;
  return *kTable;
}

// A program's settings of an arm are valid while it is open.
void reset_settings(OpenArm& arm) noexcept {
  arm.force = ForceSwitch::kUnset;
  arm.off_cause = kOffBySoftware;
  arm.force_sent = false;
  arm.gravity = false;
  arm.brakes = true;
  arm.emulate_button = false;
  arm.effector_mass = arm.device_angle = arm.base_angle_x = arm.base_angle_z = 0;
  arm.max_force = -1;
  arm.velocity_threshold = 0;
  arm.watchdog = 0;
  arm.vibration_frequency = arm.vibration_amplitude = 0;
  arm.forces = 0;
  arm.stored_integral_gain = 0;
  arm.init_started = false;
  arm.regulator.reset_settings();
  {
    const std::lock_guard lock(arm.stored_mutex);
    arm.stored_bounds = {};
  }
  const std::lock_guard lock(arm.gap_mutex);
  arm.gap_time = arm.gap = arm.gap_speed = 0;
  arm.counted_forces = 0;
  arm.counted_ns = 0;
}

}  // namespace

OpenArm* open_arm(const char* function, char id) noexcept {
  // Plain char is unsigned on some machines; -1 must work on all.
  int number = static_cast<signed char>(id);
  if (number == -1) {
    number = table().chosen;
    if (number < 0) {
      fail(function, DHD_ERROR_DEVICE_NOT_READY, "no arm is open");
      return nullptr;
    }
  }
  if (number < 0 || number >= kArmsMax) {
    fail(function, DHD_ERROR_INVALID_INDEX, "no arm has this number");
    return nullptr;
  }
  OpenArm& arm = table().arms[static_cast<std::size_t>(number)];
  if (!arm.open) {
    const bool known = number < arms::count();
    fail(function, known ? DHD_ERROR_DEVICE_NOT_READY : DHD_ERROR_INVALID_INDEX,
         known ? "the arm is not open" : "no arm has this number");
    return nullptr;
  }
  return &arm;
}

int open_number(const char* function, int number) noexcept {
  const std::lock_guard lock(table().opening);
  if (arms::count() == 0) {
    return fail(function, DHD_ERROR_NO_DEVICE_FOUND, "the program was not started by thimble exec");
  }
  if (number < 0 || number >= arms::count() || number >= kArmsMax) {
    return fail(function, DHD_ERROR_INVALID_INDEX, "no arm has this number");
  }
  OpenArm& arm = table().arms[static_cast<std::size_t>(number)];
  if (!arm.open) {
    const bool by_drd = std::string_view(function).starts_with("drd");
    const std::string wrong = arms::open(number, by_drd ? "DRD" : kApi);
    if (!wrong.empty()) return fail(function, DHD_ERROR_DEVICE_NOT_READY, wrong.c_str());
    reset_settings(arm);
    arm.open = true;
  }
  table().chosen = number;
  return number;
}

int close_arm(const char* function, char id) noexcept {
  const std::lock_guard lock(table().opening);
  OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  arm->regulator.stop();
  arm->open = false;
  arms::enable_force(arm->number, false);
  arms::close(arm->number);
  int chosen = arm->number;
  table().chosen.compare_exchange_strong(chosen, -1);
  return 0;
}

int choose_arm(const char* function, char id) noexcept {
  const OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  table().chosen = arm->number;
  return 0;
}

int chosen_arm() noexcept {
  return table().chosen;
}

bool read_arm(const char* function, const OpenArm& arm, ArmReading& reading) noexcept {
  if (arms::is_running(arm.number) && arms::read(arm.number, reading)) return true;
  fail(function, DHD_ERROR_COM, "the run of thimble exec has ended");
  return false;
}

Eigen::Matrix3d user_rotation(const OpenArm& arm) noexcept {
  const double x = arm.base_angle_x, z = arm.base_angle_z;
  if (x == 0 && z == 0) return Eigen::Matrix3d::Identity();
  return (Eigen::AngleAxisd(z, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(x, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

bool enable_force_if_unset(OpenArm& arm) noexcept {
  ForceSwitch unset = ForceSwitch::kUnset;
  if (arm.force.compare_exchange_strong(unset, ForceSwitch::kOn)) {
    arm.force_sent = false;
    if (!arms::enable_force(arm.number, true)) {
      arm.force = ForceSwitch::kUnset;
      return false;
    }
  }
  return arm.force == ForceSwitch::kOn;
}

void switch_off(OpenArm& arm, ForceOffCause cause) noexcept {
  arm.off_cause = cause;
  arm.force = ForceSwitch::kOff;
  arms::enable_force(arm.number, false);
}

}  // namespace thimble::compat::dhd
