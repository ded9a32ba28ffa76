#include "vendors/dhd/dhd_library.h"

#include <cstdlib>
#include <utility>
#include <vector>

#include "vendors/vendor_library.h"

namespace thimble::driver::dhd {
namespace {

Result<Library> open(const std::vector<std::string>& files) {
  Library library;
  Functions& call = library.call;
#define THIMBLE_FIND(name) VendorFunction(#name, call.name)
  auto file =
      open_vendor_library(files,
                          {THIMBLE_FIND(dhdGetDeviceCount),
                           THIMBLE_FIND(dhdGetSDKVersion),
                           THIMBLE_FIND(dhdErrorGetLast),
                           THIMBLE_FIND(dhdErrorGetLastStr),
                           THIMBLE_FIND(drdOpenID),
                           THIMBLE_FIND(drdClose),
                           THIMBLE_FIND(drdIsInitialized),
                           THIMBLE_FIND(drdAutoInit),
                           THIMBLE_FIND(drdStop),
                           THIMBLE_FIND(dhdGetSystemName),
                           THIMBLE_FIND(dhdHasWrist),
                           THIMBLE_FIND(dhdHasGripper),
                           THIMBLE_FIND(dhdSetWatchdog),
                           THIMBLE_FIND(dhdEnableExpertMode),
                           THIMBLE_FIND(dhdDisableExpertMode),
                           THIMBLE_FIND(dhdGetStatus),
                           THIMBLE_FIND(dhdSetGravityCompensation),
                           THIMBLE_FIND(dhdSetBrakes),
                           THIMBLE_FIND(dhdEnableForce),
                           THIMBLE_FIND(dhdStop),
                           THIMBLE_FIND(dhdGetPosition),
                           THIMBLE_FIND(dhdGetLinearVelocity),
                           THIMBLE_FIND(dhdGetOrientationFrame),
                           THIMBLE_FIND(dhdGetGripperGap),
                           THIMBLE_FIND(dhdGetButtonMask),
                           THIMBLE_FIND(dhdSetForce)},
                          "the robotics library of Force Dimension. Install libdrd of its SDK.");
#undef THIMBLE_FIND
  if (!file) return file.error();
  library.file = std::move(file).value();
  int version[4] = {0, 0, 0, 0};
  call.dhdGetSDKVersion(&version[0], &version[1], &version[2], &version[3]);
  library.version = std::to_string(version[0]) + '.' + std::to_string(version[1]) + '.' +
                    std::to_string(version[2]);
  return library;
}

Result<Library> look() {
  // The soname has a number [S sofa 3497]; no known version of libdhd has the drd functions.
  std::vector<std::string> files{"libdrd.so.3", "libdrd.so"};
  if (const char* sdk = std::getenv("FDSDK"); sdk != nullptr && *sdk != 0) {
    const std::string folder = std::string(sdk) + "/lib/release/lin-x86_64-gcc/";
    files.push_back(folder + "libdrd.so.3");
    files.push_back(folder + "libdrd.so");
  }
  files.push_back("/usr/local/lib/libdrd.so.3");
  files.push_back("/usr/local/lib/libdrd.so");
  return open(vendor_files("THIMBLE_DHD_LIBRARY", std::move(files)));
}

}  // namespace

Result<Library> library() {
  static const Result<Library> found = look();
  return found;
}

Result<Library> load(const std::string& file) {
  return open({file});
}

}  // namespace thimble::driver::dhd
