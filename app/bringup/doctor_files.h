#pragma once

#include <filesystem>
#include <vector>

#include "bringup/doctor.h"
#include "files/scanned_meshes.h"

namespace thimble::bringup {

/// Lists the folders in which scenes and arms are searched by name, in order; advice if none of
/// them exists. Changes nothing. Real-time: never from the servo thread.
Finding examine_names(const std::vector<std::filesystem::path>& folders);

/// Returns whether the scanned meshes are installed (`cgal:` in scenes), and the order in which
/// they are searched. Unpacks nothing. Real-time: never from the servo thread.
Finding examine_scans(const scene::ScanPlaces& places);

}  // namespace thimble::bringup
