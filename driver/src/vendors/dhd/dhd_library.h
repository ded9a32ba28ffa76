#pragma once

#include <string>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::driver::dhd {

// Force Dimension's library, by the names and types that open clients call [S CHAI3D
// CDeltaDevices.cpp, HAPI ForceDimensionHapticsDevice, ICube fd_effort_hi.cpp,
// sawForceDimensionSDK]. No header of the vendor is needed. Lengths in m, forces in N. The arm's
// number is the last argument; results below 0 are failures.

/// The functions of the library that this driver calls.
struct Functions {
  int (*dhdGetDeviceCount)() = nullptr;
  void (*dhdGetSDKVersion)(int* major, int* minor, int* release, int* revision) = nullptr;
  int (*dhdErrorGetLast)() = nullptr;
  const char* (*dhdErrorGetLastStr)() = nullptr;
  int (*drdOpenID)(char id) = nullptr;
  int (*drdClose)(char id) = nullptr;
  bool (*drdIsInitialized)(char id) = nullptr;
  int (*drdAutoInit)(char id) = nullptr;
  int (*drdStop)(bool leave_force_on, char id) = nullptr;
  const char* (*dhdGetSystemName)(char id) = nullptr;
  bool (*dhdHasWrist)(char id) = nullptr;
  bool (*dhdHasGripper)(char id) = nullptr;
  int (*dhdEnableExpertMode)() = nullptr;
  int (*dhdDisableExpertMode)() = nullptr;
  int (*dhdSetWatchdog)(unsigned char duration, char id) = nullptr;
  int (*dhdGetStatus)(int status[17], char id) = nullptr;
  int (*dhdSetGravityCompensation)(int on, char id) = nullptr;
  int (*dhdSetBrakes)(int on, char id) = nullptr;
  int (*dhdEnableForce)(unsigned char on, char id) = nullptr;
  int (*dhdStop)(char id) = nullptr;
  int (*dhdGetPosition)(double* x, double* y, double* z, char id) = nullptr;
  int (*dhdGetLinearVelocity)(double* x, double* y, double* z, char id) = nullptr;
  int (*dhdGetOrientationFrame)(double frame[3][3], char id) = nullptr;
  int (*dhdGetGripperGap)(double* gap, char id) = nullptr;
  unsigned int (*dhdGetButtonMask)(char id) = nullptr;
  int (*dhdSetForce)(double x, double y, double z, char id) = nullptr;
};

/// The opened library.
struct Library {
  std::string file;     ///< File that was opened.
  std::string version;  ///< Version that it reports ("3.17.5").
  Functions call;       ///< Functions; none of them null.
};

/// Returns the library: the file that THIMBLE_DHD_LIBRARY names, else libdrd.so.3 and its other
/// names, found by the linker or in the vendor's own folder ($FDSDK). It is opened once and never
/// closed. The error states what is missing. Real-time: never from the servo thread.
THIMBLE_EXPORT Result<Library> library();

/// Opens the library of the given file name, like `library`; for tests.
Result<Library> load(const std::string& file);

}  // namespace thimble::driver::dhd
