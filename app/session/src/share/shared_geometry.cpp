#include "share/shared_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

namespace thimble::session {
namespace {

// Returns the parameters of each geometry that are needed for drawing.
std::vector<double*> numbers_of(driver::SerialArm& g) {
  return {&g.height, &g.length_b, &g.length_c};
}
std::vector<double*> numbers_of(driver::LinkageArm& g) {
  return {&g.length_0, &g.length_1, &g.length_2, &g.length_3, &g.length_4, &g.length_5};
}
std::vector<double*> numbers_of(driver::DeltaArm& g) {
  std::vector<double*> numbers{&g.a, &g.b, &g.c, &g.d, &g.e, &g.f, &g.r, &g.s};
  for (Eigen::Vector2d& outwards : g.outwards) {
    numbers.insert(numbers.end(), {&outwards.x(), &outwards.y()});
  }
  return numbers;
}
std::vector<double*> numbers_of(driver::VendorPoseArm&) {
  return {};
}

std::vector<double*> numbers_of(driver::PaddleArm& g) {
  return {&g.handle};
}
std::vector<double*> numbers_of(driver::FiveBarArm& g) {
  return {&g.base, &g.crank_1, &g.crank_2, &g.distal_1, &g.distal_2};
}
std::vector<double*> numbers_of(driver::CartesianArm& g) {
  return {&g.radius[0], &g.radius[1], &g.radius[2]};
}

std::vector<double*> numbers_of(driver::ArmGeometry& geometry) {
  return std::visit([](auto& build) { return numbers_of(build); }, geometry);
}

/// Returns the geometry at an index of ArmGeometry, with default lengths.
template <std::size_t... Places>
driver::ArmGeometry build_at(std::size_t place, std::index_sequence<Places...>) {
  driver::ArmGeometry geometry;
  ((place == Places ? void(geometry.emplace<Places>()) : void()), ...);
  return geometry;
}

}  // namespace

void put_geometry(const std::optional<driver::ArmGeometry>& geometry, SharedArm& to) {
  to.shape = 0;
  to.numbers.fill(0);
  if (!geometry) return;
  driver::ArmGeometry copy = *geometry;
  to.shape = static_cast<std::uint32_t>(copy.index()) + 1;
  const auto numbers = numbers_of(copy);
  std::transform(numbers.begin(), numbers.end(), to.numbers.begin(),
                 [](const double* number) { return *number; });
}

bool take_geometry(const SharedArm& shared, std::optional<driver::ArmGeometry>& geometry) {
  constexpr std::size_t kBuilds = std::variant_size_v<driver::ArmGeometry>;
  const bool finite = std::all_of(shared.numbers.begin(), shared.numbers.end(),
                                  [](double number) { return std::isfinite(number); });
  if (!finite || shared.shape > kBuilds) return false;
  geometry.reset();
  if (shared.shape == 0) return true;
  geometry = build_at(shared.shape - 1, std::make_index_sequence<kBuilds>());
  const auto numbers = numbers_of(*geometry);
  for (std::size_t i = 0; i < numbers.size(); ++i) *numbers[i] = shared.numbers[i];
  return true;
}

}  // namespace thimble::session
