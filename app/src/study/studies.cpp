#include <array>

#include "study/study.h"
#include "study/study_cost.h"

namespace thimble::app {
namespace {

constexpr std::array kStudies{
    Study{"cost", "what each way of contact and each effect costs per tick, and what it buys",
          study_cost},
};

}  // namespace

std::span<const Study> studies() {
  return kStudies;
}

}  // namespace thimble::app
