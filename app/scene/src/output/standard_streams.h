#pragma once

#include "thimble/driver/export.h"

namespace thimble::output {

/// Opens /dev/null for each of the descriptors 0, 1 and 2 that is closed. Otherwise the next opened
/// file or device would become standard output or error and receive printed text. Must be the first
/// call of a program. Returns false if /dev/null cannot be opened.
THIMBLE_EXPORT bool open_standard_streams() noexcept;

}  // namespace thimble::output
