#include "search/box_node.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thimble::render {

LatticeAabb::LatticeAabb() noexcept {
  min.fill(std::numeric_limits<double>::infinity());
  max.fill(-std::numeric_limits<double>::infinity());
}

void LatticeAabb::add(double x, double y, double z) noexcept {
  const std::array<double, 3> p{x, y, z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    min[axis] = std::min(min[axis], p[axis]);
    max[axis] = std::max(max[axis], p[axis]);
  }
}

void LatticeAabb::add(const LatticeAabb& box) noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    min[axis] = std::min(min[axis], box.min[axis]);
    max[axis] = std::max(max[axis], box.max[axis]);
  }
}

void BoxNode::set_boxes(std::span<const LatticeAabb> boxes) noexcept {
  LatticeAabb whole;
  for (const LatticeAabb& box : boxes) whole.add(box);
  double size = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    origin[axis] = static_cast<float>(whole.min[axis]);
    if (static_cast<double>(origin[axis]) > whole.min[axis]) {
      origin[axis] = std::nextafter(origin[axis], -std::numeric_limits<float>::infinity());
    }
    size = std::max(size, whole.max[axis] - static_cast<double>(origin[axis]));
  }
  // The least power of two for which 255 units span the node, but at least one step: single
  // precision cannot resolve less.
  constexpr double kUnits = 255;
  int exponent = 0;
  const double share = std::frexp(std::max(size, kUnits) / kUnits, &exponent);
  const float scale = std::ldexp(1.0f, share > 0.5 ? exponent : exponent - 1);
  const auto there = static_cast<std::uint32_t>((1u << boxes.size()) - 1);
  scale_and_children = std::bit_cast<std::uint32_t>(scale) | there;
  const double per_unit = 1 / static_cast<double>(scale);
  for (std::size_t i = 0; i < kChildrenMax; ++i) {
    const LatticeAabb& box = boxes[std::min(i, boxes.size() - 1)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto units = [&](double u) noexcept {
        return std::clamp((u - static_cast<double>(origin[axis])) * per_unit, 0.0, kUnits);
      };
      // Not below 0, so cutting off rounds down.
      const double high = units(box.max[axis]);
      const auto cut = static_cast<int>(high);
      sides[axis][i] = static_cast<std::uint8_t>(static_cast<int>(units(box.min[axis])));
      sides[3 + axis][i] = static_cast<std::uint8_t>(cut + (static_cast<double>(cut) < high));
    }
  }
}

LatticeAabb BoxNode::box() const noexcept {
  LatticeAabb box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto steps = [&](std::uint8_t units) noexcept {
      return static_cast<double>(origin[axis]) + static_cast<double>(scale()) * units;
    };
    box.min[axis] = steps(*std::min_element(sides[axis].begin(), sides[axis].end()));
    box.max[axis] = steps(*std::max_element(sides[3 + axis].begin(), sides[3 + axis].end()));
  }
  return box;
}

}  // namespace thimble::render
