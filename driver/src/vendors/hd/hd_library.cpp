#include "vendors/hd/hd_library.h"

#include <cstdlib>
#include <vector>

#include "vendors/vendor_library.h"

namespace thimble::driver::hd {
namespace {

Result<Library> take(Result<VendorLibrary> opened) {
  if (!opened) return opened.error();
  Library library{.file = opened->file(), .call = {}};
  Functions& call = library.call;
  std::string missing;
  const auto find = [&](const char* name, auto*& function) {
    return opened->find(name, function, missing);
  };
#define THIMBLE_FIND(name) find(#name, call.name)
  const bool whole =
      THIMBLE_FIND(hdInitDevice) && THIMBLE_FIND(hdDisableDevice) && THIMBLE_FIND(hdGetError) &&
      THIMBLE_FIND(hdGetErrorString) && THIMBLE_FIND(hdGetString) && THIMBLE_FIND(hdGetIntegerv) &&
      THIMBLE_FIND(hdGetDoublev) && THIMBLE_FIND(hdSetDoublev) && THIMBLE_FIND(hdEnable) &&
      THIMBLE_FIND(hdStartScheduler) && THIMBLE_FIND(hdStopScheduler) &&
      THIMBLE_FIND(hdScheduleAsynchronous) && THIMBLE_FIND(hdUnschedule) &&
      THIMBLE_FIND(hdBeginFrame) && THIMBLE_FIND(hdEndFrame) && THIMBLE_FIND(hdCheckCalibration) &&
      THIMBLE_FIND(hdUpdateCalibration);
#undef THIMBLE_FIND
  if (whole) return library;
  return Error{library.file + " has no function " + missing +
               ", so it is not the library of OpenHaptics. Install OpenHaptics and its driver."};
}

Result<Library> look() {
  std::vector<std::string> files;
  if (const char* own = std::getenv("THIMBLE_HD_LIBRARY"); own != nullptr && *own != 0) {
    files = {own};
  } else {
    files = {"libHD.so", "libHD.so.3.4", "libHD.so.3.0", "/usr/lib/libHD.so",
             "/usr/local/lib/libHD.so"};
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

}  // namespace thimble::driver::hd
