#include <array>

#include "study/study.h"
#include "study/study_cost.h"
#include "study/study_integrators.h"

namespace thimble::app {
namespace {

constexpr std::array kStudies{
    Study{"cost", "what each way of contact and each effect costs per tick, and what it buys",
          study_cost},
    Study{"integrators", "what each integrator of bodies costs per tick, and how wrong it is",
          study_integrators},
};

}  // namespace

std::span<const Study> studies() {
  return kStudies;
}

}  // namespace thimble::app
