#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// Search locations of the scanned meshes of Debian's package libcgal-demo (`cgal:NAME` in scenes).
struct ScanPlaces {
  std::vector<std::filesystem::path> folders;  ///< Folders of meshes, in search order.
  std::filesystem::path archive;               ///< Archive of the package; empty: not used.
  /// Folder into which the archive is unpacked on first use; searched last.
  std::filesystem::path unpacked;
};

/// Returns the search locations of scans. If THIMBLE_MESHES is set in the environment, only that
/// folder is searched. Otherwise these are build/meshes of the sources from which the program was
/// built, meshes/ in each folder of `data_folders`, and $XDG_CACHE_HOME/thimble/meshes. The
/// package's archive /usr/share/doc/libcgal-dev/data.tar.gz is unpacked into the last. Real-time:
/// never from the servo thread.
THIMBLE_EXPORT ScanPlaces scan_places();

/// Returns the file of a scan ("elephant.off"). Unpacks the archive if no folder contains the scan
/// and nothing was unpacked before. The error lists the search locations, the package to install,
/// and a scene that needs no scan. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::filesystem::path> find_scan(
    const std::string& name, const ScanPlaces& places = scan_places());

}  // namespace thimble::scene
