#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "thimble/session/recording.h"

namespace thimble::view {

/// Groups recordings by run, in the order of their first files: those of several arms of a scene
/// are one run. A recording of such an arm joins a run of the same scene, options, rate and length
/// that has no recording of that arm: one whose files have its name but for the arm
/// (session::file_of_arm), or else the first. Each other recording is a run. `files`: one per
/// recording. Returns the indices of each run's recordings. Real-time: never from the servo thread.
std::vector<std::vector<std::size_t>> group_by_run(std::span<const session::Recording> recordings,
                                                   std::span<const std::filesystem::path> files);

/// Returns a name for each file that differs from the others: the name of the file; if that is the
/// same for several, with as many of its folders as necessary, or with a number if the files are
/// the same.
std::vector<std::string> distinct_names(std::span<const std::filesystem::path> files);

}  // namespace thimble::view
