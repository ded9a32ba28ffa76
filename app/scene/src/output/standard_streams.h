#pragma once

#include "thimble/driver/export.h"

namespace thimble::output {

/// Opens /dev/null as each of the descriptors 0, 1 and 2 that is closed. Otherwise the next file or
/// device that is opened becomes standard output or error, and what is printed goes into it. The
/// first call of a program. Returns false if /dev/null cannot be opened.
THIMBLE_EXPORT bool open_standard_streams() noexcept;

}  // namespace thimble::output
