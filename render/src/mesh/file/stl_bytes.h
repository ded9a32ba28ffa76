#pragma once

#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::render {

/// Turns the bytes of an STL file, as many programs write them, into what its definition says:
/// words of a text in small letters (`SOLID`), no bytes after the last triangle of a binary one.
/// What was put right is added to `notes`. The error says what is wrong with a binary file that
/// ends too early or has no triangles. Real-time: never from the servo thread.
driver::Result<void> put_stl_right(std::string& bytes, std::vector<std::string>& notes);

}  // namespace thimble::render
