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

/// Texts and facts of pictures beyond the rows.
struct PictureInfo {
  std::string title;  ///< Scene and arm, in a few words.
  bool virtual_time = true;
  double period = 0.001;  ///< Nominal time between ticks, s.
  /// Times between ticks, and computing times of ticks. If null they are computed from the rows,
  /// which is correct only if the rows contain every tick.
  const session::Histogram* period_times = nullptr;
  const session::Histogram* work_times = nullptr;
};

/// Draws a run into `folder`, each picture as PNG and SVG: force_and_depth (over time; only the
/// force if nothing was touched), path_on_mesh (the tip's path over the mesh, coloured by force,
/// from three sides), and in real time period_histogram. Their numbers and scripts go to data/.
///
/// `rows` are records in order of time (world frame, SI), `mesh_W` is the mesh in the world, m.
/// Without rows no picture is drawn. Fails if gnuplot is missing or a file cannot be written.
/// Real-time: never from the servo thread.
driver::Result<void> draw_pictures(std::span<const driver::TickRecord> rows,
                                   const render::TriangleMesh& mesh_W, const PictureInfo& info,
                                   const std::filesystem::path& folder);

/// Draws only a mesh from three sides into the file `picture`, in the format of its ending (.png or
/// .svg). `unit` is the coordinates' unit on the axes. If `faults` are given (those of this mesh),
/// their positions are marked, with a legend. Fails on a mesh without finite vertices, and like
/// `draw_pictures`. Real-time: never from the servo thread.
driver::Result<void> draw_mesh(const render::TriangleMesh& mesh,
                               const std::filesystem::path& picture, const std::string& title = "",
                               const std::string& unit = "unit of the file",
                               const render::MeshFindings* faults = nullptr);

}  // namespace thimble::report
