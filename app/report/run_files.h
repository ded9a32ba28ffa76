#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/html/touch_page.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::report {

/// Returns the names of the files that `write_run_files` and the page of a run write into a folder.
std::vector<std::string> run_file_names();

/// Writes the files of a finished run into `folder`: report.json and figures.json (write_report),
/// the pictures (draw_pictures) and, if the scene was dented, dent.png. With several arms, each
/// gets a folder with its name. `grant`: the priority that the kernel granted to the servo thread.
/// The error names the file. Real-time: never from the servo thread.
///
/// The pictures show the ticks of `page`, which is finished, if it is not null, otherwise those
/// kept by the session.
driver::Result<void> write_run_files(const session::Session& session,
                                     const driver::RealTimeGrant& grant,
                                     const std::filesystem::path& folder,
                                     const RunPage* page = nullptr);

}  // namespace thimble::report
