#include "body/spring/spring_network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "body/spring/spectral_radius.h"

namespace thimble::render {
namespace {

using driver::Error;

bool usable(double x) {
  return x >= 0 && std::isfinite(x);
}

Error refuse(const std::string& what, std::size_t number, const std::string& why) {
  return {what + " " + std::to_string(number) + " of the body " + why};
}

driver::Result<void> check(std::span<const BodyNode> nodes) {
  if (nodes.empty()) return Error{"A body needs at least one node. Use a mesh with vertices."};
  if (nodes.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    return Error{"A body has 2^31 nodes or more. Use a coarser mesh."};
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!(nodes[i].mass > 0) || !std::isfinite(nodes[i].mass)) {
      return refuse("Node", i, "needs a mass above 0 kg.");
    }
    if (!usable(nodes[i].base_stiffness) || !usable(nodes[i].base_damping)) {
      return refuse("Node", i, "needs a finite stiffness and damping of 0 or more.");
    }
  }
  return {};
}

template <int kDof>
driver::Result<void> check(std::span<const BodySpring<kDof>> springs, std::size_t nodes) {
  for (std::size_t s = 0; s < springs.size(); ++s) {
    const BodySpring<kDof>& spring = springs[s];
    const auto exists = [nodes](std::int32_t i) {
      return i >= 0 && static_cast<std::size_t>(i) < nodes;
    };
    if (!exists(spring.a) || !exists(spring.b) || spring.a == spring.b) {
      return refuse("Spring", s, "must join two different existing nodes.");
    }
    if (!usable(spring.stiffness) || !usable(spring.damping)) {
      return refuse("Spring", s, "needs a finite stiffness and damping of 0 or more.");
    }
    const double length = spring.along.squaredNorm();
    constexpr double kUnit = 1e-9;  // looser than rounding, far tighter than a wrong scale
    if (!(length == 0 || std::abs(length - 1) < kUnit)) {
      return refuse("Spring", s, "needs a unit direction, or no direction.");
    }
    if ((length == 0) != (springs[0].along.squaredNorm() == 0)) {
      return refuse("Spring", s, "must be of the same kind as the others, directed or undirected.");
    }
  }
  return {};
}

}  // namespace

template <int kDof>
driver::Result<SpringNetwork<kDof>> SpringNetwork<kDof>::build(
    std::span<const BodyNode> nodes, std::span<const BodySpring<kDof>> springs) {
  if (auto good = check(nodes); !good) return good.error();
  if (auto good = check<kDof>(springs, nodes.size()); !good) return good.error();
  SpringNetwork network;
  const std::size_t n = nodes.size();
  network.begin_.assign(n + 1, 0);
  for (const auto& spring : springs) {
    ++network.begin_[static_cast<std::size_t>(spring.a) + 1];
    ++network.begin_[static_cast<std::size_t>(spring.b) + 1];
  }
  for (std::size_t i = 0; i < n; ++i) network.begin_[i + 1] += network.begin_[i];
  const std::size_t halves = network.begin_[n];
  const bool directed = !springs.empty() && springs[0].along.squaredNorm() > 0;
  network.other_.resize(halves);
  network.stiffness_.half.resize(halves);
  network.damping_.half.resize(halves);
  if (directed) network.along_.resize(halves);
  std::vector<std::size_t> next(network.begin_.begin(), network.begin_.end() - 1);
  double relaxation = std::numeric_limits<double>::infinity();
  const auto tie = [&](double stiffness, double damping) {
    network.damped_ = network.damped_ || damping > 0;
    if (stiffness > 0) relaxation = std::min(relaxation, damping / stiffness);
  };
  for (const auto& spring : springs) {
    const auto put = [&](std::int32_t from, std::int32_t to) {
      const std::size_t e = next[static_cast<std::size_t>(from)]++;
      network.other_[e] = to;
      network.stiffness_.half[e] = spring.stiffness;
      network.damping_.half[e] = spring.damping;
      if (directed) network.along_[e] = spring.along;
    };
    put(spring.a, spring.b);
    put(spring.b, spring.a);
    tie(spring.stiffness, spring.damping);
    network.coupled_ = network.coupled_ || spring.stiffness > 0 || spring.damping > 0;
  }
  double rate_min = std::numeric_limits<double>::infinity();
  for (const BodyNode& node : nodes) {
    rate_min = std::min(rate_min, node.base_damping / node.mass);
    network.mass_.push_back(node.mass);
    network.stiffness_.node.push_back(node.base_stiffness);
    network.damping_.node.push_back(node.base_damping);
    tie(node.base_stiffness, node.base_damping);
  }
  for (NetworkWeights* weights : {&network.stiffness_, &network.damping_}) {
    weights->joined = std::any_of(weights->half.begin(), weights->half.end(),
                                  [](double weight) { return weight > 0; });
  }
  const SpectralRadius stiff = spectral_radius(network, network.stiffness_);
  const SpectralRadius damp = spectral_radius(network, network.damping_);
  network.bounds_ = {std::sqrt(stiff.value),
                     std::sqrt(stiff.gershgorin),
                     damp.value,
                     relaxation,
                     rate_min,
                     stiff.converged && damp.converged};
  return network;
}

template <int kDof>
typename SpringNetwork<kDof>::Vector SpringNetwork<kDof>::row(
    const NetworkWeights& weights, std::int32_t node, std::span<const Vector> x) const noexcept {
  const auto i = static_cast<std::size_t>(node);
  const Vector& here = x[i];
  Vector sum = weights.node[i] * here;
  if (!weights.joined) return sum;
  if (along_.empty()) {
    for (std::size_t e = begin_[i]; e < begin_[i + 1]; ++e) {
      sum += weights.half[e] * (here - x[static_cast<std::size_t>(other_[e])]);
    }
  } else {
    for (std::size_t e = begin_[i]; e < begin_[i + 1]; ++e) {
      const double stretch = along_[e].dot(here - x[static_cast<std::size_t>(other_[e])]);
      sum += weights.half[e] * stretch * along_[e];
    }
  }
  return sum;
}

template <int kDof>
void SpringNetwork<kDof>::multiply(const NetworkWeights& weights,
                                   std::span<const std::int32_t> nodes, std::span<const Vector> x,
                                   std::span<Vector> y) const noexcept {
  for (const std::int32_t i : nodes) y[static_cast<std::size_t>(i)] = row(weights, i, x);
}

template <int kDof>
double SpringNetwork<kDof>::energy(std::span<const Vector> u,
                                   std::span<const Vector> v) const noexcept {
  double twice = 0;
  for (std::int32_t i = 0; i < node_count(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    twice += mass_[k] * v[k].squaredNorm() + u[k].dot(row(stiffness_, i, u));
  }
  return twice / 2;
}

template class SpringNetwork<1>;
template class SpringNetwork<3>;

}  // namespace thimble::render
