#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// Where the scanned meshes of Debian's package libcgal-demo are looked for (`cgal:NAME` in
/// scenes).
struct ScanPlaces {
  std::vector<std::filesystem::path> folders;  ///< Folders of meshes, the first first.
  std::filesystem::path archive;   ///< The package's own archive of them; empty: not looked for.
  std::filesystem::path unpacked;  ///< Where that is unpacked on first use; searched last.
};

/// Returns where this program looks for scans. With THIMBLE_MESHES in the environment that folder
/// alone; else build/meshes of the sources that it was built in, meshes/ below each folder of
/// `data_folders`, and $XDG_CACHE_HOME/thimble/meshes, into which the package's archive
/// /usr/share/doc/libcgal-dev/data.tar.gz is unpacked. Real-time: never from the servo thread.
THIMBLE_EXPORT ScanPlaces scan_places();

/// Returns the file of a scan ("elephant.off"), after unpacking the archive if the scan is in no
/// folder and nothing was unpacked before. The error says where it was looked for, what to install,
/// and which scene needs none. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::filesystem::path> find_scan(
    const std::string& name, const ScanPlaces& places = scan_places());

}  // namespace thimble::scene
