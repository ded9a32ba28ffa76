#include "vendors/hd/hd_library.h"

#include <utility>
#include <vector>

#include "vendors/vendor_library.h"

namespace thimble::driver::hd {
namespace {

Result<Library> open(const std::vector<std::string>& files) {
  Library library;
  Functions& call = library.call;
#define THIMBLE_FIND(name) VendorFunction(#name, call.name)
  auto file = open_vendor_library(
      files,
      {THIMBLE_FIND(hdInitDevice), THIMBLE_FIND(hdDisableDevice), THIMBLE_FIND(hdGetError),
       THIMBLE_FIND(hdGetErrorString), THIMBLE_FIND(hdGetString), THIMBLE_FIND(hdGetIntegerv),
       THIMBLE_FIND(hdGetDoublev), THIMBLE_FIND(hdSetDoublev), THIMBLE_FIND(hdEnable),
       THIMBLE_FIND(hdStartScheduler), THIMBLE_FIND(hdStopScheduler),
       THIMBLE_FIND(hdScheduleAsynchronous), THIMBLE_FIND(hdUnschedule), THIMBLE_FIND(hdBeginFrame),
       THIMBLE_FIND(hdEndFrame), THIMBLE_FIND(hdCheckCalibration),
       THIMBLE_FIND(hdUpdateCalibration)},
      "the OpenHaptics library. Install OpenHaptics and its driver.");
#undef THIMBLE_FIND
  if (!file) return file.error();
  library.file = std::move(file).value();
  return library;
}

Result<Library> look() {
  return open(vendor_files("THIMBLE_HD_LIBRARY", {"libHD.so", "libHD.so.3.4", "libHD.so.3.0",
                                                  "/usr/lib/libHD.so", "/usr/local/lib/libHD.so"}));
}

}  // namespace

Result<Library> library() {
  static const Result<Library> found = look();
  return found;
}

Result<Library> load(const std::string& file) {
  return open({file});
}

}  // namespace thimble::driver::hd
