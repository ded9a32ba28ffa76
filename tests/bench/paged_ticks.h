#pragma once

#include <filesystem>
#include <vector>

#include "thimble/session/run_figures.h"

namespace thimble::bench {

/// Times ticks over rings of 10^5, 10^6 and 10^7 triangles on disk (none above `max`), as in
/// virtual time: the pages that a tick asks for are loaded after it. Every tick enters new surface.
/// Adds the tick by itself, the tick with its loading, and their ratio to 10^5: in processor time
/// with the file in the kernel's cache, and in wall-clock time without. Returns false and prints an
/// error if a file cannot be written.
bool time_paged_ticks(const std::filesystem::path& folder, double max,
                      std::vector<session::Figure>& figures);

}  // namespace thimble::bench
