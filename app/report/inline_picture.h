#pragma once

#include <filesystem>
#include <string>

namespace thimble::report {

/// Returns an SVG picture as it may stand in a page: without what comes before <svg, and with
/// `mark` put before each of its ids, for those of several pictures in one page must not be the
/// same. Empty if there is none. Real-time: never from the servo thread.
std::string inline_picture(const std::filesystem::path& file, const std::string& mark);

}  // namespace thimble::report
