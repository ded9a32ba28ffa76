#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace thimble::render {

/// Returns the first `most` bytes of a file in a ZIP archive: the one whose name ends in `ending`,
/// the first of several; empty if there is none or it cannot be unpacked. Reads archives of one
/// volume below 4 GiB, stored or deflated [PKWARE, APPNOTE 4.3]. Real-time: never from the servo
/// thread.
std::string begin_of_zip_entry(std::string_view archive, std::string_view ending, std::size_t most);

}  // namespace thimble::render
