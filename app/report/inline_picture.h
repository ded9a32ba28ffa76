#pragma once

#include <filesystem>
#include <string>

namespace thimble::report {

/// Returns an SVG picture for inclusion in an HTML page: without the content before <svg, and with
/// `mark` before each of its ids, which must be unique in a page with several pictures. Empty if
/// there is none. Real-time: never from the servo thread.
std::string inline_picture(const std::filesystem::path& file, const std::string& mark);

}  // namespace thimble::report
