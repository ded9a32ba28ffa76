#pragma once

namespace thimble::compat::dhd {

/// Records a wrong call: the error number for `dhdErrorGetLast` of this thread, and a line for the
/// report of `thimble exec`. Returns -1, the result of such a call.
int fail(const char* function, int error, const char* what) noexcept;

/// Returns the error number of the last wrong call of this thread; DHD_NO_ERROR if there was none.
int last_error() noexcept;

}  // namespace thimble::compat::dhd
