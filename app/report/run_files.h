#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/html/touch_page.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::report {

/// Returns the names of what `write_run_files` and the page of a run write in a folder.
std::vector<std::string> run_file_names();

/// Writes what a run that is over leaves in `folder`: report.json and figures.json (write_report),
/// the pictures (draw_pictures) and, of a scene that was dented, dent.png; of several arms into a
/// folder each, by their names. `grant`: what the kernel granted the servo's thread. Fails, naming
/// the file, if that cannot be done. Real-time: never from the servo thread.
///
/// The pictures are drawn of the ticks of `page`, which is finished, if it is not null, else of
/// those that the session keeps.
driver::Result<void> write_run_files(const session::Session& session,
                                     const driver::RealTimeGrant& grant,
                                     const std::filesystem::path& folder,
                                     const RunPage* page = nullptr);

}  // namespace thimble::report
