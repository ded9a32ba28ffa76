#include "bringup/identify/link_inertia/sweep_workspace.h"

#include "bringup/identify/link_inertia/link_equations.h"

namespace thimble::bringup {
namespace {

driver::Result<LinkFit> fit_over(const WorkspaceSweep& over, const scene::ArmFile& file) {
  auto fit = fit_links(std::get<driver::SerialArm>(file.model.geometry), over.motions);
  if (!fit || !fit->links || fit->theta[LinkFit::kMass] > 0) return fit;
  return driver::Error{
      "The fitted mass at the tip is negative: something other than the arm's links moved it."};
}

}  // namespace

driver::Result<WorkspaceSweep> sweep_workspace(BenchArm& bench, const scene::ArmFile& file,
                                               const MotionOrder& order, int places,
                                               const ArmMotion& first, const RemoveEffects& cleaned,
                                               bool stretches, bool held,
                                               const std::atomic<bool>& stop) {
  WorkspaceSweep over;
  if (places == 0) return over;
  if (!file.is<driver::SerialArm>()) {
    over.not_done =
        "available only for arms with a yaw joint and two links; other geometries have no link "
        "model.";
    return over;
  }
  if (stretches) {
    over.not_done = "not measured; cables that stretch hide the motion of the links.";
    return over;
  }
  if (held) {
    over.not_done = "not measured; something holds the tip, so it was not moved to other places.";
    return over;
  }
  // The earlier recording ends here.
  bench.watch({});
  auto motions = record_at_points(bench, file, order, sweep_points(file, places), stop);
  if (!motions) {
    if (stop.load() || bench.fault() != driver::Fault::kNone) return motions.error();
    over.not_done = "not measured. " + motions.error().message;
    return over;
  }
  for (const ArmMotion& motion : *motions) over.motions.push_back(cleaned(motion));
  over.motions.insert(over.motions.begin(), first);
  auto fit = fit_over(over, file);
  if (!fit) {
    over.not_done = "not identified. " + fit.error().message;
    return over;
  }
  over.fit = std::move(fit).value();
  over.not_done.clear();
  return over;
}

driver::Result<void> add_loaded(WorkspaceSweep& over, const ArmMotion& loaded,
                                const scene::ArmFile& file) {
  over.motions.push_back(loaded);
  auto fit = fit_over(over, file);
  if (!fit) return fit.error();
  if (!fit->links) {
    return driver::Error{
        "The motion with the known mass does not fit the links identified without it. Fix the mass "
        "so that it does not swing."};
  }
  over.fit = std::move(fit).value();
  return {};
}

ArmMotion without_link_inertia(const ArmMotion& motion, const LinkFit& fit) {
  ArmMotion cleaned = motion;
  cleaned.links = fit.theta.segment<LinkEquations::kCount>(LinkFit::kInertia) /
                  (fit.theta[LinkFit::kMass] + motion.added_mass);
  return cleaned;
}

}  // namespace thimble::bringup
