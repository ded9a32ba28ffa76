#pragma once

#include <string>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::driver::hd {

// The library of OpenHaptics (HDAPI), by the names, types and numbers that open clients use [S
// pyOpenHaptics hd_define.py; CHAI3D hdPhantom.cpp; sawSensablePhantom mtsSensableHD.cpp]. No
// header of the vendor is needed. Lengths in mm, forces in N, transforms column by column; x right,
// y up, z to the user.

inline constexpr unsigned kNoDevice = 0xFFFFFFFF;
inline constexpr unsigned kButtons = 0x2000, kPosition = 0x2050, kVelocity = 0x2051,
                          kTransform = 0x2052, kModel = 0x2501, kVersion = 0x2500,
                          kCalibrationStyle = 0x2555, kNominalMaxForce = 0x2603, kForce = 0x2700,
                          kForceOutput = 0x4000, kCalibrated = 0x5000;
inline constexpr unsigned kStyleEncoderReset = 1, kStyleAuto = 2, kStyleInkwell = 4;
inline constexpr unsigned kCallbackDone = 0, kCallbackContinue = 1;
inline constexpr unsigned short kFirstPriority = 0xFFFF;
// Errors: forces that the arm cannot give, a missing device, faulty frames.
inline constexpr unsigned kWarmMotors = 0x0200, kForceError = 0x0204, kDeviceFault = 0x0300,
                          kTimerError = 0x0304;

/// An error of the library, which it returns by value.
struct ErrorInfo {
  unsigned code = 0;    ///< 0: none.
  int internal = 0;     ///< Internal number of the vendor.
  unsigned device = 0;  ///< Device of the error.
};

/// The functions of the library that this driver calls.
struct Functions {
  unsigned (*hdInitDevice)(const char* name) = nullptr;
  void (*hdDisableDevice)(unsigned device) = nullptr;
  ErrorInfo (*hdGetError)() = nullptr;
  const char* (*hdGetErrorString)(unsigned code) = nullptr;
  const char* (*hdGetString)(unsigned name) = nullptr;
  void (*hdGetIntegerv)(unsigned name, int* values) = nullptr;
  void (*hdGetDoublev)(unsigned name, double* values) = nullptr;
  void (*hdSetDoublev)(unsigned name, const double* values) = nullptr;
  void (*hdEnable)(unsigned capability) = nullptr;
  void (*hdStartScheduler)() = nullptr;
  void (*hdStopScheduler)() = nullptr;
  unsigned long (*hdScheduleAsynchronous)(unsigned (*call)(void*), void* data,
                                          unsigned short priority) = nullptr;
  void (*hdUnschedule)(unsigned long handle) = nullptr;
  void (*hdBeginFrame)(unsigned device) = nullptr;
  void (*hdEndFrame)(unsigned device) = nullptr;
  unsigned (*hdCheckCalibration)() = nullptr;
  void (*hdUpdateCalibration)(unsigned style) = nullptr;
};

/// The opened library.
struct Library {
  std::string file;  ///< File that was opened.
  Functions call;    ///< Functions; none of them null.
};

/// Returns the library: the file that THIMBLE_HD_LIBRARY names, else libHD.so as the linker finds
/// it. It is opened once and never closed. The error states what is missing. Real-time: never from
/// the servo thread.
THIMBLE_EXPORT Result<Library> library();

/// Opens the library of the given file name, like `library`; for tests.
Result<Library> load(const std::string& file);

}  // namespace thimble::driver::hd
