#include "body/motion/mass_properties.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace thimble::render {

bool MassProperties::valid() const noexcept {
  const double sum = inertia.sum();
  const double largest = inertia.maxCoeff();
  // A needle or a plate may be at the bound; rounding may exceed it.
  constexpr double kRounding = 1e-9;
  return mass > 0 && std::isfinite(mass) && p_WC.allFinite() && q_WB.coeffs().allFinite() &&
         std::abs(q_WB.norm() - 1) < kRounding && inertia.minCoeff() > 0 && std::isfinite(sum) &&
         largest <= (sum - largest) * (1 + kRounding);
}

driver::Result<MassProperties> mass_properties(const TriangleMesh& mesh, double mass) {
  if (!(mass > 0) || !std::isfinite(mass)) {
    return driver::Error{"A moving body needs a mass above 0 kg."};
  }
  const driver::Error nothing_inside{
      "The mesh encloses no volume, so it has no inertia. Make it watertight and orient it "
      "outwards: "
      "thimble mesh FILE --repair OUT.off"};
  if (mesh.vertices.empty()) return nothing_inside;
  // About the middle of the vertices, so that a mesh far away loses no digits.
  Eigen::Vector3d middle(0, 0, 0);
  for (const Eigen::Vector3d& p : mesh.vertices) middle += p;
  middle /= static_cast<double>(mesh.vertices.size());
  // Sums over the tetrahedra from there to each triangle, with signs: volume, first and second
  // moments [Tonon].
  double volume = 0;
  double size = 0;
  Eigen::Vector3d first(0, 0, 0);
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
      return mesh.vertices[static_cast<std::size_t>(triangle[k])] - middle;
    };
    const Eigen::Vector3d a = corner(0);
    const Eigen::Vector3d b = corner(1);
    const Eigen::Vector3d c = corner(2);
    const Eigen::Vector3d sum = a + b + c;
    const double v = a.dot(b.cross(c)) / 6;
    volume += v;
    size += std::abs(v);
    first += v / 4 * sum;
    second += v / 20 *
              (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  constexpr double kRounding = 1e-12;
  if (!(volume > kRounding * size)) return nothing_inside;
  const Eigen::Vector3d centre = first / volume;
  const Eigen::Matrix3d spread = mass / volume * (second - volume * centre * centre.transpose());
  const Eigen::Matrix3d inertia = spread.trace() * Eigen::Matrix3d::Identity() - spread;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  MassProperties found;
  found.mass = mass;
  found.p_WC = middle + centre;
  found.q_WB = Eigen::Quaterniond(axes).normalized();
  found.inertia = solver.eigenvalues();
  found.volume = volume;
  if (!found.valid()) return nothing_inside;
  return found;
}

void prefer_axes(const Eigen::Matrix3d& axes_W, MassProperties& properties) {
  const Eigen::Matrix3d R_WB = properties.q_WB.toRotationMatrix();
  const Eigen::Matrix3d turn = axes_W.transpose() * R_WB;
  const Eigen::Matrix3d inertia = turn * properties.inertia.asDiagonal() * turn.transpose();
  const Eigen::Vector3d own = inertia.diagonal();
  const Eigen::Matrix3d rest = inertia - Eigen::Matrix3d(own.asDiagonal());
  if (!(rest.cwiseAbs().maxCoeff() <= 1e-9 * own.sum())) return;
  std::array<Eigen::Index, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return own[a] < own[b]; });
  Eigen::Matrix3d axes;
  for (std::size_t k = 0; k < 3; ++k) {
    axes.col(static_cast<Eigen::Index>(k)) = axes_W.col(order[k]);
    properties.inertia[static_cast<Eigen::Index>(k)] = own[order[k]];
  }
  // The last axis of the shape, which may have a direction, keeps it.
  if (axes.determinant() < 0) {
    const auto first = static_cast<Eigen::Index>(order[0] == 2 ? 1 : 0);
    axes.col(first) = -axes.col(first);
  }
  properties.q_WB = Eigen::Quaterniond(axes).normalized();
}

}  // namespace thimble::render
