#include "compat/dhd/last_error.h"

#include <array>

#include "compat/core/arm_access.h"
#include "drdc.h"

namespace thimble::compat::dhd {
namespace {

thread_local int last = DHD_NO_ERROR;

constexpr std::array<const char*, 23> kTexts{
    "no error",
    "the call failed",
    "the servo loop does not respond: the run has ended",
    "the controller is busy",
    "no driver was found",
    "no arm was found: start the program with `thimble exec`",
    "this arm does not have this feature",
    "the operation timed out",
    "the arm cannot reach this point",
    "expert mode is off: call dhdEnableExpertMode",
    "Thimble does not implement this function",
    "out of memory",
    "the arm is not open, or a fault keeps its force off",
    "the file was not found",
    "the configuration is invalid",
    "no arm, button or part has this number",
    "this function is deprecated",
    "a pointer is null",
    "the redundant encoders disagree",
    "force is disabled: call dhdEnableForce",
    "the arm is regulated: call drdStop or drdRegulatePos(false)",
    "a number is not finite or out of bounds",
    "regulation is not running: call drdStart",
};

}  // namespace

int fail(const char* function, int error, const char* what) noexcept {
  last = error;
  arms::wrong_call(function, what);
  return -1;
}

int last_error() noexcept {
  return last;
}

}  // namespace thimble::compat::dhd

using thimble::compat::dhd::kTexts;

extern "C" {

int dhdErrorGetLast(void) {
  return thimble::compat::dhd::last_error();
}

const char* dhdErrorGetLastStr(void) {
  return dhdErrorGetStr(dhdErrorGetLast());
}

const char* dhdErrorGetStr(int error) {
  if (error < 0 || error >= static_cast<int>(kTexts.size())) return "no error has this number";
  return kTexts[static_cast<std::size_t>(error)];
}

}  // extern "C"
