// Capabilities and numeric parameters of the current arm, for all types.
#include <cmath>
#include <limits>
#include <type_traits>

#include "compat/core/arm_access.h"
#include "compat/core/kept_text.h"
#include "compat/hd/hd_device.h"
#include "compat/hd/hd_errors.h"
#include "compat/hd/hd_parameters.h"
#include "thimble/version.h"

namespace thimble::compat::hd {
namespace {

/// Converts a number to another type: rounded, and clamped to its range.
template <class T>
T as(double value) noexcept {
  if constexpr (std::is_same_v<T, HDboolean>) {
    return value != 0 ? HD_TRUE : HD_FALSE;
  } else if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(value);
  } else {
    constexpr auto kMax = static_cast<double>(std::numeric_limits<T>::max());
    constexpr auto kMin = static_cast<double>(std::numeric_limits<T>::min());
    if (std::isnan(value)) return 0;
    if (value >= kMax) return std::numeric_limits<T>::max();
    if (value <= kMin) return std::numeric_limits<T>::min();
    return static_cast<T>(std::llround(value));
  }
}

const Parameter* parameter_of(const char* function, HDenum number, const void* values) noexcept {
  if (values == nullptr) {
    record_wrong_call(HD_INVALID_VALUE, function, "the pointer is null");
    return nullptr;
  }
  const Parameter* parameter = find_parameter(number);
  if (parameter != nullptr) return parameter;
  if (is_text(number)) {
    record_wrong_call(HD_INVALID_INPUT_TYPE, function,
                      "the parameter is a string; use hdGetString");
  } else {
    record_wrong_call(HD_INVALID_ENUM, function, "no parameter has this number");
  }
  return nullptr;
}

template <class T>
void get(const char* function, HDenum number, T* values) noexcept {
  const Parameter* parameter = parameter_of(function, number, values);
  if (parameter == nullptr) return;
  const std::lock_guard lock(devices().mutex);
  const Device* device = current_open(function);
  if (device == nullptr) return;
  const HHD handle = current_device();
  const ArmReading state = parameter->last ? device->frame.last : seen(handle);
  Numbers numbers{};
  parameter->get({handle, *device, arms::facts(static_cast<int>(handle)), state}, numbers);
  const std::size_t count = count_of(*parameter, arms::facts(static_cast<int>(handle)));
  for (std::size_t i = 0; i < count; ++i) values[i] = as<T>(numbers[i]);
}

template <class T>
void set(const char* function, HDenum number, const T* values) noexcept {
  const Parameter* parameter = parameter_of(function, number, values);
  if (parameter == nullptr) return;
  if (parameter->set == nullptr) {
    record_wrong_call(HD_INVALID_ENUM, function, "this parameter cannot be set");
    return;
  }
  const std::lock_guard lock(devices().mutex);
  Device* device = current_open(function);
  if (device == nullptr) return;
  Numbers numbers{};
  const std::size_t count = count_of(*parameter, arms::facts(static_cast<int>(current_device())));
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<double>(values[i]);
  const HDerror error = parameter->set(current_device(), *device, numbers);
  if (error != HD_SUCCESS) record_wrong_call(error, function, hdGetErrorString(error));
}

bool Device::*capability_of(HDenum number) noexcept {
  switch (number) {
    case HD_FORCE_OUTPUT:
      return &Device::force_output;
    case HD_MAX_FORCE_CLAMPING:
      return &Device::force_clamping;
    case HD_FORCE_RAMPING:
      return &Device::force_ramping;
    case HD_SOFTWARE_FORCE_LIMIT:
      return &Device::force_limit;
    case HD_ONE_FRAME_LIMIT:
      return &Device::one_frame_limit;
    case HD_SOFTWARE_VELOCITY_LIMIT:
      return &Device::velocity_check;
    case HD_SOFTWARE_FORCE_IMPULSE_LIMIT:
      return &Device::impulse_check;
    default:
      return nullptr;
  }
}

void switch_capability(const char* function, HDenum number, bool on) noexcept {
  bool Device::*capability = capability_of(number);
  if (capability == nullptr) {
    record_wrong_call(HD_INVALID_ENUM, function, "no capability has this number");
    return;
  }
  const std::lock_guard lock(devices().mutex);
  Device* device = current_open(function);
  if (device == nullptr) return;
  device->*capability = on;
  const HHD handle = current_device();
  if (number == HD_SOFTWARE_VELOCITY_LIMIT) apply_velocity_limit(handle);
  if (number != HD_FORCE_OUTPUT) return;
  device->enabled_ns = seen(handle).time_ns;
  if (!on) remove_command(handle);
  arms::enable_force(static_cast<int>(handle), on);
}

}  // namespace
}  // namespace thimble::compat::hd

using namespace thimble::compat;
using namespace thimble::compat::hd;

extern "C" {

void hdEnable(HDenum capability) {
  switch_capability(__func__, capability, true);
}
void hdDisable(HDenum capability) {
  switch_capability(__func__, capability, false);
}

HDboolean hdIsEnabled(HDenum capability) {
  bool Device::*member = capability_of(capability);
  if (member == nullptr) {
    record_wrong_call(HD_INVALID_ENUM, __func__, "no capability has this number");
    return HD_FALSE;
  }
  const std::lock_guard lock(devices().mutex);
  const Device* device = current_open(__func__);
  return device != nullptr && device->*member ? HD_TRUE : HD_FALSE;
}

void hdGetBooleanv(HDenum parameter, HDboolean* values) {
  get(__func__, parameter, values);
}
void hdGetIntegerv(HDenum parameter, HDint* values) {
  get(__func__, parameter, values);
}
void hdGetFloatv(HDenum parameter, HDfloat* values) {
  get(__func__, parameter, values);
}
void hdGetDoublev(HDenum parameter, HDdouble* values) {
  get(__func__, parameter, values);
}
void hdGetLongv(HDenum parameter, HDlong* values) {
  get(__func__, parameter, values);
}

HDstring hdGetString(HDenum parameter) {
  if (!is_text(parameter)) {
    const bool known = find_parameter(parameter) != nullptr;
    record_wrong_call(known ? HD_INVALID_INPUT_TYPE : HD_INVALID_ENUM, __func__,
                      known ? "the parameter is not a string" : "no parameter has this number");
    return "";
  }
  if (parameter == HD_DEVICE_VENDOR) return "Thimble";
  const bool serial = parameter == HD_DEVICE_SERIAL_NUMBER;
  if (parameter != HD_DEVICE_MODEL_TYPE && !serial) return THIMBLE_VERSION;
  const std::lock_guard lock(devices().mutex);
  if (current_open(__func__) == nullptr) return "";
  const ArmFacts facts = arms::facts(static_cast<int>(current_device()));
  return kept_text(serial ? facts.serial.data() : facts.name.data());
}

void hdSetBooleanv(HDenum parameter, const HDboolean* values) {
  set(__func__, parameter, values);
}
void hdSetIntegerv(HDenum parameter, const HDint* values) {
  set(__func__, parameter, values);
}
void hdSetFloatv(HDenum parameter, const HDfloat* values) {
  set(__func__, parameter, values);
}
void hdSetDoublev(HDenum parameter, const HDdouble* values) {
  set(__func__, parameter, values);
}
void hdSetLongv(HDenum parameter, const HDlong* values) {
  set(__func__, parameter, values);
}

void hdScaleGimbalAngles(HDdouble, HDdouble, HDdouble, HDdouble transform[16]) {
  if (transform == nullptr) {
    record_wrong_call(HD_INVALID_VALUE, __func__, "the pointer is null");
    return;
  }
  const std::lock_guard lock(devices().mutex);
  if (current_open(__func__) == nullptr) return;
  // The angles of our gimbals need no scale: the transform is returned unchanged.
  const std::array<double, 16> now = transform_of(seen(current_device()));
  for (std::size_t i = 0; i < now.size(); ++i) transform[i] = now[i];
}

}  // extern "C"
