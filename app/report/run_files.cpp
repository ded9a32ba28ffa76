#include "report/run_files.h"

#include "report/pictures.h"
#include "report/report.h"
#include "setup.h"
#include "share/shared_run.h"

namespace thimble::report {
namespace {

driver::Result<void> write_arm_files(const session::Session& session,
                                     const session::RunFigures& figures,
                                     const std::filesystem::path& folder, std::size_t arm,
                                     const RunPage* page) {
  if (auto written = write_report(figures, folder); !written) return written;
  const std::string whose = session.arms() > 1 ? ", " + session.arm_name(arm) : "";
  const PictureInfo info{.title = figures.scene + ", " + figures.arm + whose,
                         .virtual_time = figures.virtual_time,
                         .period = 1 / figures.requested_rate,
                         .period_times = &figures.statistics.period(),
                         .work_times = &figures.statistics.work()};
  // The path is drawn without the objects if they are too many.
  const session::Setup& setup = session.setup();
  const render::TriangleMesh none;
  const bool fits = session::check_object_count(setup.scene().objects.size()).ok();
  auto drawn = draw_pictures(page != nullptr ? page->ticks(arm) : session.ticks(arm),
                             fits ? setup.objects().mesh_W() : none, info, folder);
  if (!drawn) return drawn;
  auto dent = session.deepest_dent();
  if (!dent) return {};
  for (Eigen::Vector3d& vertex : dent->vertices) vertex *= 1e3;
  return draw_mesh(*dent, folder / "dent.png", figures.scene + ": the deepest dent", "mm");
}

}  // namespace

std::vector<std::string> run_file_names() {
  std::vector<std::string> names{"report.json", "figures.json", "index.html"};
  for (const char* picture : {"dent", "force_and_depth", "path_on_mesh", "period_histogram"}) {
    for (const char* ending : {".png", ".svg"}) names.push_back(std::string(picture) + ending);
  }
  return names;
}

driver::Result<void> write_run_files(const session::Session& session,
                                     const driver::RealTimeGrant& grant,
                                     const std::filesystem::path& folder, const RunPage* page) {
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    const auto own = session.arms() == 1 ? folder : folder / session.arm_name(arm);
    auto written = write_arm_files(session, session.figures(grant, arm), own, arm, page);
    if (!written) return written;
  }
  return {};
}

}  // namespace thimble::report
