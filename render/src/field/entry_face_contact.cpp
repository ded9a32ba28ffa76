#include "field/entry_face_contact.h"

#include <cmath>
#include <limits>

#include "field/between_faces.h"
#include "mesh/position_range.h"

namespace thimble::render {

const ContactState& EntryFaceContact::update(const driver::DeviceState& state) noexcept {
  const Eigen::Vector3d& p_WT = state.p_WT;
  if (!within_range(p_WT)) {
    state_ = {};
    has_before_ = false;
    return state_;
  }
  const Eigen::Vector3d p_O = box_.to_box(p_WT);
  std::int32_t face = -1;
  if (state_.touching) {
    if (behind(p_O, state_.triangle)) face = state_.triangle;
  } else if (has_before_) {
    face = entry(p_O_before_, p_O);
    if (face >= 0 && !behind(p_O, face)) face = -1;
  }
  p_O_before_ = p_O;
  has_before_ = true;
  state_ = {};
  if (face < 0) return state_;
  state_.touching = true;
  state_.triangle = face;
  state_.depth = box_.depth(p_O, face);
  state_.n_W = box_.normal(face);
  state_.p_WP = p_WT + state_.depth * state_.n_W;
  return state_;
}

/// Returns whether a point (O, m) is below the plane of a face and within its outline.
bool EntryFaceContact::behind(const Eigen::Vector3d& p_O, std::int32_t face) const noexcept {
  const Eigen::Index u = (face / 2 + 1) % 3;
  const Eigen::Index v = (face / 2 + 2) % 3;
  return box_.depth(p_O, face) > 0 && between_faces(box_, p_O[u], u) &&
         between_faces(box_, p_O[v], v);
}

/// Returns the face through which a straight path (O, m) enters the box; -1 if it begins inside or
/// misses.
std::int32_t EntryFaceContact::entry(const Eigen::Vector3d& from_O,
                                     const Eigen::Vector3d& to_O) const noexcept {
  std::int32_t face = -1;
  double entered = -1;  // share of the path
  double left = std::numeric_limits<double>::infinity();
  double squareness = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double half = box_.half_sides[axis];
    const double from = from_O[axis];
    const double way = to_O[axis] - from;
    if (std::abs(to_O[axis]) >= half && way != 0) {
      left = std::fmin(left, (std::copysign(half, to_O[axis]) - from) / way);
    }
    if (std::abs(from) < half) continue;
    // Outside between these two faces: the path must enter through the nearer one.
    if (!(way * from < 0)) return -1;
    const double at = (std::copysign(half, from) - from) / way;
    if (at > entered || (at == entered && std::abs(way) > squareness)) {
      entered = at;
      squareness = std::abs(way);
      face = 2 * static_cast<std::int32_t>(axis) + (from > 0 ? 1 : 0);
    }
  }
  // A path that ends inside has left through no face, so rounding cannot make it miss.
  return entered <= 1 && entered <= left ? face : -1;
}

}  // namespace thimble::render
