#pragma once

#include <filesystem>
#include <vector>

#include "bringup/doctor.h"
#include "files/scanned_meshes.h"

namespace thimble::bringup {

/// Returns in which folders scenes and arms are looked for by name, in that order; advice if none
/// of them is there. Changes nothing. Real-time: never from the servo thread.
Finding examine_names(const std::vector<std::filesystem::path>& folders);

/// Returns whether the scanned meshes are there (`cgal:` in scenes), and in which order they are
/// looked for. Unpacks nothing. Real-time: never from the servo thread.
Finding examine_scans(const scene::ScanPlaces& places);

}  // namespace thimble::bringup
