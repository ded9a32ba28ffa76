#include <array>

#include "study/study.h"

namespace thimble::app {
namespace {

constexpr std::array<Study, 0> kStudies{};

}  // namespace

std::span<const Study> studies() {
  return kStudies;
}

}  // namespace thimble::app
