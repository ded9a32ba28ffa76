// libHL.so: lets programs start that are linked with HL. Thimble has no HL, so each call leaves an
// error and is counted in the report of `thimble exec`.
#include <HL/hl.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <mutex>

#include "compat/core/arm_access.h"

extern "C" {
#define THIMBLE_HL_CONSTANT(name) HLenum name = #name;
#include <HL/hl_constants.inc>
#undef THIMBLE_HL_CONSTANT
}

namespace {

namespace arms = thimble::compat::arms;

/// The errors that the program has not read; the newest are returned first.
struct Errors {
  std::mutex mutex;
  std::array<HLenum, 100> codes{};  // chosen: above the calls of a frame; more are dropped
  std::size_t count = 0;
};

// Never destroyed: threads of the program may use it while it exits.
Errors& errors() noexcept {
  static Errors& only = *new Errors;
  return only;
}

void leave(HLenum code, const char* function, const char* what) noexcept {
  arms::wrong_call(function, what);
  Errors& all = errors();
  const std::lock_guard lock(all.mutex);
  if (all.count < all.codes.size()) all.codes[all.count++] = code;
}

/// Refuses a call that needs a context, because there is none.
void refuse(const char* function) noexcept {
  leave(HL_INVALID_OPERATION, function, "there is no HL and no context of it");
}

/// The same for a getter, which writes one zero.
template <class T>
void refuse(const char* function, T* values) noexcept {
  if (values != nullptr) *values = T{};
  refuse(function);
}

}  // namespace

extern "C" {

HLerror hlGetError(void) {
  Errors& all = errors();
  const std::lock_guard lock(all.mutex);
  HLerror error{HL_NO_ERROR, {HD_SUCCESS, 0, HD_INVALID_HANDLE}};
  if (all.count == 0) return error;
  error.errorCode = all.codes[--all.count];
  if (error.errorCode == HL_DEVICE_ERROR) error.errorInfo.errorCode = HD_INVALID_OPERATION;
  return error;
}

HHLRC hlCreateContext(HHD) {
  static std::atomic<bool> printed{false};
  if (!printed.exchange(true)) {
    std::fprintf(stderr,
                 "thimble: hlCreateContext: Thimble has no HL, so the shapes and effects of this "
                 "program are not felt. Request forces by HDAPI (hdSetDoublev), or put the objects "
                 "into a scene (`thimble exec --scene`).\n");
  }
  leave(HL_DEVICE_ERROR, __func__, "there is no HL; only HDAPI requests forces");
  return nullptr;
}
// Programs delete and deselect the context that they did not get.
void hlDeleteContext(HHLRC context) {
  if (context != nullptr) refuse(__func__);
}
void hlMakeCurrent(HHLRC context) {
  if (context != nullptr) refuse(__func__);
}
HHLRC hlGetCurrentContext(void) {
  return nullptr;
}
HHD hlGetCurrentDevice(void) {
  return HD_INVALID_HANDLE;
}
HLboolean hlDeploymentLicense(const char* vendor, const char* application, const char* password) {
  if (vendor != nullptr && application != nullptr && password != nullptr) return HL_TRUE;
  leave(HL_INVALID_LICENSE, __func__, "a string is null");
  return HL_FALSE;
}
HLstring hlGetString(HLenum) {
  refuse(__func__);
  return "";
}

// Calls without a result.
#define THIMBLE_HL_REFUSED(function, ...) \
  void function(__VA_ARGS__) {            \
    refuse(#function);                    \
  }
THIMBLE_HL_REFUSED(hlContextDevice, HHD)
THIMBLE_HL_REFUSED(hlBeginFrame, void)
THIMBLE_HL_REFUSED(hlEndFrame, void)
THIMBLE_HL_REFUSED(hlUpdateCalibration, void)
THIMBLE_HL_REFUSED(hlEnable, HLenum)
THIMBLE_HL_REFUSED(hlDisable, HLenum)
THIMBLE_HL_REFUSED(hlHintb, HLenum, HLboolean)
THIMBLE_HL_REFUSED(hlHinti, HLenum, HLint)
THIMBLE_HL_REFUSED(hlPushAttrib, HLbitfield)
THIMBLE_HL_REFUSED(hlPopAttrib, void)
THIMBLE_HL_REFUSED(hlDeleteShapes, HLuint, HLsizei)
THIMBLE_HL_REFUSED(hlBeginShape, HLenum, HLuint)
THIMBLE_HL_REFUSED(hlEndShape, void)
THIMBLE_HL_REFUSED(hlLocalFeature1fv, HLgeom*, HLenum, const HLfloat*)
THIMBLE_HL_REFUSED(hlLocalFeature1dv, HLgeom*, HLenum, const HLdouble*)
THIMBLE_HL_REFUSED(hlLocalFeature2fv, HLgeom*, HLenum, const HLfloat*, const HLfloat*)
THIMBLE_HL_REFUSED(hlLocalFeature2dv, HLgeom*, HLenum, const HLdouble*, const HLdouble*)
THIMBLE_HL_REFUSED(hlCallback, HLenum, HLcallbackProc, void*)
THIMBLE_HL_REFUSED(hlMaterialf, HLenum, HLenum, HLfloat)
THIMBLE_HL_REFUSED(hlTouchableFace, HLenum)
THIMBLE_HL_REFUSED(hlTouchModel, HLenum)
THIMBLE_HL_REFUSED(hlTouchModelf, HLenum, HLfloat)
THIMBLE_HL_REFUSED(hlProxydv, HLenum, const HLdouble*)
THIMBLE_HL_REFUSED(hlDeleteEffects, HLuint, HLsizei)
THIMBLE_HL_REFUSED(hlStartEffect, HLenum, HLuint)
THIMBLE_HL_REFUSED(hlStopEffect, HLuint)
THIMBLE_HL_REFUSED(hlUpdateEffect, HLuint)
THIMBLE_HL_REFUSED(hlTriggerEffect, HLenum)
THIMBLE_HL_REFUSED(hlEffectd, HLenum, HLdouble)
THIMBLE_HL_REFUSED(hlEffecti, HLenum, HLint)
THIMBLE_HL_REFUSED(hlEffectdv, HLenum, const HLdouble*)
THIMBLE_HL_REFUSED(hlEffectiv, HLenum, const HLint*)
THIMBLE_HL_REFUSED(hlAddEventCallback, HLenum, HLuint, HLenum, HLeventProc, void*)
THIMBLE_HL_REFUSED(hlRemoveEventCallback, HLenum, HLuint, HLenum, HLeventProc)
THIMBLE_HL_REFUSED(hlEventd, HLenum, HLdouble)
THIMBLE_HL_REFUSED(hlCheckEvents, void)
THIMBLE_HL_REFUSED(hlMatrixMode, HLenum)
THIMBLE_HL_REFUSED(hlPushMatrix, void)
THIMBLE_HL_REFUSED(hlPopMatrix, void)
THIMBLE_HL_REFUSED(hlLoadIdentity, void)
THIMBLE_HL_REFUSED(hlLoadMatrixd, const HLdouble*)
THIMBLE_HL_REFUSED(hlLoadMatrixf, const HLfloat*)
THIMBLE_HL_REFUSED(hlMultMatrixd, const HLdouble*)
THIMBLE_HL_REFUSED(hlMultMatrixf, const HLfloat*)
THIMBLE_HL_REFUSED(hlRotated, HLdouble, HLdouble, HLdouble, HLdouble)
THIMBLE_HL_REFUSED(hlRotatef, HLfloat, HLfloat, HLfloat, HLfloat)
THIMBLE_HL_REFUSED(hlScaled, HLdouble, HLdouble, HLdouble)
THIMBLE_HL_REFUSED(hlScalef, HLfloat, HLfloat, HLfloat)
THIMBLE_HL_REFUSED(hlTranslated, HLdouble, HLdouble, HLdouble)
THIMBLE_HL_REFUSED(hlTranslatef, HLfloat, HLfloat, HLfloat)
THIMBLE_HL_REFUSED(hlOrtho, HLdouble, HLdouble, HLdouble, HLdouble, HLdouble, HLdouble)
THIMBLE_HL_REFUSED(hlWorkspace, HLdouble, HLdouble, HLdouble, HLdouble, HLdouble, HLdouble)
#undef THIMBLE_HL_REFUSED

// Calls that return a number, which is 0.
#define THIMBLE_HL_REFUSED(result, function, parameter) \
  result function(parameter) {                          \
    refuse(#function);                                  \
    return 0;                                           \
  }
THIMBLE_HL_REFUSED(HLboolean, hlIsEnabled, HLenum)
THIMBLE_HL_REFUSED(HLuint, hlGenShapes, HLsizei)
THIMBLE_HL_REFUSED(HLboolean, hlIsShape, HLuint)
THIMBLE_HL_REFUSED(HLuint, hlGenEffects, HLsizei)
THIMBLE_HL_REFUSED(HLboolean, hlIsEffect, HLuint)
#undef THIMBLE_HL_REFUSED

// Getters.
#define THIMBLE_HL_REFUSED(function, of, type) \
  void function(of, type* values) {            \
    refuse(#function, values);                 \
  }
#define THIMBLE_HL_OF(...) __VA_ARGS__
THIMBLE_HL_REFUSED(hlGetBooleanv, HLenum, HLboolean)
THIMBLE_HL_REFUSED(hlGetDoublev, HLenum, HLdouble)
THIMBLE_HL_REFUSED(hlGetIntegerv, HLenum, HLint)
THIMBLE_HL_REFUSED(hlCacheGetBooleanv, THIMBLE_HL_OF(HLcache*, HLenum), HLboolean)
THIMBLE_HL_REFUSED(hlCacheGetDoublev, THIMBLE_HL_OF(HLcache*, HLenum), HLdouble)
THIMBLE_HL_REFUSED(hlGetShapeBooleanv, THIMBLE_HL_OF(HLuint, HLenum), HLboolean)
THIMBLE_HL_REFUSED(hlGetShapeDoublev, THIMBLE_HL_OF(HLuint, HLenum), HLdouble)
THIMBLE_HL_REFUSED(hlGetMaterialfv, THIMBLE_HL_OF(HLenum, HLenum), HLfloat)
THIMBLE_HL_REFUSED(hlGetEffectdv, THIMBLE_HL_OF(HLuint, HLenum), HLdouble)
THIMBLE_HL_REFUSED(hlGetEffectiv, THIMBLE_HL_OF(HLuint, HLenum), HLint)
THIMBLE_HL_REFUSED(hlGetEffectbv, THIMBLE_HL_OF(HLuint, HLenum), HLboolean)
#undef THIMBLE_HL_REFUSED

}  // extern "C"
