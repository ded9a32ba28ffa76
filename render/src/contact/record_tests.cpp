#include "contact/record_tests.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Sums of products of three factors as below are wrong by less than 2^-48 of the product of the
// largest factors, and by less than eight times what one factor is wrong by.
constexpr double kRounding = 0x1p-48;
constexpr double kSpread = 16;

int sign_beyond(double value, double bound) noexcept {
  return value > bound ? 1 : value < -bound ? -1 : 0;
}

}  // namespace

SegmentTest::SegmentTest(const CompactSurface& surface, const Vector3d& p_from,
                         const Vector3d& p_to) noexcept
    : surface_(surface),
      p_from_(p_from),
      p_to_(p_to),
      from_(surface.to_lattice(p_from)),
      way_(surface.to_lattice(p_to) - from_),
      way_size_(way_.cwiseAbs().maxCoeff()) {
  // What `crossing` sees are positions in W, rounded at the size of their coordinates.
  const double size = std::max({p_from.cwiseAbs().maxCoeff(), p_to.cwiseAbs().maxCoeff(),
                                surface.origin().cwiseAbs().maxCoeff()});
  position_rounding_ = 0x1p-50 * (size / surface.step() + kLatticeHalf);
  const auto whole = [](double u) noexcept {
    return static_cast<std::int32_t>(std::clamp(u, -2 * kLatticeHalf, 2 * kLatticeHalf - 1));
  };
  const double room = 2 + 4 * position_rounding_;
  for (int i = 0; i < 3; ++i) {
    const double begin = from_[i], end = from_[i] + way_[i];
    low_[static_cast<std::size_t>(i)] = whole(std::min(begin, end) - room);
    high_[static_cast<std::size_t>(i)] = whole(std::max(begin, end) + room);
  }
}

Crossing SegmentTest::cross(std::int32_t t, double& parameter) const noexcept {
  const CompactTriangle& record = surface_.record(t);
  const Vector3d a = record.corner(0) - from_;
  const Vector3d b = record.corner(1) - from_;
  const Vector3d c = record.corner(2) - from_;
  const double size =
      std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
  const double reach = size + way_size_;
  const double bound = kSpread * (position_rounding_ + kRounding * reach) * size * reach;
  const int s0 = sign_beyond(way_.dot(a.cross(b)), bound);
  const int s1 = sign_beyond(way_.dot(b.cross(c)), bound);
  const int s2 = sign_beyond(way_.dot(c.cross(a)), bound);
  if (s0 * s1 < 0 || s1 * s2 < 0 || s2 * s0 < 0) return Crossing::kNone;
  const Vector3d n = (b - a).cross(c - a);
  const double above = -n.dot(a);
  const double below = n.dot(a - way_);
  const bool sure = s0 != 0 && s1 != 0 && s2 != 0;
  const int from = sign_beyond(above, 8 * bound);
  const int to = -sign_beyond(below, 8 * bound);
  if (from * to > 0) return Crossing::kNone;
  Crossing way = from > 0 ? Crossing::kEnters : Crossing::kLeaves;
  if (!sure || from == 0 || to == 0) {
    way = crossing(p_from_, p_to_, surface_.position(t, 0), surface_.position(t, 1),
                   surface_.position(t, 2));
  }
  if (way == Crossing::kNone) return way;
  // Rounding may make either end seem to lie on the other side: such a crossing is at that end.
  const double sign = way == Crossing::kEnters ? 1 : -1;
  parameter = 0;
  if (sign * above > 0) parameter = sign * below > 0 ? above / (above + below) : 1;
  return way;
}

ReachedPart reached_part(const Vector3d& from, const Vector3d& way) noexcept {
  const double size = std::max(from.cwiseAbs().maxCoeff(), (from + way).cwiseAbs().maxCoeff());
  const double half = kLatticeHalf + 0x1p12 + 0x1p-48 * size;
  double begin = 0, end = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (!(std::abs(from[axis]) <= half)) return {};
      continue;
    }
    const double one = (-half - from[axis]) / way[axis];
    const double other = (half - from[axis]) / way[axis];
    begin = std::max(begin, std::min(one, other));
    end = std::min(end, std::max(one, other));
  }
  if (!(begin <= end)) return {};
  ReachedPart part;
  part.any = true;
  part.begin = begin;
  part.length = end - begin;
  part.from = (from + begin * way).cast<float>();
  part.way = (part.length * way).cast<float>();
  return part;
}

}  // namespace thimble::render
