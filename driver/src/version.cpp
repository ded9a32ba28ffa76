#include "thimble/version.h"

namespace thimble {

Version version() noexcept {
  return kVersion;
}

}  // namespace thimble
