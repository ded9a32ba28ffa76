#pragma once

#include <HD/hd.h>

namespace thimble::compat::hd {

/// Keeps an error for hdGetError; the oldest is discarded if there are too many.
void record_error(HDerror error, HHD device, int internal = 0) noexcept;

/// Keeps an error of a wrong call, and counts it for the report of `thimble exec`.
void record_wrong_call(HDerror error, const char* function, const char* what) noexcept;

}  // namespace thimble::compat::hd
