#include "body/dent/edge_point.h"

#include <cmath>

namespace thimble::render {

void EdgePoint::begin(std::int32_t from, std::int32_t to) noexcept {
  *this = EdgePoint();
  from_ = from;
  to_ = to;
}

// Implicit Euler, with all terms multiplied by s (1 - s) so that both ends stay finite.
void EdgePoint::step(const Pull& pull, const DentSettings& settings, double stiffness) noexcept {
  const double s = pull.share;
  const double h = settings.step;
  const double both = s * (1 - s);
  const double to_cursor = settings.reach * stiffness * s * s;
  const double to_chord = stiffness * (1 - s) * (1 - s);
  place_ = pull.place;
  const Eigen::Vector3d chord = pull.from + pull.place * (pull.to - pull.from);
  const Eigen::Vector3d gap = pull.cursor - chord;
  const Eigen::Vector3d rate =
      pulled_ ? Eigen::Vector3d((gap - gap_) / h) : Eigen::Vector3d(0, 0, 0);
  gap_ = gap;
  pulled_ = true;
  const double weight =
      both * (settings.mass + 2 * h * settings.damping) + h * h * (to_cursor + to_chord);
  v_ = (both * (settings.mass * v_ + h * settings.damping * rate) +
        h * (to_cursor * (gap - y_) - to_chord * y_)) /
       weight;
  y_ += h * v_;
  // Written so that NaN, as from zero weight, means the edge.
  if (!(y_.squaredNorm() >= 0 && std::isfinite(y_.squaredNorm()))) {
    y_.setZero();
    v_.setZero();
  }
  u_ = chord + y_;
}

}  // namespace thimble::render
