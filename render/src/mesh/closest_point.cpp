#include "mesh/closest_point.h"

namespace thimble::render {

using Eigen::Vector3d;

// The plane of a triangle has seven regions, each nearest to one corner, one edge or the inside;
// signs of projections on the edges decide the region [Ericson 5.1.5].
Vector3d closest_point(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                       const Vector3d& c) noexcept {
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const double a_ab = ab.dot(p - a);
  const double a_ac = ac.dot(p - a);
  if (a_ab <= 0 && a_ac <= 0) return a;
  const double b_ab = ab.dot(p - b);
  const double b_ac = ac.dot(p - b);
  if (b_ab >= 0 && b_ac <= b_ab) return b;
  const double c_ab = ab.dot(p - c);
  const double c_ac = ac.dot(p - c);
  if (c_ac >= 0 && c_ab <= c_ac) return c;

  // Weights of the corners, up to a common factor.
  const double w_c = a_ab * b_ac - b_ab * a_ac;
  if (w_c <= 0 && a_ab >= 0 && b_ab <= 0) return a + a_ab / (a_ab - b_ab) * ab;
  const double w_b = c_ab * a_ac - a_ab * c_ac;
  if (w_b <= 0 && a_ac >= 0 && c_ac <= 0) return a + a_ac / (a_ac - c_ac) * ac;
  const double w_a = b_ab * c_ac - c_ab * b_ac;
  const double along_b = b_ac - b_ab;
  const double along_c = c_ab - c_ac;
  if (w_a <= 0 && along_b >= 0 && along_c >= 0) {
    return b + along_b / (along_b + along_c) * (c - b);
  }
  const double sum = w_a + w_b + w_c;
  return a + w_b / sum * ab + w_c / sum * ac;
}

}  // namespace thimble::render
