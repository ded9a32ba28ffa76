// The list of arms, and which of them are open.
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "compat/core/kept_text.h"
#include "compat/dhd/last_error.h"
#include "compat/dhd/open_arms.h"
#include "drdc.h"

using namespace thimble::compat;
using namespace thimble::compat::dhd;

namespace {

// Programs choose their limits by the type; THIMBLE_DHD_TYPE overrides the default.
int type_of(const char* name) noexcept {
  if (const char* text = std::getenv("THIMBLE_DHD_TYPE")) {
    const long type = std::strtol(text, nullptr, 10);
    if (type > 0 && type < 256) return static_cast<int>(type);
  }
  return std::string_view(name) == "falcon" ? DHD_DEVICE_FALCON : DHD_DEVICE_CUSTOM;
}

int type_of_number(int number) noexcept {
  return type_of(arms::name(number).c_str());
}

// Returns a property of an arm. If it is not open, returns false and records an error.
bool has(const char* function, char id, bool ArmFacts::*what) noexcept {
  const OpenArm* arm = open_arm(function, id);
  return arm && arms::facts(arm->number).*what;
}

// Opens the first arm that no program has open.
int open_first(const char* function) noexcept {
  for (int number = 0; number < arms::count(); ++number) {
    if (!arms::is_open(number) && !arms::is_taken(number)) return open_number(function, number);
  }
  return open_number(function, 0);
}

}  // namespace

extern "C" {

void dhdEnableSimulator(bool) {}  // `thimble exec` decides whether arms are simulated

int dhdGetDeviceCount(void) {
  return arms::listed(kApi);
}
int dhdGetAvailableCount(void) {
  int available = 0;
  for (int number = 0; number < arms::listed(kApi); ++number) available += !arms::is_taken(number);
  return available;
}
int dhdSetDevice(char id) {
  return choose_arm("dhdSetDevice", id);
}
int drdSetDevice(char id) {
  return choose_arm("drdSetDevice", id);
}

int dhdGetDeviceID(void) {
  const int chosen = chosen_arm();
  return chosen >= 0 ? chosen
                     : fail("dhdGetDeviceID", DHD_ERROR_DEVICE_NOT_READY, "no arm is open");
}
int drdGetDeviceID(void) {
  return dhdGetDeviceID();
}

int dhdGetSerialNumber(unsigned short* serial, char id) {
  const OpenArm* arm = open_arm("dhdGetSerialNumber", id);
  if (!arm) return -1;
  if (!serial) return fail("dhdGetSerialNumber", DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  *serial = static_cast<unsigned short>(arm->number + 1);
  return 0;
}

int dhdOpen(void) {
  return open_first("dhdOpen");
}

int dhdOpenType(int type) {
  for (int number = 0; number < arms::count(); ++number) {
    if (type_of_number(number) == type) return open_number("dhdOpenType", number);
  }
  return fail("dhdOpenType", DHD_ERROR_NO_DEVICE_FOUND, "no arm has this type");
}

int dhdOpenSerial(int serial) {
  if (serial < 1 || serial > arms::count()) {
    return fail("dhdOpenSerial", DHD_ERROR_NO_DEVICE_FOUND, "no arm has this serial number");
  }
  return open_number("dhdOpenSerial", serial - 1);
}

int dhdOpenID(char index) {
  return open_number("dhdOpenID", static_cast<signed char>(index));
}
int drdOpen(void) {
  return open_first("drdOpen");
}
int drdOpenID(char index) {
  return open_number("drdOpenID", static_cast<signed char>(index));
}
int dhdClose(char id) {
  return close_arm("dhdClose", id);
}
int drdClose(char id) {
  return close_arm("drdClose", id);
}

int dhdGetSystemType(char id) {
  const OpenArm* arm = open_arm("dhdGetSystemType", id);
  return arm ? type_of(arms::facts(arm->number).name.data()) : -1;
}

const char* dhdGetSystemName(char id) {
  const OpenArm* arm = open_arm("dhdGetSystemName", id);
  return arm ? kept_text(arms::facts(arm->number).name.data()) : nullptr;
}

void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  // The version whose names and types are implemented (PROVENANCE.md): clients require a minimum.
  if (major) *major = 3;
  if (minor) *minor = 17;
  if (release) *release = 5;
  if (revision) *revision = 0;
}

const char* dhdGetSDKVersionStr(void) {
  return "3.17.5";
}

int dhdGetStatus(int status[DHD_MAX_STATUS], char id) {
  const OpenArm* arm = open_arm("dhdGetStatus", id);
  if (!arm) return -1;
  if (!status) return fail("dhdGetStatus", DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  ArmReading reading;
  if (!read_arm("dhdGetStatus", *arm, reading)) return -1;
  using thimble::driver::Fault;
  const ArmFacts facts = arms::facts(arm->number);
  const bool faulty = reading.fault != Fault::kNone;
  const bool on = arm->force == ForceSwitch::kOn && !faulty;
  const bool connected = reading.link != thimble::driver::LinkState::kLost;
  int cause = kForceOn;
  if (reading.fault == Fault::kOverSpeed)
    cause = kOffByVelocity;
  else if (reading.fault == Fault::kTransportLost || !connected)
    cause = kOffByPull;
  else if (reading.fault == Fault::kLoopStalled)
    cause = kOffByWatchdog;
  else if (faulty)
    cause = kOffBySoftware;
  else if (!on)
    cause = arm->off_cause;
  std::fill_n(status, DHD_MAX_STATUS, 0);
  status[DHD_STATUS_POWER] = status[DHD_STATUS_CONNECTED] = status[DHD_STATUS_STARTED] = 1;
  status[DHD_STATUS_CONNECTED] = connected;
  status[DHD_STATUS_RESET] = 1;  // an arm is calibrated before it may be opened
  status[DHD_STATUS_IDLE] = !on;
  status[DHD_STATUS_FORCE] = on;
  status[DHD_STATUS_BRAKE] = !on && arm->brakes;
  status[DHD_STATUS_WRIST_DETECTED] = status[DHD_STATUS_WRIST_INIT] = facts.has_orientation;
  status[DHD_STATUS_ERROR] = faulty;
  status[DHD_STATUS_GRAVITY] = arm->gravity;
  status[DHD_STATUS_FORCE_OFF_CAUSE] = cause;
  return 0;
}

// Hands, wrists and grippers: reported as our arms have them; no motor moves them.
bool dhdIsLeftHanded(char id) {
  return open_arm("dhdIsLeftHanded", id) && false;
}
bool dhdHasBase(char id) {
  return open_arm("dhdHasBase", id) != nullptr;
}
bool dhdHasWrist(char id) {
  return has("dhdHasWrist", id, &ArmFacts::has_orientation);
}
bool dhdHasActiveWrist(char id) {
  return open_arm("dhdHasActiveWrist", id) && false;
}
bool dhdHasGripper(char id) {
  return has("dhdHasGripper", id, &ArmFacts::has_gripper);
}
bool dhdHasActiveGripper(char id) {
  return open_arm("dhdHasActiveGripper", id) && false;
}

}  // extern "C"
