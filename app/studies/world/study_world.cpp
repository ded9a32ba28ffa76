#include "studies/world/study_world.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "log/logger.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "studies/world/world_pictures.h"
#include "studies/world/world_touches.h"

namespace thimble::studies {
namespace {

/// Returns the columns of one tick: tip and proxy in mm, force in N, each along x and z.
std::string columns(const WorldTick& tick) {
  return fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", 1e3 * tick.p_WT.x(),
                     1e3 * tick.p_WT.z(), 1e3 * tick.p_WP.x(), 1e3 * tick.p_WP.z(), tick.f_T_W.x(),
                     tick.f_T_W.z());
}

/// Two touches of equal length, row by row.
std::string pair_table(const std::string& first, const std::vector<WorldTick>& a,
                       const std::string& second, const std::vector<WorldTick>& b) {
  std::string table =
      "# tip x mm, tip z mm, proxy x mm, proxy z mm, force x N, force z N: " + first +
      "; the same six: " + second + "\n";
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    table += columns(a[i]) + "," + columns(b[i]) + "\n";
  }
  return table;
}

/// Returns the largest deviation from the force of one flat floor, N.
double floor_error(const std::vector<WorldTick>& ticks) {
  double worst = 0;
  for (const WorldTick& tick : ticks) {
    const Eigen::Vector3d f(0, 0, kWorldStiffness * kSeamDepth);
    worst = std::max(worst, (tick.f_T_W - f).norm());
  }
  return worst;
}

}  // namespace

driver::Result<std::vector<session::Figure>> study_world(const std::filesystem::path& folder) {
  const WorldTouches touches{slide_over_seam(), slide_against_block(), press_into_groove(0),
                             press_into_groove(kGrooveRadius)};
  const auto& [seam, block, point, ball] = touches;

  if (auto made = report::make_picture_folder(folder); !made) return made.error();
  const std::string alone = "each object alone, forces added", together = "one proxy for all";
  for (const auto& [name, table] :
       {std::pair{"seam.csv", pair_table(alone, seam.alone, together, seam.together)},
        std::pair{"block.csv", pair_table(alone, block.alone, together, block.together)},
        std::pair{"groove.csv", pair_table("point", point, "ball", ball)}}) {
    if (auto written = report::write_text(table, folder / name); !written) return written.error();
  }
  if (!report::has_gnuplot()) {
    scene::logger().warn(
        "NO PICTURES: gnuplot is not installed (apt install gnuplot-nox). Tables and figures are "
        "complete.");
  } else if (auto drawn = draw_world(touches, folder); !drawn) {
    return drawn.error();
  }

  const auto height_error = [](const std::vector<WorldTick>& ticks, double radius) {
    const double rest = radius / std::sin(kGrooveHalfAngle);
    return (ticks.back().p_WP - Eigen::Vector3d(0, ticks.back().p_WP.y(), rest)).norm();
  };
  // A tip that stops in the corner is pressed by hand and surface in series.
  return std::vector<session::Figure>{
      {"seam_together_force_error", floor_error(seam.together), "N", "<= 1e-9"},
      {"seam_alone_force_error", floor_error(seam.alone), "N", ""},
      {"block_together_sideways", -block.together.back().f_T_W.x(), "N", ">= 2.4"},
      {"block_together_proxy_error",
       std::hypot(block.together.back().p_WP.x(), block.together.back().p_WP.z()), "m", "<= 1e-9"},
      {"block_alone_sideways", std::abs(block.alone.back().f_T_W.x()), "N", ""},
      {"block_alone_depth_below_block", block.alone.back().p_WP.x(), "m", ""},
      {"groove_point_place_error", height_error(point, 0), "m", "<= 1e-9"},
      {"groove_ball_place_error", height_error(ball, kGrooveRadius), "m", "<= 1e-9"}};
}

}  // namespace thimble::studies
