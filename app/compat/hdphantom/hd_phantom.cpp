// libhdPhantom.so: CHAI3D's axes are the same as ours.
#include <algorithm>
#include <array>
#include <cstring>
#include <initializer_list>
#include <mutex>
#include <string>

#include "compat/core/arm_access.h"
#include "hdPhantom.h"

namespace {

namespace arms = thimble::compat::arms;
using thimble::compat::ArmFacts;
using thimble::compat::ArmReading;
using thimble::compat::ForceRequest;

constexpr const char* kApi = "hdPhantom";
constexpr int kFailed = -1, kDone = 0, kTrue = 1;

std::mutex& mutex() {
  static std::mutex& only = *new std::mutex;
  return only;
}

/// The last requests: a new torque keeps the force, and vice versa.
std::array<ForceRequest, thimble::compat::kArmsMax>& asked() {
  static auto& all = *new std::array<ForceRequest, thimble::compat::kArmsMax>;
  return all;
}

int wrong(const char* function, const char* what) {
  arms::wrong_call(function, what);
  return kFailed;
}

bool any_null(std::initializer_list<const void*> pointers) {
  return std::any_of(pointers.begin(), pointers.end(), [](const void* p) { return p == nullptr; });
}

/// Copies numbers of the newest tick; zeros if the arm is not open.
template <class Numbers>
int get(const char* function, int id, std::initializer_list<double*> to,
        Numbers ArmReading::*from) {
  if (std::any_of(to.begin(), to.end(), [](double* p) { return p == nullptr; })) {
    return wrong(function, "a pointer is null");
  }
  ArmReading reading;
  const bool there = arms::read(id, reading);
  std::size_t i = 0;
  for (double* number : to) *number = there ? (reading.*from)[i++] : 0;
  return there ? kTrue : wrong(function, "the arm is not open");
}

int set(const char* function, int id, const std::array<double, 3>* force,
        const std::array<double, 3>* torque) {
  if (!arms::is_open(id)) return wrong(function, "the arm is not open");
  {
    const std::lock_guard lock(mutex());
    ForceRequest& all = asked()[static_cast<std::size_t>(id)];
    if (force != nullptr) all.f_W = *force;
    if (torque != nullptr) all.torque_W = *torque;
    arms::ask_force(id, all);
  }
  return arms::wait_until_taken(id) ? kDone : kFailed;
}

}  // namespace

extern "C" {

int hdPhantomGetNumDevices(void) {
  return arms::listed(kApi);
}

int hdPhantomOpen(int id) {
  const std::string trouble = arms::open(id, kApi);
  if (!trouble.empty()) return wrong(__func__, trouble.c_str());
  {
    const std::lock_guard lock(mutex());
    asked()[static_cast<std::size_t>(id)] = {};
  }
  return arms::enable_force(id, true) ? kDone : kFailed;
}

int hdPhantomClose(int id) {
  return arms::close(id) ? kTrue : wrong(__func__, "the arm is not open");
}

int hdPhantomGetPosition(int id, double* x, double* y, double* z) {
  return get(__func__, id, {x, y, z}, &ArmReading::p_WT);
}

int hdPhantomGetLinearVelocity(int id, double* x, double* y, double* z) {
  return get(__func__, id, {x, y, z}, &ArmReading::v_WT);
}

int hdPhantomGetRotation(int id, double* r00, double* r01, double* r02, double* r10, double* r11,
                         double* r12, double* r20, double* r21, double* r22) {
  return get(__func__, id, {r00, r01, r02, r10, r11, r12, r20, r21, r22}, &ArmReading::R_WT);
}

int hdPhantomGetButtons(int id) {
  ArmReading reading;
  if (arms::read(id, reading)) return reading.buttons;
  wrong(__func__, "the arm is not open");
  return 0;
}

int hdPhantomSetForce(int id, const double* x, const double* y, const double* z) {
  if (any_null({x, y, z})) return wrong(__func__, "a pointer is null");
  const std::array<double, 3> force{*x, *y, *z};
  return set(__func__, id, &force, nullptr);
}

int hdPhantomSetTorque(int id, const double* x, const double* y, const double* z) {
  if (any_null({x, y, z})) return wrong(__func__, "a pointer is null");
  const std::array<double, 3> torque{*x, *y, *z};
  return set(__func__, id, nullptr, &torque);
}

int hdPhantomSetForceAndTorque(int id, const double* fx, const double* fy, const double* fz,
                               const double* tx, const double* ty, const double* tz) {
  if (any_null({fx, fy, fz, tx, ty, tz})) return wrong(__func__, "a pointer is null");
  const std::array<double, 3> force{*fx, *fy, *fz}, torque{*tx, *ty, *tz};
  return set(__func__, id, &force, &torque);
}

int hdPhantomGetWorkspaceRadius(int id, double* radius) {
  if (radius == nullptr) return wrong(__func__, "the pointer is null");
  *radius = 0;
  if (id < 0 || id >= arms::count()) return wrong(__func__, "no arm has this number");
  const ArmFacts facts = arms::facts(id);
  // Radius of the largest ball in the workspace.
  double half = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    half = std::min(half, (facts.workspace_max[i] - facts.workspace_min[i]) / 2);
  }
  *radius = half;
  return kTrue;
}

int hdPhantomGetType(int id, char* name) {
  if (name == nullptr) return wrong(__func__, "the pointer is null");
  *name = 0;
  if (id < 0 || id >= arms::count()) return wrong(__func__, "no arm has this number");
  const ArmFacts facts = arms::facts(id);  // shorter than the caller's buffer
  std::memcpy(name, facts.name.data(), facts.name.size());
  return kTrue;
}

void hdPhantomStartServo(void) {}

void hdPhantomStopServo(void) {
  for (int id = 0; id < thimble::compat::kArmsMax; ++id) {
    if (!arms::is_open(id)) continue;
    const std::lock_guard lock(mutex());
    asked()[static_cast<std::size_t>(id)] = {};
    arms::ask_force(id, {});
  }
}

}  // extern "C"
