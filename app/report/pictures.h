#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/session/histogram.h"

namespace thimble::report {

/// What pictures say beside what they show.
struct PictureInfo {
  std::string title;  ///< Scene and arm, in a few words.
  bool virtual_time = true;
  double period = 0.001;  ///< Wanted time between ticks, s.
  /// Times between ticks, and times that ticks took. Where null they are taken from the rows, which
  /// is right only if the rows hold every tick.
  const session::Histogram* period_times = nullptr;
  const session::Histogram* work_times = nullptr;
};

/// Draws a run into `folder`, each picture as PNG and SVG: force_and_depth (over time;
/// force alone where nothing was touched),
/// path_on_mesh (the tip's path over the mesh, coloured by force, from three sides), and in the
/// time of the world period_histogram. Numbers and scripts behind them go to data/.
///
/// `rows` are records in order of time (world frame, SI), `mesh_W` is the mesh in the world, m. No
/// rows draw no picture. Fails if gnuplot is missing or a file cannot be written.
/// Real-time: never from the servo thread.
driver::Result<void> draw_pictures(std::span<const driver::TickRecord> rows,
                                   const render::TriangleMesh& mesh_W, const PictureInfo& info,
                                   const std::filesystem::path& folder);

/// Draws a mesh alone from three sides into the file `picture`, whose ending (.png or .svg) tells
/// the format. `unit` names the coordinates' unit on the axes. Where `faults` are given (those of
/// this mesh) their places are marked, with a legend. Fails on a mesh without finite vertices, and
/// like `draw_pictures`. Real-time: never from the servo thread.
driver::Result<void> draw_mesh(const render::TriangleMesh& mesh,
                               const std::filesystem::path& picture, const std::string& title = "",
                               const std::string& unit = "unit of the file",
                               const render::MeshFindings* faults = nullptr);

}  // namespace thimble::report
