#include "bringup/identify/link_inertia/look_over_places.h"

#include "bringup/identify/link_inertia/link_equations.h"

namespace thimble::bringup {
namespace {

driver::Result<LinkFit> fit_over(const OverPlaces& over, const scene::ArmFile& file) {
  auto fit = fit_links(std::get<driver::SerialArm>(file.model.geometry), over.motions);
  if (!fit || !fit->links || fit->theta[LinkFit::kMass] > 0) return fit;
  return driver::Error{
      "The mass at the tip came out below zero: something else than the arm's own links moved it."};
}

}  // namespace

driver::Result<OverPlaces> look_over_places(BenchArm& bench, const scene::ArmFile& file,
                                            const MotionOrder& order, int places,
                                            const ArmMotion& first, const FreedMotion& freed,
                                            bool stretches, bool held,
                                            const std::atomic<bool>& stop) {
  OverPlaces over;
  if (places == 0) return over;
  if (!file.is<driver::SerialArm>()) {
    over.not_done = "only for arms of a yaw and two links; links of other builds have no model.";
    return over;
  }
  if (stretches) {
    over.not_done =
        "not done, for behind cables that stretch the links' own motion is not seen well enough.";
    return over;
  }
  if (held) {
    over.not_done = "not done, for something holds the tip, which was not led away from it.";
    return over;
  }
  // The earlier recording ends here.
  bench.watch({});
  auto motions = record_places(bench, file, order, places_in(file, places), stop);
  if (!motions) {
    if (stop.load() || bench.fault() != driver::Fault::kNone) return motions.error();
    over.not_done = "not done. " + motions.error().message;
    return over;
  }
  for (const ArmMotion& motion : *motions) over.motions.push_back(freed(motion));
  over.motions.insert(over.motions.begin(), first);
  auto fit = fit_over(over, file);
  if (!fit) {
    over.not_done = "not told. " + fit.error().message;
    return over;
  }
  over.fit = std::move(fit).value();
  over.not_done.clear();
  return over;
}

driver::Result<void> add_loaded(OverPlaces& over, const ArmMotion& loaded,
                                const scene::ArmFile& file) {
  over.motions.push_back(loaded);
  auto fit = fit_over(over, file);
  if (!fit) return fit.error();
  if (!fit->links) {
    return driver::Error{
        "The motion with the known mass is not that of the arm whose links were seen without it: "
        "fix the mass so that it does not swing."};
  }
  over.fit = std::move(fit).value();
  return {};
}

ArmMotion freed_of_links(const ArmMotion& motion, const LinkFit& fit) {
  ArmMotion freed = motion;
  freed.links = fit.theta.segment<LinkEquations::kCount>(LinkFit::kInertia) /
                (fit.theta[LinkFit::kMass] + motion.added_mass);
  return freed;
}

}  // namespace thimble::bringup
