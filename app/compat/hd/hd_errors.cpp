#include "compat/hd/hd_errors.h"

#include <deque>
#include <mutex>

#include "compat/core/arm_access.h"
#include "compat/hd/hd_device.h"

namespace thimble::compat::hd {
namespace {

constexpr std::size_t kErrorsMax = 64;  // chosen: enough for rare checks of errors

struct Errors {
  std::mutex mutex;
  std::deque<HDErrorInfo> all;  // the newest is last
};

Errors& errors() {
  static Errors& only = *new Errors;
  return only;
}

}  // namespace

void record_error(HDerror error, HHD device, int internal) noexcept {
  Errors& kept = errors();
  const std::lock_guard lock(kept.mutex);
  if (kept.all.size() >= kErrorsMax) kept.all.pop_front();
  kept.all.push_back({error, internal, device});
}

void record_wrong_call(HDerror error, const char* function, const char* what) noexcept {
  arms::wrong_call(function, what);
  record_error(error, current_device());
}

}  // namespace thimble::compat::hd

using namespace thimble::compat;

extern "C" {

HDErrorInfo hdGetError(void) {
  hd::Errors& kept = hd::errors();
  const std::lock_guard lock(kept.mutex);
  if (kept.all.empty()) return {HD_SUCCESS, 0, HD_INVALID_HANDLE};
  const HDErrorInfo newest = kept.all.back();
  kept.all.pop_back();
  return newest;
}

HDstring hdGetErrorString(HDerror error) {
  switch (error) {
    case HD_SUCCESS:
      return "no error";
    case HD_INVALID_ENUM:
      return "no parameter or capability has this number";
    case HD_INVALID_VALUE:
      return "the value is not allowed here";
    case HD_INVALID_OPERATION:
      return "the call is not allowed here";
    case HD_INVALID_INPUT_TYPE:
      return "the parameter has no values of this type";
    case HD_BAD_HANDLE:
      return "no open arm has this handle";
    case HD_WARM_MOTORS:
      return "a motor is hot; the force is reduced";
    case HD_EXCEEDED_MAX_FORCE:
      return "the force was limited to the maximum of the arm";
    case HD_EXCEEDED_MAX_FORCE_IMPULSE:
      return "the force rose too fast; its rate was limited";
    case HD_EXCEEDED_MAX_VELOCITY:
      return "the tip moved too fast: the force is off until it is enabled again";
    case HD_FORCE_ERROR:
      return "the arm cannot exert the force";
    case HD_DEVICE_FAULT:
      return "the arm has a fault: the force is off until it is enabled again";
    case HD_DEVICE_ALREADY_INITIATED:
      return "the arm is already open";
    case HD_COMM_ERROR:
      return "the arm cannot be opened: start the program with `thimble exec`, which reports the "
             "reason";
    case HD_COMM_CONFIG_ERROR:
      return "no arm has this name";
    case HD_TIMER_ERROR:
      return "the scheduler cannot run";
    case HD_ILLEGAL_BEGIN:
      return "hdBeginFrame was called inside a frame";
    case HD_ILLEGAL_END:
      return "hdEndFrame was called without hdBeginFrame";
    case HD_FRAME_ERROR:
      return "the call requires a frame, or a frame was left open";
    case HD_INVALID_PRIORITY:
      return "callbacks cannot have this priority";
    case HD_SCHEDULER_FULL:
      return "the scheduler cannot take more callbacks";
    case HD_INVALID_LICENSE:
      return "the licence is not valid";
    default:
      return "unknown error number";
  }
}

}  // extern "C"
