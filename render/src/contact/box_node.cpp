#include "thimble/render/contact/box_node.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thimble::render {

StepBox::StepBox() noexcept {
  min.fill(std::numeric_limits<double>::infinity());
  max.fill(-std::numeric_limits<double>::infinity());
}

void StepBox::add(double x, double y, double z) noexcept {
  const std::array<double, 3> p{x, y, z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    min[axis] = std::min(min[axis], p[axis]);
    max[axis] = std::max(max[axis], p[axis]);
  }
}

void StepBox::add(const StepBox& box) noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    min[axis] = std::min(min[axis], box.min[axis]);
    max[axis] = std::max(max[axis], box.max[axis]);
  }
}

void BoxNode::set_boxes(std::span<const StepBox> boxes) noexcept {
  StepBox whole;
  for (const StepBox& box : boxes) whole.add(box);
  double size = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    origin[axis] = static_cast<float>(whole.min[axis]);
    if (static_cast<double>(origin[axis]) > whole.min[axis]) {
      origin[axis] = std::nextafter(origin[axis], -std::numeric_limits<float>::infinity());
    }
    size = std::max(size, whole.max[axis] - static_cast<double>(origin[axis]));
  }
  // The least power of two of which 255 reach over the node; of a node without size, anything.
  constexpr double kUnits = 255;
  int exponent = 0;
  const double share = std::frexp(std::max(size, 0x1p-20) / kUnits, &exponent);
  scale = std::ldexp(1.0f, share > 0.5 ? exponent : exponent - 1);
  const double per_unit = 1 / static_cast<double>(scale);
  sides = {};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto units = [&](double u) noexcept {
        return (u - static_cast<double>(origin[axis])) * per_unit;
      };
      sides[axis][i] =
          static_cast<std::uint8_t>(std::clamp(std::floor(units(boxes[i].min[axis])), 0.0, kUnits));
      sides[3 + axis][i] =
          static_cast<std::uint8_t>(std::clamp(std::ceil(units(boxes[i].max[axis])), 0.0, kUnits));
    }
  }
}

}  // namespace thimble::render
