#include "studies/integrators/membrane.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "body/spring/oscillator.h"

namespace thimble::studies {

render::SpringNetwork<1> membrane_network(const Membrane& membrane) {
  const std::int32_t n = membrane.n;
  std::vector<render::BodyNode> nodes;
  std::vector<render::BodySpring<1>> springs;
  for (std::int32_t j = 0; j < n; ++j) {
    for (std::int32_t i = 0; i < n; ++i) {
      const std::int32_t here = j * n + i;
      if (i + 1 < n) springs.push_back({here, here + 1, membrane.stiffness, 0});
      if (j + 1 < n) springs.push_back({here, here + n, membrane.stiffness, 0});
      const int at_frame = (i == 0) + (i + 1 == n) + (j == 0) + (j + 1 == n);
      nodes.push_back({membrane.mass, at_frame * membrane.stiffness, membrane.damping});
    }
  }
  return render::SpringNetwork<1>::build(nodes, springs).value();
}

std::vector<double> membrane_truth(const Membrane& membrane, double t) {
  const Eigen::Index n = membrane.n;
  const double cells = static_cast<double>(n + 1);
  Eigen::MatrixXd sines(n, n);  // row: mode, column: node; orthonormal
  for (Eigen::Index p = 0; p < n; ++p) {
    for (Eigen::Index i = 0; i < n; ++i) {
      sines(p, i) = std::sqrt(2 / cells) *
                    std::sin(std::numbers::pi * static_cast<double>((p + 1) * (i + 1)) / cells);
    }
  }
  const auto square = [&](Eigen::Index p) {
    const double half = std::sin(std::numbers::pi * static_cast<double>(p + 1) / (2 * cells));
    return 4 * membrane.stiffness / membrane.mass * half * half;
  };
  const Eigen::Index column = membrane.poked() % n;
  const Eigen::Index row = membrane.poked() / n;
  Eigen::MatrixXd heights(n, n);
  for (Eigen::Index q = 0; q < n; ++q) {
    for (Eigen::Index p = 0; p < n; ++p) {
      const double omega2 = square(p) + square(q);
      const double rate = membrane.damping / membrane.mass;
      const double push = membrane.force / membrane.mass * sines(p, column) * sines(q, row);
      double x = 0;
      double v = 0;
      const double pushed = std::min(t, membrane.poke);
      render::OscillatorStep::of(1, omega2, rate, pushed).apply(x, v, push);
      render::OscillatorStep::of(1, omega2, rate, t - pushed).apply(x, v, 0.0);
      heights(p, q) = x;
    }
  }
  const Eigen::MatrixXd field = sines.transpose() * heights * sines;
  // The matrix is stored by columns, which are rows of the membrane.
  return {field.data(), field.data() + field.size()};
}

}  // namespace thimble::studies
