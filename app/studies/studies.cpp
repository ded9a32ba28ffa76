#include <array>

#include "studies/cost/study_cost.h"
#include "studies/friction/study_friction.h"
#include "studies/integrators/study_integrators.h"
#include "studies/study.h"
#include "studies/study_box.h"
#include "studies/study_texture.h"
#include "studies/world/study_world.h"

namespace thimble::studies {
namespace {

constexpr std::array kStudies{
    Study{"cost", "cost per tick of each tracker and effect, and their effect on the force",
          study_cost},
    Study{"friction", "limit cycles of friction models on coarse encoders", study_friction},
    Study{"texture", "spectrum of a stroke over each texture, compared with the requested waves",
          study_texture},
    Study{"box", "force over a square for both kinds of box (Fig. 2 of the paper)", study_box},
    Study{"world", "seam, corner and groove: one proxy for all objects, compared with one for each",
          study_world},
    Study{"integrators", "cost per tick and error of each integrator of deformable bodies",
          study_integrators},
    Study{"accuracy", "error and cost of every approximation, on one page", nullptr},
    Study{"gating",
          "effects of the simulated arm that a scene does not need, and the time saved "
          "without them",
          nullptr},
    Study{"stability", "stability limits of walls on an arm, by formula and by simulation",
          nullptr},
    Study{"trouble",
          "thousands of random scenes and hands, checked for faults, energy and limit "
          "cycles",
          nullptr},
};

}  // namespace

std::span<const Study> studies() {
  return kStudies;
}

}  // namespace thimble::studies
