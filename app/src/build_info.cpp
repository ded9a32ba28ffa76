#include "build_info.h"

namespace thimble::app {

BuildInfo build_info() {
  return {THIMBLE_VERSION, THIMBLE_COMPILER, THIMBLE_BUILD_TYPE, THIMBLE_REVISION};
}

}  // namespace thimble::app
