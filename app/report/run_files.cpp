#include "report/run_files.h"

#include "report/pictures.h"
#include "report/report.h"
#include "setup.h"

namespace thimble::app {

driver::Result<void> write_run_files(const session::Session& session,
                                     const session::RunFigures& figures,
                                     const std::filesystem::path& folder) {
  if (auto written = write_report(figures, folder); !written) return written;
  const PictureInfo info{.title = figures.scene + ", " + figures.arm,
                         .virtual_time = figures.virtual_time,
                         .period = 1 / figures.rate_asked,
                         .period_times = &figures.statistics.period(),
                         .work_times = &figures.statistics.work()};
  auto drawn = draw_pictures(session.ticks(), session.setup().objects().mesh_W(), info, folder);
  if (!drawn) return drawn;
  auto dent = session.deepest_dent();
  if (!dent) return {};
  for (Eigen::Vector3d& vertex : dent->vertices) vertex *= 1e3;
  return draw_mesh(*dent, folder / "dent.png", figures.scene + ": the deepest dent", "mm");
}

}  // namespace thimble::app
