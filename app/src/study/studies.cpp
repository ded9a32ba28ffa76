#include <array>

#include "study/study.h"
#include "study/study_cost.h"
#include "study/study_friction.h"

namespace thimble::app {
namespace {

constexpr std::array kStudies{
    Study{"cost", "what each way of contact and each effect costs per tick, and what it buys",
          study_cost},
    Study{"friction", "how friction trembles on coarse encoders, and which ways cure it",
          study_friction},
};

}  // namespace

std::span<const Study> studies() {
  return kStudies;
}

}  // namespace thimble::app
