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
};

}  // namespace

std::span<const Study> studies() {
  return kStudies;
}

}  // namespace thimble::studies
