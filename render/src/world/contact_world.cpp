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

// Number of steps of the solids after which a tick ends: a step of a ball may take 60 us on a fine
// mesh. With this bound 372 of 35,201 ticks of a ball in contact did not settle on rough foreign
// meshes, without it 327. [measured: WorldForeign]
constexpr int kStepsMax = 256;

// Maximum number of times that active solids are followed until they agree on where the tip is
// pushed. Faces take 1 or 2. [chosen]
constexpr int kAgreeMax = 12;

// Longest way out of a notch between faces, in lifts: 2 degrees. [chosen]
constexpr double kNotchMax = 64;

// Depth at which an active solid is followed at least, in lifts. The others may lift the tip off it
// by their lifts. [chosen]
constexpr double kNearest = 64;

// Way of the tip after which a refused tracker is asked again, as a share of the depth: where faces
// meet, trackers hop within about the depth. [chosen]
constexpr double kAskAgain = 0.125;

// Number of solids in the neighbourhood up to which a larger one is worthwhile. [chosen]
constexpr std::size_t kFew = 12;

// Guesses where the rounds of a tick lead. In a groove between curved surfaces, each round leaves
// the same share r of the way along the groove, so three rounds give the rest (Aitken's method).
class Extrapolation {
 public:
  Vector3d ahead{0, 0, 0};  // guess of the way from the last round to the end

  void add(const Vector3d& d) noexcept {
    ahead.setZero();
    if (known_ == 2) {
      const Vector3d first = before_[1] - before_[0], second = d - before_[1];
      const double share = second.dot(first) / first.squaredNorm();
      // Written so that NaN adds nothing.
      if (share > 0 && share < kShareMax) {
        ahead = share / (1 - share) * second;
        known_ = 0;
        return;
      }
      before_[0] = before_[1];
      known_ = 1;
    }
    before_[known_++] = d;
  }

 private:
  static constexpr double kShareMax = 0.9;  // [chosen]

  std::array<Vector3d, 2> before_;
  std::size_t known_ = 0;
};

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
    has_trackers_ = has_trackers_ || !members_[i].solid->follows_closely();
    lift_ = std::max(lift_, kLift * members_[i].solid->rounding());
    const SolidBox& box = tree_.box(static_cast<std::int32_t>(i));
    if (!members_[i].solid->moves()) sides += (box.max - box.min).maxCoeff();
    const bool moves = members_[i].solid->moves();
    if (members_[i].solid->changes()) {
      changing_.push_back(static_cast<std::int32_t>(i));
      ball_of_.push_back(moves ? static_cast<std::int32_t>(moving_.size()) : -1);
    }
    if (moves) moving_.push_back(static_cast<std::int32_t>(i));
  }
  balls_.resize(moving_.size());
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
             moving_.empty() && (p_WT - near_centre_).squaredNorm() < near_squared_) {
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

SolidMove ContactWorld::begin_tick(std::size_t changing, const driver::DeviceState& state,
                                   const Vector3d& p_WP, bool touching) noexcept {
  const SolidMove move = solid(changing_[changing]).begin_tick(state, p_WP, touching);
  if (const std::int32_t ball = ball_of_[changing]; ball >= 0) {
    balls_[static_cast<std::size_t>(ball)] = {.p_centre = move.p_centre, .radius = move.radius};
  }
  return move;
}

// Lets the solids that change take their place of this tick, and carry the proxy along.
void ContactWorld::carry(const driver::DeviceState& state) noexcept {
  double path = 0;
  for (std::size_t k = 0; k < changing_.size(); ++k) {
    const std::int32_t i = changing_[k];
    const bool touching = is_active(i);
    const SolidMove move = begin_tick(k, state, p_WQ_, touching);
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
  for (std::size_t k = 0; k < changing_.size(); ++k) begin_tick(k, state, p_WT, false);
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

ContactWorld::Planes ContactWorld::planes() const noexcept {
  Planes list;
  const auto add = [&](std::size_t owner, const ActivePlane& plane) {
    list.plane[list.count] = plane;
    list.owner[list.count++] = owner;
  };
  for (std::size_t i = 0; i < active_count_; ++i) {
    const Active& active = active_[i];
    // Each solid has at least one plane.
    const std::size_t room = kPlanesMax - list.count - (active_count_ - 1 - i);
    if (active.face_count == 0 || active.face_count > room) {
      add(i, active.plane);
      continue;
    }
    const Vector3d p_W = active.at_W + active.found.depth * active.found.n_W;
    for (std::size_t k = 0; k < active.face_count; ++k) {
      add(i, {.n = active.faces_W[k], .offset = active.faces_W[k].dot(p_W)});
    }
  }
  return list;
}

// Returns the shortest way out of all planes.
ContactWorld::Push ContactWorld::push(const Vector3d& p_WT) const noexcept {
  if (active_count_ == 1 && active_[0].face_count == 0) {
    const ActivePlane& plane = active_[0].plane;
    Push push;
    push.out.lambda[0] = push.lambda[0] = std::max(0.0, plane.depth(p_WT));
    push.out.d = push.way[0] = push.lambda[0] * plane.n;
    push.n[0] = plane.n;
    return push;
  }
  const Planes list = planes();
  Push push;
  push.out = push_out(list.all(), p_WT, 0, lift_ / 4);
  for (std::size_t i = 0; i < active_count_; ++i) {
    push.way[i].setZero();
    push.n[i] = active_[i].plane.n;
  }
  for (std::size_t k = 0; k < list.count; ++k) {
    if (!(push.out.lambda[k] > 0)) continue;
    const std::size_t i = list.owner[k];
    push.way[i] += push.out.lambda[k] * list.plane[k].n;
    push.n[i] = list.plane[k].n;
    push.lambda[i] = push.lambda[i] == 0 ? push.out.lambda[k] : -1;  // -1: of several planes
  }
  for (std::size_t i = 0; i < active_count_; ++i) {
    if (push.lambda[i] != -1) continue;
    push.lambda[i] = push.way[i].norm();
    push.n[i] = push.way[i] / push.lambda[i];
  }
  return push;
}

// Returns the point closest to the tip that is in front of all planes by the lift.
Vector3d ContactWorld::lifted(const Vector3d& p_WT) const noexcept {
  if (active_count_ == 1 && active_[0].face_count == 0) {
    const ActivePlane& plane = active_[0].plane;
    return p_WT + std::max(0.0, plane.depth(p_WT) + lift_) * plane.n;
  }
  const Planes list = planes();
  return p_WT + push_out(list.all(), p_WT, lift_, lift_ / 4).d;
}

// Moves the proxy to where the active solids let it, and begins those that it meets on its way.
void ContactWorld::move(const Vector3d& p_WT) noexcept {
  std::array<std::pair<std::int32_t, std::int32_t>, kActiveMax> held;  // solid, triangle
  const std::size_t held_count = active_count_;
  for (std::size_t i = 0; i < held_count; ++i) {
    held[i] = {active_[i].solid, active_[i].found.triangle};
    active_[i].tried = false;
  }
  // On its way the proxy may have cut through a solid, or a tracker may have led it into one. It
  // stays where it was, with the solids that held it there.
  const auto put_back = [&] {
    active_count_ = 0;
    for (std::size_t i = 0; i < held_count; ++i) begin(held[i].first, held[i].second, p_WQ_);
    reached_ = p_WQ_;
  };
  steps_ = 0;
  const bool settled = settle(p_WT);
  counters_.steps_max = std::max(counters_.steps_max, steps_);
  if (settled) return;
  // Proxies that only move where they can reach are tried instead of the trackers.
  if (has_trackers_) {
    put_back();
    ++counters_.hidden;
    closely_ = true;
    const bool by_proxies = settle(p_WT);
    closely_ = false;
    if (by_proxies) return;
  }
  // The next tick tries again.
  ++counters_.unsettled;
  put_back();
  push_ = push(p_WT);
}

// Moves the proxy as `move` does. Returns false if the rounds of a tick do not suffice, or if the
// proxy would be inside a solid.
bool ContactWorld::settle(const Vector3d& p_WT) noexcept {
  reached_ = p_WQ_;
  int agreed = 0;
  Extrapolation rounds;
  const auto begun = counters_.begun;
  bool dropped = false;
  for (int round = 0; round < kRoundsMax && steps_ < kStepsMax; ++round) {
    const bool ended = active_count_ > 0 && follow_active(p_WT, rounds.ahead);
    if (ended) {
      // Over the extended faces of those that have let go.
      if (advance(lifted(p_WT))) {
        // Stopped before the end of those faces.
        revive_ended();
      } else if (inside_ended()) {
        return false;
      } else {
        drop_ended();
        dropped = true;
      }
      rounds = {};
      continue;
    }
    if (active_count_ == 0) {
      push_ = {};
    } else {
      push_ = push(p_WT);
      if (active_count_ > 1 && !agrees(p_WT, push_) && ++agreed < kAgreeMax) {
        rounds.add(push_.out.d);
        continue;
      }
    }
    rounds = {};
    if (advance(active_count_ == 0 ? p_WT : lifted(p_WT))) {
      agreed = 0;
      continue;
    }
    // A proxy that follows closely and continues on a single solid enters none.
    const bool changed = active_count_ > 1 || dropped || counters_.begun != begun ||
                         (active_count_ == 1 && led_by_tracker(active_[0].solid));
    if (changed && enters_solid()) return false;
    p_WQ_ = reached_;
    if (!ghosts_.empty()) forget_left();
    return true;
  }
  return false;
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
  if (!moving_.empty()) {
    const double step = (goal - reached_).norm();
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      if (balls_[k].meets(reached_, step)) meet(moving_[k]);
    }
  }
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
  push_.way[slot].setZero();
  Active& active = active_[slot];
  active = {};
  active.solid = i;
  active.fresh = true;
  active.found = solid(i).begin(triangle, p_W);
  active.plane = {.n = active.found.n_W, .offset = active.found.n_W.dot(p_W)};
  ++counters_.begun;
  // In front of it, and of the others that it meets there.
  Planes close = planes();
  std::size_t count = 0;
  for (std::size_t k = 0; k < close.count; ++k) {
    if (std::abs(close.plane[k].depth(p_W)) < 4 * lift_) close.plane[count++] = close.plane[k];
  }
  close.count = count;
  reached_ = p_W + push_out(close.all(), p_W, lift_, lift_ / 4).d;
}

// Returns the tip as pushed out by all active solids but `i`, and `lift` off them.
Vector3d ContactWorld::shifted(const Vector3d& p_WT, const Push& push, std::size_t i,
                               double lift) const noexcept {
  Vector3d x = p_WT;
  for (std::size_t k = 0; k < active_count_; ++k) {
    if (k == i || !(push.lambda[k] > 0)) continue;
    x += push.way[k] + lift * push.n[k];
  }
  return x;
}

// Returns by how much the position at which solid i is followed lies nearer to its surface than the
// tip as pushed out by the others. The proxy of a solid is the same for all positions below it on
// the normal there (or in the cone of normals), but on a curved surface the plane of a deep
// position is a worse guess: with a depth l below a sphere of radius r an error grows by l / (r -
// l) in each round. At the depth t, where t is the way from the last contact to where the planes
// now lead, it falls to about t^2 / r, as in Newton's method.
double ContactWorld::nearer(const Vector3d& p_WT, const Push& push, std::size_t i) const noexcept {
  const double lambda = push.lambda[i];
  if (!(lambda > 0)) return 0;
  const double way = (p_WT + push.out.d - active_[i].found.p_WP).norm();
  return std::max(0.0, lambda - std::max(way, kNearest * lift_));
}

// Follows each active solid at the tip as the others push it. Returns whether one has let go.
bool ContactWorld::follow_active(const Vector3d& p_WT, const Vector3d& ahead) noexcept {
  Push push;
  if (active_count_ > 1) push = this->push(p_WT);
  bool ended = false;
  for (std::size_t i = 0; i < active_count_; ++i) {
    Active& active = active_[i];
    active.at_W = shifted(p_WT, push, i, lift_);
    if (active_count_ > 1) active.at_W += nearer(p_WT, push, i) * push.n[i] + ahead;
    const ContactState found = follow_one(active);
    steps_ += solid(active.solid).steps();
    active.fresh = false;
    // Written so that NaN lets go.
    active.ended = !(found.touching && found.depth >= 0);
    if (active.ended) {
      ended = true;
      continue;
    }
    active.found = found;
    active.plane = {.n = found.n_W, .offset = found.n_W.dot(active.at_W) + found.depth};
    active.face_count = active_count_ > 1 ? solid(active.solid).holding_faces(active.faces_W) : 0;
  }
  return ended;
}

// Follows one solid. A proxy inside another solid is refused: it is on a side that the proxy of the
// world cannot reach.
const ContactState& ContactWorld::follow_one(Active& active) noexcept {
  WorldSolid& one = solid(active.solid);
  if (closely_ && !one.follows_closely()) {
    active.closely = active.tried = true;
    active.refused_at_W = active.at_W;
    return one.follow_closely(active.found, active.at_W);
  }
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
  Planes list;
  for (std::size_t i = 0; i < active_count_; ++i) list.plane[i] = active_[i].plane;
  list.count = active_count_;
  list.plane[static_cast<std::size_t>(&active - active_.data())] = {
      .n = found.n_W, .offset = found.n_W.dot(found.p_WP)};
  const PushOut off = push_out(list.all(), found.p_WP, lift_, lift_ / 4);
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
  return std::any_of(near_.begin(), near_.end(), near_holds) || any_moving_at(p_W, holds);
}

// Returns whether the active solids were followed where `push` leads.
bool ContactWorld::agrees(const Vector3d& p_WT, const Push& push) const noexcept {
  for (std::size_t i = 0; i < active_count_; ++i) {
    Vector3d off = shifted(p_WT, push, i, lift_) - active_[i].at_W;
    if (push.lambda[i] > 0) off -= push.n[i].dot(off) * push.n[i];
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

// Returns whether the proxy has cut into a curved solid that now lets go, so that its surface would
// not be met any more. Only where the tracker's surface is that of the solid.
bool ContactWorld::inside_ended() const noexcept {
  for (std::size_t i = 0; i < active_count_; ++i) {
    const WorldSolid& one = solid(active_[i].solid);
    if (active_[i].ended && one.follows_closely() && one.inside(reached_)) return true;
  }
  return false;
}

// Returns whether a tracker may lead its proxy into the solid itself, with a surface that is that
// of the triangles.
bool ContactWorld::led_by_tracker(std::int32_t i) const noexcept {
  const WorldSolid& one = solid(i);
  return one.is_exact() && !one.follows_closely() && !one.changes();
}

// Returns whether the proxy has come into a solid in this tick. The surface of a tracker that holds
// it may be another one than that of the triangles.
bool ContactWorld::enters_solid() noexcept {
  look_around(reached_, reached_);
  const auto holds = [&](std::int32_t i) {
    const WorldSolid& one = solid(i);
    // A god-object stays on its surface, also where that passes through itself.
    const bool slides = active_count_ == 1 && one.follows_closely() && one.steps() == 0;
    const bool smoothed = !one.follows_closely() && !led_by_tracker(i);
    if (is_active(i) && (slides || smoothed)) return false;
    // One in which the proxy has been before lets it out.
    return one.inside(reached_) && !is_ghost(i) && !one.in_solid(p_WQ_);
  };
  const auto near_holds = [&](std::int32_t i) {
    return squared_distance(tree_.box(i), reached_) == 0 && holds(i);
  };
  return std::any_of(near_.begin(), near_.end(), near_holds) || any_moving_at(reached_, holds);
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
  Active& active = active_[0];
  WorldSolid& one = solid(active.solid);
  // A setting that is turned acts at once; the path of the tip bounds only what the tip causes.
  const double now = one.stiffness();
  if (now > 0) {
    if (stiffness_ref_ == active.stiffness) {
      stiffness_ref_ = now;
    } else if (active.stiffness > 0) {
      stiffness_ref_ *= now / active.stiffness;
    }
    active.stiffness = now;
  }
  const double stiffness = active.stiffness;
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
  const Planes list = planes();
  std::array<double, kActiveMax> stiffness{};
  std::array<double, kPlanesMax> plane_stiffness{};
  std::array<std::int32_t, kActiveMax> felt{};
  std::size_t felt_count = 0;
  double stiffest = 0, lambda_sum = 0, squares = 0, weighted = 0;
  std::array<double, kPlanesMax> plane_stiffness_before{};
  bool turned = false;
  // In a tick that has not settled, the faces to which the proxy was put back may be in front of
  // the tip. What the filter leaves of the force is then felt on one solid.
  std::array<double, kActiveMax> share = push_.lambda;
  const auto presses = [](double lambda) { return lambda > 0; };
  const auto end = share.begin() + static_cast<std::ptrdiff_t>(active_count_);
  if (std::none_of(share.begin(), end, presses)) share[0] = 1;
  for (std::size_t i = 0; i < active_count_; ++i) {
    const double lambda = share[i];
    if (!(lambda > 0)) continue;
    stiffness[i] = solid(active_[i].solid).stiffness();
    stiffest = std::max(stiffest, stiffness[i]);
    lambda_sum += lambda;
    felt[felt_count++] = active_[i].solid;
  }
  for (std::size_t k = 0; k < list.count; ++k) {
    const double squared = push_.out.lambda[k] * push_.out.lambda[k];
    plane_stiffness[k] = stiffness[list.owner[k]];
    const double before = active_[list.owner[k]].stiffness;
    plane_stiffness_before[k] = before > 0 ? before : plane_stiffness[k];
    turned = turned || plane_stiffness_before[k] != plane_stiffness[k];
    squares += squared;
    weighted += squared * plane_stiffness[k];
  }
  if (stiffest > stiffness_ref_) {
    if (stiffness_ref_ > 0) filter_.rescale(stiffness_ref_ / stiffest);
    stiffness_ref_ = stiffest;
  }
  const SharedForce shared =
      shared_force_of(list.all(), std::span(plane_stiffness).first(list.count), push_.out);
  if (turned) {
    // As in feel_one.
    const double before =
        shared_force_of(list.all(), std::span(plane_stiffness_before).first(list.count), push_.out)
            .f_W.norm();
    const double after = shared.f_W.norm();
    if (before > 0 && after > 0) stiffness_ref_ *= after / before;
  }
  for (std::size_t i = 0; i < active_count_; ++i) {
    if (stiffness[i] > 0) active_[i].stiffness = stiffness[i];
  }
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
  std::array<Vector3d, kActiveMax> part;
  part.fill(Vector3d::Zero());
  Vector3d rest = f_W;
  for (std::size_t k = 0; k < list.count; ++k) {
    if (!(shared.part[k] > 0)) continue;
    const Vector3d one = shared.part[k] * list.plane[k].n;
    part[list.owner[k]] += one;
    rest -= one;
  }
  const bool exact = rest.squaredNorm() <= 1e-24 * f_W.squaredNorm();
  driver::ForceCommand command;
  double deepest = -1;
  for (std::size_t i = 0; i < active_count_; ++i) {
    if (!(share[i] > 0) || !(stiffness[i] > 0)) continue;
    if (!exact) part[i] += share[i] / lambda_sum * rest;
    ContactState contact = active_[i].found;
    contact.n_W = push_.n[i];
    const double size_i = part[i].norm();
    contact.depth = size_i / stiffness[i];
    if (size_i > 0) contact.n_W = part[i] / size_i;
    driver::DeviceState there = state;
    there.p_WT = shifted(state.p_WT, push_, i, 0);
    contact.p_WP = there.p_WT + contact.depth * contact.n_W;
    const driver::ForceCommand one = solid(active_[i].solid).feel(there, contact);
    command.f_T_W += one.f_T_W;
    command.stored += one.stored;
    command.f_program_W += one.f_program_W;
    if (!one.touch.in_contact || !(share[i] > deepest)) continue;
    deepest = share[i];
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
