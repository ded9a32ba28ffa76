#include "body/shape/print_refinement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <tuple>

#include "mesh/closest_point.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Maximum length of the path from a triangle that is too coarse to a triangle whose longest edge is
// also that of its neighbour. If the path is longer, the edge reached is split. [chosen; 3 on
// scans]
constexpr int kPathMax = 16;

// Narrower triangles, as twice the area over the square of the longest edge, are not split: their
// parts would be rounding. [chosen]
constexpr double kNarrow = 1e-4;

// Minimum length of a new edge, as a share of the requested one; narrower triangles stay. [chosen]
constexpr double kShort = 0.125;

// A press that has moved this far, in edges, starts a new search. A press that stays starts one
// after this number of ticks, since the print grows. [chosen]
constexpr double kGone = 0.25;
constexpr int kAgain = 32;

// The triangles of the mesh on its first shape. A print has its nominal smoothness over that, and
// walls of a pit, however steep, need no more triangles than its floor.
struct FirstShape {
  const ContactMesh& mesh;
  std::span<const Vector3d> places;

  const Vector3d& at(std::int32_t vertex) const { return places[static_cast<std::size_t>(vertex)]; }
  const Vector3d& at(std::int32_t triangle, std::size_t k) const {
    return at(mesh.corners(triangle)[k]);
  }
};

// An edge's length and numbers, so that edges of equal length have a definite order.
using Length = std::tuple<double, std::int32_t, std::int32_t>;

Length length_of(const FirstShape& shape, std::int32_t triangle, std::size_t k) {
  const std::int32_t a = shape.mesh.corners(triangle)[k];
  const std::int32_t b = shape.mesh.corners(triangle)[(k + 1) % 3];
  // From the same end in all calls, so that both triangles at the edge compute the same length.
  const std::int32_t low = std::min(a, b);
  const std::int32_t high = std::max(a, b);
  return {(shape.at(high) - shape.at(low)).squaredNorm(), low, high};
}

std::size_t longest_edge(const FirstShape& shape, std::int32_t triangle) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (length_of(shape, triangle, k) > length_of(shape, triangle, longest)) longest = k;
  }
  return longest;
}

bool narrow(const FirstShape& shape, std::int32_t triangle, double squared) {
  const Vector3d& a = shape.at(triangle, 0);
  const double area = (shape.at(triangle, 1) - a).cross(shape.at(triangle, 2) - a).norm();
  // Written so that NaN counts as narrow.
  return !(area > kNarrow * squared);
}

// Returns whether splitting an edge would make one shorter than `least` m, to the opposite corners.
bool makes_short(const FirstShape& shape, std::int32_t triangle, std::size_t k, double least) {
  const Vector3d middle = (shape.at(triangle, k) + shape.at(triangle, (k + 1) % 3)) / 2;
  for (const std::int32_t t : {triangle, shape.mesh.cell(triangle).neighbours[k]}) {
    for (const std::int32_t corner : shape.mesh.corners(t)) {
      if ((shape.at(corner) - middle).squaredNorm() < least * least) return true;
    }
  }
  return false;
}

}  // namespace

PrintRefinement::PrintRefinement(double edge, double radius, std::size_t triangles_max)
    : edge_(edge), reach_(radius + edge), seen_(triangles_max, 0) {
  queue_.reserve(triangles_max);
}

void PrintRefinement::add(std::int32_t triangle) noexcept {
  std::uint32_t& seen = seen_[static_cast<std::size_t>(triangle)];
  if (seen == round_) return;
  seen = round_;
  queue_.push_back(triangle);
}

void PrintRefinement::press(std::int32_t triangle, const Vector3d& p_first) noexcept {
  looks_ = 0;
  splits_ = 0;
  p_first_ = p_first;
  const bool gone = !((p_first - p_begun_).squaredNorm() < kGone * kGone * edge_ * edge_);
  if (next_ < queue_.size()) return;
  if (round_ > 0 && !gone && !split_any_ && ++idle_ < kAgain) return;
  idle_ = 0;
  if (++round_ == 0) {
    std::fill(seen_.begin(), seen_.end(), 0);
    round_ = 1;
  }
  queue_.clear();
  next_ = 0;
  split_any_ = false;
  p_begun_ = p_first;
  add(triangle);
}

std::optional<EdgeOfTriangle> PrintRefinement::next(
    const ContactMesh& mesh, std::span<const Vector3d> first_places) noexcept {
  const FirstShape shape{mesh, first_places};
  while (next_ < queue_.size() && looks_ < kLooksMax && splits_ < kSplitsMax) {
    ++looks_;
    std::int32_t triangle = queue_[next_];
    const Vector3d nearest = closest_point(p_first_, shape.at(triangle, 0), shape.at(triangle, 1),
                                           shape.at(triangle, 2));
    if (!((nearest - p_first_).squaredNorm() < reach_ * reach_)) {
      ++next_;
      continue;
    }
    std::size_t k = longest_edge(shape, triangle);
    double squared = std::get<0>(length_of(shape, triangle, k));
    if (squared > edge_ * edge_ && !narrow(shape, triangle, squared)) {
      for (int path = 0; path < kPathMax; ++path) {
        const std::int32_t behind = mesh.cell(triangle).neighbours[k];
        const std::size_t longest = longest_edge(shape, behind);
        const Length length = length_of(shape, behind, longest);
        if (!(length > length_of(shape, triangle, k)) ||
            narrow(shape, behind, std::get<0>(length))) {
          break;
        }
        triangle = behind;
        k = longest;
      }
      if (!makes_short(shape, triangle, k, kShort * edge_)) {
        ++splits_;
        return EdgeOfTriangle{triangle, k};
      }
    }
    ++next_;
    for (const std::int32_t behind : mesh.cell(triangle).neighbours) add(behind);
  }
  return std::nullopt;
}

void PrintRefinement::take(const EdgeSplit& split) noexcept {
  if (split.vertex < 0) {
    ++next_;
    return;
  }
  split_any_ = true;
  for (const std::int32_t triangle : split.others) add(triangle);
}

}  // namespace thimble::render
