#include "world/contact_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/position_range.h"

namespace thimble::render {

using Eigen::Vector3d;

namespace {

// Lift of the proxy off the surfaces, in roundings of the solids: flush faces that were computed in
// different ways agree within some. [chosen]
constexpr double kLift = 64;

// Maximum number of times per tick that the proxy is stopped or let go, or the active solids are
// followed again. A slide through a room from wall to wall and into its corner takes 6; the next
// tick continues. [chosen]
constexpr int kRoundsMax = 24;

// Maximum number of times that active solids are followed until they agree on where the tip is
// pushed. Faces take 1 or 2. [chosen]
constexpr int kAgreeMax = 6;

// Longest way out of a notch between faces, in lifts: 2 degrees. [chosen]
constexpr double kNotchMax = 64;

// Way of the tip after which a refused tracker is asked again, as a share of the depth: where faces
// meet, trackers hop within about the depth. [chosen]
constexpr double kAskAgain = 0.125;

// Number of solids in the neighbourhood up to which a larger one is worthwhile. [chosen]
constexpr std::size_t kFew = 12;

std::vector<SolidBox> boxes_of(const std::vector<ContactWorld::Member>& members) {
  std::vector<SolidBox> boxes;
  boxes.reserve(members.size());
  for (const auto& member : members) boxes.push_back(member.solid->box());
  return boxes;
}

std::vector<std::int32_t> resting(const std::vector<ContactWorld::Member>& members) {
  std::vector<std::int32_t> solids;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!members[i].solid->moves()) solids.push_back(static_cast<std::int32_t>(i));
  }
  return solids;
}

}  // namespace

ContactWorld::ContactWorld(std::vector<Member> members)
    : members_(std::move(members)), tree_(boxes_of(members_), resting(members_)) {
  double sides = 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    members_[i].solid->prepare_fallback();
    lift_ = std::max(lift_, kLift * members_[i].solid->rounding());
    const SolidBox& box = tree_.box(static_cast<std::int32_t>(i));
    if (!members_[i].solid->moves()) sides += (box.max - box.min).maxCoeff();
    if (members_[i].solid->changes()) changing_.push_back(static_cast<std::int32_t>(i));
    if (members_[i].solid->moves()) moving_.push_back(static_cast<std::int32_t>(i));
  }
  near_min_ = sides / (64 * static_cast<double>(std::max<std::size_t>(members_.size(), 1)));
  near_.reserve(members_.size());
  ghosts_.reserve(members_.size());
}

driver::ForceCommand ContactWorld::operator()(const driver::DeviceState& state) noexcept {
  const Vector3d& p_WT = state.p_WT;
  if (!within_range(p_WT)) [[unlikely]] {
    active_count_ = 0;
    has_proxy_ = false;
    ghosts_.clear();
  } else if (!has_proxy_) [[unlikely]] {
    start(state);
  } else if (active_count_ == 0 && near_.empty() && ghosts_.empty() && changing_.empty() &&
             (p_WT - near_centre_).squaredNorm() < near_squared_) {
    // Far from all solids.
    p_WQ_ = p_WT;
  } else {
    if (!changing_.empty()) carry(state);
    move(p_WT);
  }
  driver::ForceCommand command = feel(state);
  for (const std::int32_t i : changing_) {
    command.stored += solid(i).end_tick(p_WQ_, is_active(i));
  }
  return command;
}

// Lets the solids that change take their place of this tick, and carry the proxy along.
void ContactWorld::carry(const driver::DeviceState& state) noexcept {
  double path = 0;
  for (const std::int32_t i : changing_) {
    const bool touching = is_active(i);
    const SolidMove move = solid(i).begin_tick(state, p_WQ_, touching);
    if (move.swept_over >= 0 && !touching && !is_ghost(i)) {
      begin(i, move.swept_over, move.p_WP);
      // Other solids may stop it on its way in front of the surface.
      const Vector3d front = std::exchange(reached_, p_WQ_);
      advance(front);
      p_WQ_ = reached_;
      path = std::max(path, move.path);
    } else if (touching) {
      path = std::max(path, move.path);
    }
  }
  if (path > 0) filter_.surface_moved(path);
}

void ContactWorld::prepare(const driver::DeviceState& expected) const noexcept {
  for (std::size_t i = 0; i < active_count_; ++i) {
    const Active& active = active_[i];
    driver::DeviceState there = expected;
    there.p_WT = shifted(expected.p_WT, push_, i, 0);
    solid(active.solid).prepare(there);
  }
}

void ContactWorld::start(const driver::DeviceState& state) noexcept {
  const Vector3d& p_WT = state.p_WT;
  for (const std::int32_t i : changing_) solid(i).begin_tick(state, p_WT, false);
  p_WQ_ = p_WT;
  has_proxy_ = true;
  near_squared_ = -1;
  ghosts_.clear();
  tree_.near(p_WT, 0, members_.size(), near_);
  for (const std::int32_t i : near_) {
    if (solid(i).inside(p_WT)) ghosts_.push_back(i);
  }
  for (const std::int32_t i : moving_) {
    if (solid(i).inside(p_WT)) ghosts_.push_back(i);
  }
  near_.clear();
}

// Solids that the tip has left are felt from now on.
void ContactWorld::forget_left() noexcept {
  std::erase_if(ghosts_, [this](std::int32_t i) { return !solid(i).inside(p_WQ_); });
}

bool ContactWorld::is_ghost(std::int32_t i) const noexcept {
  return std::find(ghosts_.begin(), ghosts_.end(), i) != ghosts_.end();
}

bool ContactWorld::is_active(std::int32_t i) const noexcept {
  for (std::size_t k = 0; k < active_count_; ++k) {
    if (active_[k].solid == i) return true;
  }
  return false;
}

std::span<const ActivePlane> ContactWorld::planes(Planes& room) const noexcept {
  for (std::size_t i = 0; i < active_count_; ++i) room[i] = active_[i].plane;
  return {room.data(), active_count_};
}

// Moves the proxy to where the active solids let it, and begins those that it meets on its way.
void ContactWorld::move(const Vector3d& p_WT) noexcept {
  reached_ = p_WQ_;
  for (std::size_t i = 0; i < active_count_; ++i) active_[i].tried = false;
  Planes room;
  int agreed = 0;
  for (int round = 0; round < kRoundsMax; ++round) {
    const bool ended = active_count_ > 0 && follow_active(p_WT);
    if (ended) {
      // Over the extended faces of those that have let go.
      const PushOut over = push_out(planes(room), p_WT, lift_, lift_ / 4);
      if (advance(p_WT + over.d)) {
        // Stopped before the end of those faces.
        revive_ended();
      } else {
        drop_ended();
      }
      continue;
    }
    push_ = push_out(planes(room), p_WT, 0, lift_ / 4);
    if (active_count_ > 1 && !agrees(p_WT, push_) && ++agreed < kAgreeMax) continue;
    Vector3d goal = p_WT + push_.d;
    if (active_count_ == 1) {
      goal += lift_ * active_[0].plane.n;
    } else if (active_count_ > 1) {
      goal = p_WT + push_out(planes(room), p_WT, lift_, lift_ / 4).d;
    }
    if (advance(goal)) {
      agreed = 0;
      continue;
    }
    p_WQ_ = reached_;
    if (!ghosts_.empty()) forget_left();
    return;
  }
  ++counters_.unsettled;
  p_WQ_ = reached_;
  push_ = push_out(planes(room), p_WT, 0, lift_ / 4);
}

// Moves the proxy straight towards `goal`. Returns whether it has met a solid, which is then
// active; the proxy stops in front of it.
bool ContactWorld::advance(const Vector3d& goal) noexcept {
  look_around(reached_, goal);
  std::int32_t first = -1;
  SolidEntry entry{.triangle = -1, .parameter = 2};
  // What is farther away cannot be met; with a margin for the rounding of squares.
  const double reach = (1 + 0x1p-20) * (goal - reached_).squaredNorm();
  const auto meet = [&](std::int32_t i) {
    if (is_active(i)) return;
    const SolidEntry one = solid(i).first_entry(reached_, goal);
    if (one.triangle < 0 || !(one.parameter < entry.parameter)) return;
    first = i;
    entry = one;
  };
  for (const std::int32_t i : near_) {
    if (squared_distance(tree_.box(i), reached_) <= reach) meet(i);
  }
  for (const std::int32_t i : moving_) meet(i);
  if (first < 0) {
    reached_ = goal;
    return false;
  }
  begin(first, entry.triangle, reached_ + entry.parameter * (goal - reached_));
  return true;
}

void ContactWorld::begin(std::int32_t i, std::int32_t triangle, const Vector3d& p_W) noexcept {
  std::size_t slot = active_count_;
  if (active_count_ < kActiveMax) {
    ++active_count_;
  } else {
    // The one that presses least makes room.
    slot = static_cast<std::size_t>(std::min_element(push_.lambda.begin(), push_.lambda.end()) -
                                    push_.lambda.begin());
  }
  push_.lambda[slot] = 0;
  Active& active = active_[slot];
  active = {};
  active.solid = i;
  active.fresh = true;
  active.found = solid(i).begin(triangle, p_W);
  active.plane = {.n = active.found.n_W, .offset = active.found.n_W.dot(p_W)};
  ++counters_.begun;
  // In front of it, and of the others that it meets there.
  Planes close;
  std::size_t count = 0;
  for (std::size_t k = 0; k < active_count_; ++k) {
    if (std::abs(active_[k].plane.depth(p_W)) < 4 * lift_) close[count++] = active_[k].plane;
  }
  reached_ = p_W + push_out({close.data(), count}, p_W, lift_, lift_ / 4).d;
}

// Returns the tip as pushed out by all active solids but `i`, and `lift` off them.
Vector3d ContactWorld::shifted(const Vector3d& p_WT, const PushOut& push, std::size_t i,
                               double lift) const noexcept {
  Vector3d x = p_WT;
  for (std::size_t k = 0; k < active_count_; ++k) {
    if (k == i || !(push.lambda[k] > 0)) continue;
    x += (push.lambda[k] + lift) * active_[k].plane.n;
  }
  return x;
}

// Follows each active solid at the tip as the others push it. Returns whether one has let go.
bool ContactWorld::follow_active(const Vector3d& p_WT) noexcept {
  PushOut push;
  if (active_count_ > 1) {
    Planes room;
    push = push_out(planes(room), p_WT, 0, lift_ / 4);
  }
  bool ended = false;
  for (std::size_t i = 0; i < active_count_; ++i) {
    Active& active = active_[i];
    active.at_W = shifted(p_WT, push, i, lift_);
    const ContactState found = follow_one(active);
    active.fresh = false;
    // Written so that NaN lets go.
    active.ended = !(found.touching && found.depth >= 0);
    if (active.ended) {
      ended = true;
      continue;
    }
    active.found = found;
    active.plane = {.n = found.n_W, .offset = found.n_W.dot(active.at_W) + found.depth};
  }
  return ended;
}

// Follows one solid. A proxy inside another solid is refused: it is on a side that the proxy of the
// world cannot reach.
const ContactState& ContactWorld::follow_one(Active& active) noexcept {
  WorldSolid& one = solid(active.solid);
  if (active.closely) {
    const double moved = (active.at_W - active.refused_at_W).norm();
    if (!active.tried && moved > kAskAgain * active.found.depth) {
      active.tried = true;
      active.refused_at_W = active.at_W;
      const ContactState& found = one.follow(active.at_W);
      if (found.touching && !hidden(active, found)) {
        active.closely = false;
        return found;
      }
    }
    return one.follow_closely(active.found, active.at_W);
  }
  const ContactState& found = one.follow(active.at_W);
  const bool changed = active.fresh || found.hops > 0;
  if (changed && found.touching && !one.follows_closely() && hidden(active, found)) {
    ++counters_.hidden;
    active.closely = active.tried = true;
    active.refused_at_W = active.at_W;
    return one.follow_closely(active.found, active.at_W);
  }
  return found;
}

// Returns whether the proxy of a contact is inside another solid.
bool ContactWorld::hidden(const Active& active, const ContactState& found) noexcept {
  Planes room;
  const std::span<const ActivePlane> all = planes(room);
  const auto own = static_cast<std::size_t>(&active - active_.data());
  room[own] = {.n = found.n_W, .offset = found.n_W.dot(found.p_WP)};
  const PushOut off = push_out(all, found.p_WP, lift_, lift_ / 4);
  // No place in front of all: the face lies on the one of another solid.
  if (!off.feasible || !(off.d.norm() < kNotchMax * lift_)) return true;
  const Vector3d p_W = found.p_WP + off.d;
  look_around(p_W, p_W);
  const auto holds = [&](std::int32_t i) {
    return i != active.solid && solid(i).inside(p_W) && !is_ghost(i);
  };
  const auto near_holds = [&](std::int32_t i) {
    return squared_distance(tree_.box(i), p_W) == 0 && holds(i);
  };
  return std::any_of(near_.begin(), near_.end(), near_holds) ||
         std::any_of(moving_.begin(), moving_.end(), holds);
}

// Returns whether the active solids were followed where `push` leads.
bool ContactWorld::agrees(const Vector3d& p_WT, const PushOut& push) const noexcept {
  for (std::size_t i = 0; i < active_count_; ++i) {
    const Vector3d off = shifted(p_WT, push, i, lift_) - active_[i].at_W;
    if (!(off.squaredNorm() <= lift_ * lift_ / 4)) return false;
  }
  return true;
}

void ContactWorld::revive_ended() noexcept {
  for (std::size_t i = 0; i < active_count_; ++i) {
    if (active_[i].ended) solid(active_[i].solid).revive(reached_);
    active_[i].ended = false;
  }
}

void ContactWorld::drop_ended() noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < active_count_; ++i) {
    if (active_[i].ended) continue;
    if (kept != i) active_[kept] = active_[i];
    ++kept;
  }
  active_count_ = kept;
}

// Lists all solids near a path.
void ContactWorld::look_around(const Vector3d& from, const Vector3d& to) noexcept {
  const double step = (to - from).norm();
  const double least = std::max(2 * step, near_min_);
  // A list that was made for a leap is too long for smaller steps.
  const bool leapt = near_.size() > kFew && least < near_least_ / 4;
  if (!leapt && (from - near_centre_).squaredNorm() < near_squared_ &&
      (to - near_centre_).squaredNorm() < near_squared_) {
    return;
  }
  constexpr double kSurely = 1 - 0x1p-20;  // covers the rounding of squares
  near_least_ = least;
  double radius = tree_.distance(from);
  if (radius > least) {
    near_.clear();
  } else {
    radius = 4 * least;
    while (radius > least && !tree_.near(from, radius, kFew, near_)) radius /= 2;
    if (!(radius > least)) {
      radius = least;
      tree_.near(from, radius, members_.size(), near_);
    }
  }
  near_centre_ = from;
  near_squared_ = kSurely * kSurely * radius * radius;
}

driver::ForceCommand ContactWorld::feel(const driver::DeviceState& state) noexcept {
  if (active_count_ == 0) {
    filter_.follow(state.p_WT, {});
    stiffness_ref_ = 0;
    if (felt_count_ > 0) leave_others({});
    return {};
  }
  return active_count_ == 1 ? feel_one(state) : feel_several(state);
}

// Ends the stages of all solids that were felt but are not in `felt`.
void ContactWorld::leave_others(std::span<const std::int32_t> felt) noexcept {
  for (std::size_t i = 0; i < felt_count_; ++i) {
    if (std::find(felt.begin(), felt.end(), felt_[i]) == felt.end()) solid(felt_[i]).leave();
  }
  felt_count_ = felt.size();
  std::copy(felt.begin(), felt.end(), felt_.begin());
}

driver::ForceCommand ContactWorld::feel_one(const driver::DeviceState& state) noexcept {
  const Active& active = active_[0];
  WorldSolid& one = solid(active.solid);
  const double stiffness = one.stiffness();
  if (stiffness > stiffness_ref_) {
    if (stiffness_ref_ > 0) filter_.rescale(stiffness_ref_ / stiffness);
    stiffness_ref_ = stiffness;
  }
  const double share = stiffness_ref_ > 0 ? stiffness / stiffness_ref_ : 1;
  ContactState felt = active.found;
  felt.depth *= share;
  if (filter_.follow(state.p_WT, felt)) {
    felt.depth = active.found.depth;
  } else {
    felt = filter_.felt();
    if (share != 1) {
      felt.depth = share > 0 ? felt.depth / share : 0;
      felt.p_WP = state.p_WT + felt.depth * felt.n_W;
    }
  }
  if (felt_count_ != 1 || felt_[0] != active.solid) leave_others(std::span(&active.solid, 1));
  driver::ForceCommand command = one.feel(state, felt);
  command.touch.object = members_[static_cast<std::size_t>(active.solid)].object;
  if (!command.touch.in_contact) command.touch.object = -1;
  return command;
}

driver::ForceCommand ContactWorld::feel_several(const driver::DeviceState& state) noexcept {
  Planes room;
  const std::span<const ActivePlane> all = planes(room);
  std::array<double, kActiveMax> stiffness{};
  std::array<std::int32_t, kActiveMax> felt{};
  std::size_t felt_count = 0;
  double stiffest = 0, lambda_sum = 0, squares = 0, weighted = 0;
  for (std::size_t i = 0; i < active_count_; ++i) {
    const double lambda = push_.lambda[i];
    if (!(lambda > 0)) continue;
    stiffness[i] = solid(active_[i].solid).stiffness();
    stiffest = std::max(stiffest, stiffness[i]);
    lambda_sum += lambda;
    squares += lambda * lambda;
    weighted += lambda * lambda * stiffness[i];
    felt[felt_count++] = active_[i].solid;
  }
  if (stiffest > stiffness_ref_) {
    if (stiffness_ref_ > 0) filter_.rescale(stiffness_ref_ / stiffest);
    stiffness_ref_ = stiffest;
  }
  SharedForce shared = shared_force_of(all, std::span(stiffness).first(active_count_), push_);
  ContactState goal{.touching = true, .triangle = active_[0].found.triangle};
  goal.n_W = active_[0].found.n_W;
  const double size = shared.f_W.norm();
  if (size > 0 && stiffness_ref_ > 0) {
    goal.depth = size / stiffness_ref_;
    goal.n_W = shared.f_W / size;
  }
  goal.p_WP = state.p_WT + goal.depth * goal.n_W;
  Vector3d f_W = shared.f_W;
  if (!filter_.follow(state.p_WT, goal)) {
    f_W = stiffness_ref_ * filter_.felt().depth * filter_.felt().n_W;
  }
  leave_others(std::span(felt).first(felt_count));
  // Each solid is felt with its part of the force; what no normal can give is shared.
  Vector3d rest = f_W;
  for (std::size_t i = 0; i < active_count_; ++i) {
    shared.part[i] = std::max(shared.part[i], 0.0);
    rest -= shared.part[i] * all[i].n;
  }
  const bool exact = rest.squaredNorm() <= 1e-24 * f_W.squaredNorm();
  driver::ForceCommand command;
  double deepest = -1;
  for (std::size_t i = 0; i < active_count_; ++i) {
    if (!(push_.lambda[i] > 0) || !(stiffness[i] > 0)) continue;
    ContactState contact = active_[i].found;
    contact.depth = shared.part[i] / stiffness[i];
    driver::DeviceState there = state;
    there.p_WT = shifted(state.p_WT, push_, i, 0);
    if (!exact) {
      const Vector3d way =
          contact.depth * contact.n_W + push_.lambda[i] / (lambda_sum * stiffness[i]) * rest;
      contact.depth = way.norm();
      if (contact.depth > 0) contact.n_W = way / contact.depth;
    }
    contact.p_WP = there.p_WT + contact.depth * contact.n_W;
    const driver::ForceCommand one = solid(active_[i].solid).feel(there, contact);
    command.f_T_W += one.f_T_W;
    command.stored += one.stored;
    command.f_program_W += one.f_program_W;
    if (!one.touch.in_contact || !(push_.lambda[i] > deepest)) continue;
    deepest = push_.lambda[i];
    command.touch = one.touch;
    command.touch.object = members_[static_cast<std::size_t>(active_[i].solid)].object;
  }
  // The contact as a whole.
  const double force = f_W.norm();
  if (command.touch.in_contact && felt_count > 1 && force > 0 && weighted > 0) {
    command.touch.depth = force * squares / weighted;
    command.touch.n_W = f_W / force;
    command.touch.p_WP = state.p_WT + command.touch.depth * command.touch.n_W;
  }
  return command;
}

}  // namespace thimble::render
