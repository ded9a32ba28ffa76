#include "vendors/dhd/dhd_library.h"

#include <cstdlib>
#include <utility>
#include <vector>

#include "vendors/vendor_library.h"

namespace thimble::driver::dhd {
namespace {

Result<Library> take(Result<VendorLibrary> opened) {
  if (!opened) return opened.error();
  Library library{.file = opened->file(), .version = {}, .call = {}};
  Functions& call = library.call;
  std::string missing;
  const auto find = [&](const char* name, auto*& function) {
    return opened->find(name, function, missing);
  };
#define THIMBLE_FIND(name) find(#name, call.name)
  const bool whole =
      THIMBLE_FIND(dhdGetDeviceCount) && THIMBLE_FIND(dhdGetSDKVersion) &&
      THIMBLE_FIND(dhdErrorGetLast) && THIMBLE_FIND(dhdErrorGetLastStr) &&
      THIMBLE_FIND(drdOpenID) && THIMBLE_FIND(drdClose) && THIMBLE_FIND(drdIsInitialized) &&
      THIMBLE_FIND(drdAutoInit) && THIMBLE_FIND(drdStop) && THIMBLE_FIND(dhdGetSystemName) &&
      THIMBLE_FIND(dhdHasWrist) && THIMBLE_FIND(dhdHasGripper) && THIMBLE_FIND(dhdSetWatchdog) &&
      THIMBLE_FIND(dhdEnableExpertMode) && THIMBLE_FIND(dhdDisableExpertMode) &&
      THIMBLE_FIND(dhdGetStatus) && THIMBLE_FIND(dhdSetGravityCompensation) &&
      THIMBLE_FIND(dhdSetBrakes) && THIMBLE_FIND(dhdEnableForce) && THIMBLE_FIND(dhdStop) &&
      THIMBLE_FIND(dhdGetPosition) && THIMBLE_FIND(dhdGetLinearVelocity) &&
      THIMBLE_FIND(dhdGetOrientationFrame) && THIMBLE_FIND(dhdGetGripperGap) &&
      THIMBLE_FIND(dhdGetButtonMask) && THIMBLE_FIND(dhdSetForce);
#undef THIMBLE_FIND
  if (!whole) {
    return Error{library.file + " has no function " + missing +
                 ", so it is not Force Dimension's robotics library. Install the SDK's libdrd."};
  }
  int version[4] = {0, 0, 0, 0};
  call.dhdGetSDKVersion(&version[0], &version[1], &version[2], &version[3]);
  library.version = std::to_string(version[0]) + '.' + std::to_string(version[1]) + '.' +
                    std::to_string(version[2]);
  return library;
}

Result<Library> look() {
  std::vector<std::string> files;
  if (const char* own = std::getenv("THIMBLE_DHD_LIBRARY"); own != nullptr && *own != 0) {
    files = {own};
  } else {
    // The soname has a number [S sofa 3497]; libdhd has the drd functions in no version known.
    files = {"libdrd.so.3", "libdrd.so"};
    if (const char* sdk = std::getenv("FDSDK"); sdk != nullptr && *sdk != 0) {
      const std::string folder = std::string(sdk) + "/lib/release/lin-x86_64-gcc/";
      files.push_back(folder + "libdrd.so.3");
      files.push_back(folder + "libdrd.so");
    }
    files.push_back("/usr/local/lib/libdrd.so.3");
    files.push_back("/usr/local/lib/libdrd.so");
  }
  return take(VendorLibrary::open(files));
}

}  // namespace

Result<Library> library() {
  static const Result<Library> found = look();
  return found;
}

Result<Library> load(const std::string& file) {
  return take(VendorLibrary::open(std::vector<std::string>{file}));
}

}  // namespace thimble::driver::dhd
