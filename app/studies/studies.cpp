#include <array>

#include "studies/cost/study_cost.h"
#include "studies/friction/study_friction.h"
#include "studies/integrators/study_integrators.h"
#include "studies/study.h"
#include "studies/study_box.h"
#include "studies/study_texture.h"

namespace thimble::studies {
namespace {

constexpr std::array kStudies{
    Study{"cost", "what each tracker and each effect costs per tick, and what it buys", study_cost},
    Study{"friction", "limit cycles of friction on coarse encoders, and what cures them",
          study_friction},
    Study{"texture", "whether a stroke over a texture feels the waves that were asked for",
          study_texture},
    Study{"box", "the paper's Fig. 2: the force over a square, in both forms of the box",
          study_box},
    Study{"integrators", "what each integrator of bodies costs per tick, and how wrong it is",
          study_integrators},
    Study{"accuracy", "what accuracy costs in time: a diagram for every knob, on one page",
          nullptr},
    Study{"gating",
          "which effects of the simulated arm a scene could do without, and what that saves",
          nullptr},
    Study{"stability", "where walls are stable on an arm: the laws, and the simulated loop",
          nullptr},
    Study{"trouble", "random scenes and hands by the thousand: nothing may go wrong in any",
          nullptr},
};

}  // namespace

std::span<const Study> studies() {
  return kStudies;
}

}  // namespace thimble::studies
