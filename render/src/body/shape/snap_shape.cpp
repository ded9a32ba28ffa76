#include "body/shape/snap_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/elementary.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kPlateau = 0.25;      // of the radius moves in as deep as the middle [chosen]
constexpr double kPanelsApart = 1.2;   // radii between the middles of two panels, so walls remain
constexpr double kFollow = 0.05;       // radii that the tip moves before its panel follows [chosen]
constexpr double kHoldMin = 0.05;      // of the profile: less does not press a panel [chosen]
constexpr double kDistanceMin = 1e-9;  // of the depth: a smaller displacement counts as none

}  // namespace

SnapShape::SnapShape(const SnapChoice& choice, double stiffness, const ContactMesh& mesh,
                     std::span<const Vector3d> first_places)
    : choice_(choice),
      truss_(choice.truss()),
      stiffness_(stiffness),
      first_places_(first_places),
      first_normals_(first_places.size(), Vector3d::Zero()),
      patch_(first_places, kVerticesMax) {
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (const std::int32_t v : mesh.corners(t)) {
      first_normals_[static_cast<std::size_t>(v)] -= mesh.cell(t).face.n;
    }
  }
  for (Vector3d& n : first_normals_) n.normalize();
  panels_.reserve(static_cast<std::size_t>(choice.panels) + 1);
  // One more, so that the wall gives way elastically when all others have snapped.
  for (int i = 0; i <= choice.panels; ++i) {
    panels_.push_back({.base = SnapBase(truss_, Vector3d::UnitZ()), .vertices = {}});
    panels_.back().vertices.reserve(kVerticesMax);
  }
  left_.reserve(kVerticesMax);
}

double SnapShape::profile(double distance) const noexcept {
  const double s = (distance / choice_.radius - kPlateau) / (1 - kPlateau);
  if (!(s < 1)) return 0;
  const double half = math::cos(std::numbers::pi / 2 * std::max(s, 0.0));
  return half * half;
}

// Returns the inward displacement of the touched place per displacement of the panel.
double SnapShape::hold_of(const Panel& panel, const ShapeContact& contact) const noexcept {
  if (!panel.used) return 0;
  return profile((contact.p_first - panel.centre).norm()) *
         std::max(panel.inward.dot(contact.inward), 0.0);
}

bool SnapShape::room_for(const Vector3d& centre) const noexcept {
  int in = 0;
  for (const Panel& panel : panels_) {
    if (!panel.used || &panel == live_) continue;
    if ((panel.centre - centre).norm() < kPanelsApart * choice_.radius) return false;
    ++in;
  }
  return in < choice_.panels;
}

void SnapShape::put(Panel& panel, const ContactMesh& mesh, const ShapeContact& contact) noexcept {
  panel.centre = contact.p_first;
  const auto around = patch_.around(mesh, contact.triangle, contact.p_first, choice_.radius);
  panel.vertices.assign(around.begin(), around.end());
  panel.inward = contact.inward;
  Vector3d mean(0, 0, 0);
  for (const std::int32_t vertex : around) {
    const auto v = static_cast<std::size_t>(vertex);
    mean += profile((first_places_[v] - panel.centre).norm()) * first_normals_[v];
  }
  if (mean.squaredNorm() > 0) panel.inward = mean.normalized();
  panel.used = true;
  panel.moved = true;
}

// Moves the panel that has not snapped along with the tip, or begins one.
void SnapShape::lead(const ContactMesh& mesh, const ShapeContact& contact) noexcept {
  if (live_ != nullptr && live_->base.snapped()) live_ = nullptr;
  if (live_ == nullptr) {
    if (!room_for(contact.p_first)) return;
    for (Panel& panel : panels_) {
      if (panel.used) continue;
      panel.base = SnapBase(truss_, Vector3d::UnitZ());
      put(panel, mesh, contact);
      live_ = &panel;
      return;
    }
    return;
  }
  if ((contact.p_first - live_->centre).norm() < kFollow * choice_.radius) return;
  if (!room_for(contact.p_first)) return;
  left_.assign(live_->vertices.begin(), live_->vertices.end());
  put(*live_, mesh, contact);
}

// Pulls a panel by a spring (N/m) whose other end is at `end` (m), or releases it (0).
double SnapShape::pull(Panel& panel, double end, double spring, double step) noexcept {
  const double from = panel.base.way();
  const double energy = panel.base.energy();
  const std::int64_t snaps = panel.base.snaps();
  panel.base.pull_by_spring(end, spring, step);
  const double to = panel.base.way();
  snaps_ += panel.base.snaps() - snaps;
  // Work of the spring on the path, with its other end held, less the energy kept in the panel. A
  // surface that falls away from the tip is not held by it.
  const double pressed_before = std::max(end - from, 0.0);
  const double pressed = std::max(end - to, 0.0);
  released_ += spring / 2 * (pressed_before * pressed_before - pressed * pressed) -
               (panel.base.energy() - energy);
  panel.moved = panel.moved || std::abs(to - from) > kDistanceMin * choice_.depth;
  return to - from;
}

double SnapShape::press(const ContactMesh& mesh, const ShapeContact& contact,
                        double step) noexcept {
  left_.clear();
  for (Panel& panel : panels_) panel.moved = false;
  lead(mesh, contact);
  // Only the panel with the largest effect at the place gives way: two at once would give twice.
  Panel* pressed = nullptr;
  double hold = kHoldMin;
  for (Panel& panel : panels_) {
    const double its = hold_of(panel, contact);
    if (its > hold) {
      hold = its;
      pressed = &panel;
    }
  }
  double way = 0;
  for (Panel& panel : panels_) {
    if (!panel.used) continue;
    if (&panel == pressed) {
      // The spring's other end, as seen by the panel: energy k (way - hold u)^2 / 2.
      const double end = contact.depth / hold + panel.base.way();
      way = hold * pull(panel, end, stiffness_ * hold * hold, step);
    } else if (!(hold_of(panel, contact) > kHoldMin)) {
      pull(panel, 0, 0, step);
    }
  }
  return way;
}

void SnapShape::rest(double step) noexcept {
  left_.clear();
  for (Panel& panel : panels_) {
    panel.moved = false;
    if (!panel.used) continue;
    pull(panel, 0, 0, step);
    const bool flat =
        !panel.base.snapped() && !(std::abs(panel.base.way()) > kDistanceMin * choice_.depth);
    if (!flat) continue;
    panel.used = false;
    panel.moved = true;
    if (&panel == live_) live_ = nullptr;
  }
}

Vector3d SnapShape::displacement(const Vector3d& p_first) const noexcept {
  Vector3d sum(0, 0, 0);
  for (const Panel& panel : panels_) {
    if (!panel.used) continue;
    const double share = profile((p_first - panel.centre).norm());
    if (share > 0) sum += share * panel.base.way() * panel.inward;
  }
  return sum;
}

std::int64_t SnapShape::snaps() const noexcept {
  return snaps_;
}

double SnapShape::energy() const noexcept {
  double sum = 0;
  for (const Panel& panel : panels_) {
    if (panel.used) sum += panel.base.energy();
  }
  return sum;
}

}  // namespace thimble::render
