#include "events/event_watch.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace thimble::session {
namespace {

double wall_force_squared(const std::array<double, 3>& f_W) noexcept {
  return f_W[0] * f_W[0] + f_W[1] * f_W[1] + f_W[2] * f_W[2];
}

}  // namespace

std::uint64_t DeviceCounters::changes() const noexcept {
  // All counts only increase, so their sum changes whenever one of them does.
  const ActivityCounts counts = DeviceCounters::activities();
  return std::accumulate(counts.begin(), counts.end(), DeviceCounters::links_replaced());
}

ActivityCounts DeviceCounters::activities() const noexcept {
  const driver::GateCounters& gate = device_.gate_counters();
  const driver::WireCounters& wire = device_.wire_counters();
  ActivityCounts counts{};
  const auto at = [&counts](Activity activity) -> std::uint64_t& {
    return counts[static_cast<std::size_t>(activity)];
  };
  at(Activity::kSoftStart) = gate.soft_started;
  at(Activity::kForceCut) = gate.limited;
  at(Activity::kRiseCut) = gate.rise_limited;
  at(Activity::kDamped) = gate.damped;
  at(Activity::kBounded) = gate.bounded;
  at(Activity::kHeat) = device_.heat().lowered();
  at(Activity::kStall) = gate.stalls;
  at(Activity::kRejected) = wire.rejected;
  at(Activity::kJumped) = wire.jumped;
  at(Activity::kRefused) = wire.refused;
  at(Activity::kPower) = gate.power_limited;
  at(Activity::kCalmed) = gate.calmed;
  at(Activity::kWall) = device_.wall_counters().pushed;
  return counts;
}

std::uint64_t DeviceCounters::links_replaced() const noexcept {
  return device_.wire_counters().replugged;
}

std::array<double, 3> DeviceCounters::f_wall_W() const noexcept {
  const Eigen::Vector3d& f_W = device_.wall_counters().f_W;
  return {f_W.x(), f_W.y(), f_W.z()};
}

EventWatch::EventWatch(const EventCounters& counters, std::int64_t period_ns,
                       SpscRing<TickEvent>& ring) noexcept
    : counters_(counters),
      period_ns_(period_ns),
      ring_(ring),
      changes_(counters.changes()),
      counts_(counters.activities()),
      links_replaced_(counters.links_replaced()) {}

void EventWatch::push(const TickEvent& event) noexcept {
  if (!ring_.push(event)) lost_.fetch_add(1, std::memory_order_relaxed);
}

// Returns whether nothing has changed since the last tick, as in nearly every tick.
bool EventWatch::quiet(const driver::TickRecord& record) const noexcept {
  return counters_.changes() == changes_ && record.in_contact == touching_ &&
         record.stage == stage_ && record.fault == fault_ && record.link == link_ &&
         record.time_ns <= earliest_end_ns_ && record.due_ns - due_ns_ < 2 * period_ns_;
}

void EventWatch::take(const driver::TickRecord& record) noexcept {
  if (!quiet(record)) examine(record);
  begun_ = true;
  tick_ = record.tick;
  time_ns_ = record.time_ns;
  due_ns_ = record.due_ns;
}

void EventWatch::examine(const driver::TickRecord& record) noexcept {
  changes_ = counters_.changes();
  const std::uint64_t links_replaced = counters_.links_replaced();
  if (links_replaced != links_replaced_) {
    links_replaced_ = links_replaced;
    push({.tick = record.tick, .time_ns = record.time_ns, .kind = EventKind::kLinkReplaced});
  }
  watch_stage(record);
  if (record.in_contact != touching_) {
    touching_ = record.in_contact;
    push({.tick = record.tick,
          .time_ns = record.time_ns,
          .kind = touching_ ? EventKind::kTouchBegan : EventKind::kTouchEnded,
          .object = record.object});
  }
  watch_activities(record);
}

void EventWatch::watch_stage(const driver::TickRecord& record) noexcept {
  using driver::DeviceStage;
  if (record.stage != stage_ && record.stage == DeviceStage::kActive) {
    push({.tick = record.tick, .time_ns = record.time_ns, .kind = EventKind::kActivated});
  }
  if (record.stage != stage_ && record.stage == DeviceStage::kWaiting) {
    push({.tick = record.tick, .time_ns = record.time_ns, .kind = EventKind::kWaiting});
  }
  if (record.stage != stage_ && record.stage == DeviceStage::kIdle) {
    push({.tick = record.tick, .time_ns = record.time_ns, .kind = EventKind::kDeactivated});
  }
  if (record.fault != fault_ && record.fault != driver::Fault::kNone) {
    push({.tick = record.tick,
          .time_ns = record.time_ns,
          .kind = EventKind::kFault,
          .fault = record.fault});
  }
  // These faults already report the state of the link.
  const bool named_by_fault =
      record.fault != fault_ &&
      (record.fault == driver::Fault::kTransportLost || record.fault == driver::Fault::kNoReports);
  // A new link is silent until its first report.
  const bool new_link =
      link_ == driver::LinkState::kLost && record.link == driver::LinkState::kSilent;
  if (record.link != link_ && !named_by_fault && !new_link) {
    push({.tick = record.tick,
          .time_ns = record.time_ns,
          .kind = EventKind::kLinkChanged,
          .link = record.link});
  }
  stage_ = record.stage;
  fault_ = record.fault;
  link_ = record.link;
}

void EventWatch::watch_activities(const driver::TickRecord& record) noexcept {
  ActivityCounts counts = counters_.activities();
  // Ticks are due at whole periods; a late loop skips some.
  constexpr auto kMissed = static_cast<std::size_t>(Activity::kMissedTicks);
  const std::int64_t periods = begun_ ? (record.due_ns - due_ns_) / period_ns_ : 1;
  counts[kMissed] = counts_[kMissed] + static_cast<std::uint64_t>(periods > 1 ? periods - 1 : 0);
  earliest_end_ns_ = kNever_ns;
  for (std::size_t i = 0; i < kActivities; ++i) {
    Episode& episode = episodes_[i];
    const auto activity = static_cast<Activity>(i);
    if (changes_force(activity)) watch_change(record, activity, counts[i] != counts_[i]);
    if (counts[i] == counts_[i]) {
      if (episode.count > 0 && record.time_ns - episode.newest_ns > kQuiet_ns) {
        tick_ = record.tick;
        time_ns_ = record.time_ns;
        end(activity, episode);
      }
      wait_for(episode);
      continue;
    }
    const auto f_wall_W =
        activity == Activity::kWall ? counters_.f_wall_W() : std::array<double, 3>{};
    if (episode.count == 0) {
      episode.began_ns = record.time_ns;
      episode.f_wall_W = f_wall_W;
      push({.tick = record.tick,
            .time_ns = record.time_ns,
            .kind = EventKind::kActivityBegan,
            .activity = activity,
            .f_wall_W = f_wall_W});
    }
    if (wall_force_squared(f_wall_W) > wall_force_squared(episode.f_wall_W))
      episode.f_wall_W = f_wall_W;
    episode.newest_ns = record.time_ns;
    episode.count += counts[i] - counts_[i];
    wait_for(episode);
  }
  counts_ = counts;
}

void EventWatch::watch_change(const driver::TickRecord& record, Activity activity,
                              bool acted) noexcept {
  Change& change = changes_of_force_[static_cast<std::size_t>(activity)];
  if (change.reported) return;
  double off = 0, wanted = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double difference = record.f_sent_W[k] - record.f_wanted_W[k];
    off += difference * difference;
    wanted += record.f_wanted_W[k] * record.f_wanted_W[k];
  }
  // Written so that NaN changes nothing: it is a fault.
  if (!(acted && off > kChange * kChange * wanted && off > 0)) {
    change.newest_ns = kLongAgo_ns;
    return;
  }
  // Ticks in which no stage acted are not examined.
  if (record.time_ns - change.newest_ns >= 2 * period_ns_) change.began_ns = record.time_ns;
  change.newest_ns = record.time_ns;
  if (record.time_ns - change.began_ns < kChangeTime_ns) return;
  change.reported = true;
  const double share = wanted > 0 ? std::min(1.0, std::sqrt(off / wanted)) : 1.0;
  push({.tick = record.tick,
        .time_ns = record.time_ns,
        .count = static_cast<std::uint64_t>(std::lround(100 * share)),
        .kind = EventKind::kForceChanged,
        .activity = activity});
}

void EventWatch::wait_for(const Episode& episode) noexcept {
  if (episode.count == 0) return;
  earliest_end_ns_ = std::min(earliest_end_ns_, episode.newest_ns + kQuiet_ns);
}

void EventWatch::end(Activity activity, Episode& episode) noexcept {
  push({.tick = tick_,
        .time_ns = time_ns_,
        .count = episode.count,
        .lasted_ns = episode.newest_ns - episode.began_ns,
        .kind = EventKind::kActivityEnded,
        .activity = activity,
        .f_wall_W = episode.f_wall_W});
  episode.count = 0;
}

void EventWatch::finish() noexcept {
  for (std::size_t i = 0; i < kActivities; ++i) {
    if (episodes_[i].count > 0) end(static_cast<Activity>(i), episodes_[i]);
  }
}

}  // namespace thimble::session
