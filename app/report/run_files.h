#pragma once

#include <filesystem>

#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::app {

/// Writes what a run that is over leaves in `folder`: report.json and figures.json (write_report),
/// the pictures (draw_pictures) and, of a scene that was dented, dent.png. `figures` are those of
/// `session`. Fails, naming the file, if that cannot be done. Real-time: never from the servo
/// thread.
driver::Result<void> write_run_files(const session::Session& session,
                                     const session::RunFigures& figures,
                                     const std::filesystem::path& folder);

}  // namespace thimble::app
