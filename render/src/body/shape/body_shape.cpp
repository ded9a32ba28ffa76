#include "body/shape/body_shape.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "mesh/surface_weights.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kStill = 1e-12;             // of the mesh's size; a smaller distance is rounding
constexpr std::uint8_t kTries = 8;           // for a vertex blocked by others [chosen]
constexpr std::size_t kPrintMax = 512;       // vertices that one print moves
constexpr std::size_t kFinePrintMax = 8192;  // the same of a mesh whose edges are split

// Returns the number of vertices within `radius` on a mesh with evenly distributed vertices.
double vertices_within(const ContactMesh& mesh, double radius) {
  double twice_area = 0;
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vector3d& a = mesh.position(t, 0);
    twice_area += (mesh.position(t, 1) - a).cross(mesh.position(t, 2) - a).norm();
  }
  return std::numbers::pi * radius * radius * mesh.vertex_count() / (twice_area / 2);
}

driver::Result<void> check_size(const ContactMesh& mesh, const char* what, double radius,
                                double least, std::size_t most) {
  const double within = vertices_within(mesh, radius);
  if (within >= least && within <= static_cast<double>(most)) return {};
  return driver::Error{
      fmt::format("{} of radius {:.3g} m would move about {:.0f} vertices of this mesh; {:.0f} "
                  "to {} are allowed. Use a {} mesh or a {} radius.",
                  what, radius, within, least, most, within < least ? "finer" : "coarser",
                  within < least ? "larger" : "smaller")};
}

}  // namespace

driver::Result<BodyShape> BodyShape::build(const ContactMesh& mesh, const ShapeChoice& choice,
                                           double stiffness) {
  if (!(stiffness > 0) || !std::isfinite(stiffness)) {
    return driver::Error{"A body that changes shape needs a surface stiffness above 0 N/m."};
  }
  if (!(choice.step > 0) || !std::isfinite(choice.step)) {
    return driver::Error{"A body that changes shape needs a time step above 0 s."};
  }
  if (choice.clay) {
    if (auto fit = choice.clay->check(); !fit) return fit.error();
    constexpr double kVerticesMin = 0;  // the touched triangle moves in any case
    const std::size_t most = choice.clay->edge > 0 ? kFinePrintMax : kPrintMax;
    const double reach = choice.clay->keeps_volume ? VolumeKeeper::kRim : 1;
    auto fit = check_size(mesh, reach > 1 ? "A print with its rim" : "A print",
                          reach * choice.clay->radius, kVerticesMin, most);
    if (!fit) return fit.error();
  }
  if (choice.snap) {
    if (auto fit = choice.snap->check(); !fit) return fit.error();
    constexpr double kVerticesMin = 12;  // two rings: fewer do not form a panel
    auto fit =
        check_size(mesh, "A panel", choice.snap->radius, kVerticesMin, SnapShape::kVerticesMax);
    if (!fit) return fit.error();
  }
  return BodyShape(mesh, choice, stiffness);
}

BodyShape::BodyShape(const ContactMesh& mesh, const ShapeChoice& choice, double stiffness)
    : guard_(mesh), step_(choice.step), still_(kStill * (mesh.box_max() - mesh.box_min()).norm()) {
  const auto count = static_cast<std::size_t>(mesh.vertex_count());
  const std::size_t room = mesh.vertices_max();
  first_places_.reserve(room);
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) first_places_.push_back(mesh.position(v));
  places_.reserve(room);
  places_ = first_places_;
  ring_.resize(room);
  tries_.reserve(room);
  tries_.assign(count, 0);
  moves_.reserve(kMovesMax);
  if (choice.clay) {
    const bool fine = choice.clay->edge > 0;
    const std::size_t most = fine ? kFinePrintMax : kPrintMax;
    print_.emplace(first_places_, most, room);
    if (choice.clay->keeps_volume) volume_.emplace(mesh, choice.clay->radius, most);
    clay_.emplace(*choice.clay, stiffness, count, room);
    if (fine) {
      refinement_.emplace(choice.clay->edge, choice.clay->radius, mesh.triangles_max());
      splits_.reserve(PrintRefinement::kSplitsMax);
    }
  }
  if (choice.snap) snap_.emplace(*choice.snap, stiffness, mesh, first_places_);
}

ShapeContact BodyShape::contact_of(const ContactMesh& mesh,
                                   const driver::TouchInfo& touch) const noexcept {
  ShapeContact contact;
  contact.triangle = touch.feature;
  contact.inward = -mesh.cell(touch.feature).face.n;
  contact.first_inward = -guard_.first_normal(touch.feature);
  contact.depth = touch.depth;
  const Vector3d raw = projected_weights(mesh, touch.feature, touch.p_WP).cwiseMax(0.0);
  const double sum = raw.sum();
  contact.weights =
      sum > 0 && std::isfinite(sum) ? Vector3d(raw / sum) : Vector3d::Constant(1.0 / 3);
  const auto& corners = mesh.corners(touch.feature);
  for (std::size_t k = 0; k < 3; ++k) {
    contact.p_first += contact.weights[static_cast<Eigen::Index>(k)] *
                       first_places_[static_cast<std::size_t>(corners[k])];
  }
  return contact;
}

std::span<const VertexMove> BodyShape::follow(const ContactMesh& mesh,
                                              const driver::TouchInfo& touch) noexcept {
  moves_.clear();
  splits_.clear();
  // Written so that NaN means no press.
  const bool pressed = touch.in_contact && touch.feature >= 0 &&
                       touch.feature < mesh.triangle_count() && touch.depth >= 0;
  pressed_ = false;
  if (!pressed) {
    if (snap_) {
      snap_->rest(step_);
      snap_->for_each_moved([this](std::int32_t vertex) { mark(vertex); });
    }
    end_tick(mesh);
    return moves_;
  }
  ShapeContact contact = contact_of(mesh, touch);
  const auto& corners = mesh.corners(touch.feature);
  const double way_before = way_of(contact, corners);
  const double depth = contact.depth;
  double snapped = 0;
  if (snap_) {
    snapped = snap_->press(mesh, contact, step_);
    snap_->for_each_moved([this](std::int32_t vertex) { mark(vertex); });
    contact.depth -= snapped;
  }
  if (refinement_ && clay_->near_flowing(contact.depth)) {
    refinement_->press(contact.triangle, contact.p_first);
    pressed_ = true;
  }
  if (clay_ && clay_->flows(contact.depth)) flow(mesh, contact);
  for (const std::int32_t vertex : corners) {
    if (tries_[static_cast<std::size_t>(vertex)] > 0) carry(mesh, vertex);
  }
  if (clay_) clay_->moved(way_of(contact, corners) - way_before - snapped, depth - snapped);
  end_tick(mesh);
  return moves_;
}

// Lets clay flow under a contact, and to the rim of the print if its volume is kept.
void BodyShape::flow(const ContactMesh& mesh, const ShapeContact& contact) noexcept {
  const auto& corners = mesh.corners(contact.triangle);
  const double reach = clay_->radius() * (volume_ ? VolumeKeeper::kRim : 1);
  const auto patch = print_->around(mesh, contact.triangle, contact.p_first, reach);
  if (volume_) {
    volume_->begin();
    const double way = clay_->press(
        contact, corners, patch, first_places_, step_,
        [this](std::int32_t vertex, const Vector3d& change) { volume_->flowed(vertex, change); });
    volume_->raise(*clay_, contact, corners, patch, first_places_, way);
    if (!(way > 0)) return;
  } else if (!(clay_->press(contact, corners, patch, first_places_, step_,
                            [](std::int32_t, const Vector3d&) {}) > 0)) {
    return;
  }
  for (const std::int32_t vertex : patch) mark(vertex);
}

void BodyShape::end_tick(const ContactMesh& mesh) noexcept {
  carry_waiting(mesh);
  if (!volume_ || waiting_ > 0) return;
  for (const std::int32_t vertex : volume_->settle(*clay_)) mark(vertex);
}

void BodyShape::take(const ContactMesh& mesh, const EdgeSplit& split) noexcept {
  refinement_->take(split);
  if (split.vertex < 0) return;
  splits_.push_back(split);
  const auto at = [](std::int32_t vertex) { return static_cast<std::size_t>(vertex); };
  const auto& [a, b] = split.ends;
  first_places_.push_back((first_places_[at(a)] + first_places_[at(b)]) / 2);
  places_.push_back(mesh.position(split.vertex));
  const bool waits = tries_[at(a)] > 0 || tries_[at(b)] > 0;
  tries_.push_back(0);
  clay_->take(split);
  guard_.take(split);
  if (volume_) volume_->take(mesh, places_, split);
  print_->grow(first_places_);
  if (waits) mark(split.vertex);
}

// Returns how far inwards a place of the mesh is from its first place, m.
double BodyShape::way_of(const ShapeContact& contact,
                         std::span<const std::int32_t> corners) const noexcept {
  double way = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto v = static_cast<std::size_t>(corners[k]);
    way += contact.weights[static_cast<Eigen::Index>(k)] *
           (places_[v] - first_places_[v]).dot(contact.inward);
  }
  return way;
}

void BodyShape::mark(std::int32_t vertex) noexcept {
  std::uint8_t& tries = tries_[static_cast<std::size_t>(vertex)];
  if (tries == 0) {
    ring_[(first_waiting_ + waiting_) % ring_.size()] = vertex;
    ++waiting_;
  }
  tries = kTries;
}

Vector3d BodyShape::target(std::int32_t vertex) const noexcept {
  const Vector3d& first = first_places_[static_cast<std::size_t>(vertex)];
  Vector3d to = first;
  if (clay_) to += clay_->set(vertex);
  if (snap_) to += snap_->displacement(first);
  return to;
}

// Moves a vertex as near to its target as possible. Returns true if it need not wait any longer.
bool BodyShape::carry(const ContactMesh& mesh, std::int32_t vertex) noexcept {
  Vector3d& place = places_[static_cast<std::size_t>(vertex)];
  const Vector3d to = target(vertex);
  const double far = (to - place).norm();
  // Written so that NaN stays.
  if (!(far > still_)) return true;
  const double share = guard_.allowed(mesh, places_, vertex, to);
  const Vector3d there = place + share * (to - place);
  const bool moves = share * far > still_ && mesh.in_box(there);
  if (moves) {
    const Vector3d way = there - place;
    place = there;
    if (volume_) volume_->moved(mesh, places_, vertex, way);
    moves_.push_back({vertex, there});
  }
  if (moves && share == 1) return true;
  std::uint8_t& tries = tries_[static_cast<std::size_t>(vertex)];
  if (moves) tries = kTries;
  if (tries > 1) return false;
  if (clay_) clay_->correct(vertex, clay_->set(vertex) - (to - place));
  return true;
}

void BodyShape::carry_waiting(const ContactMesh& mesh) noexcept {
  // Each waiting vertex is examined at most once, and moves are limited to the time of a tick.
  std::size_t looks = std::min(waiting_, 8 * kMovesMax);
  while (looks-- > 0 && moves_.size() < kMovesMax) {
    const std::int32_t vertex = ring_[first_waiting_];
    first_waiting_ = (first_waiting_ + 1) % ring_.size();
    --waiting_;
    std::uint8_t& tries = tries_[static_cast<std::size_t>(vertex)];
    const bool done = carry(mesh, vertex);
    const std::uint8_t left = done ? 0 : static_cast<std::uint8_t>(tries - 1);
    tries = 0;
    if (left == 0) continue;
    mark(vertex);
    tries = left;
  }
}

}  // namespace thimble::render
