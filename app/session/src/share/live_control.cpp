#include "share/live_control.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

#include "hold_key.h"

namespace thimble::session {

LiveControl::LiveControl(const scene::Scene& scene, render::SceneTouch& touch,
                         scene::ArmSimulation* simulation, bool real_time)
    : simulation_(simulation), real_time_(real_time), knobs_(scene, touch) {
  hand_.p_WH.fill(std::numeric_limits<double>::quiet_NaN());  // differs from every request
}

void LiveControl::add_simulation(scene::ArmSimulation* simulation) {
  several_ = true;
  if (simulation != nullptr) others_.push_back(simulation);
}

void LiveControl::join(SharedRun& shared, bool hand_by_mouse, const std::atomic<bool>& stop,
                       SpeedClock* pace) {
  shared_ = &shared;
  hand_by_mouse_ = hand_by_mouse;
  stop_ = &stop;
  pace_ = pace;
}

void LiveControl::begin_tick(const driver::DeviceState& state) noexcept {
  change_ = {};
  if (!several_) {
    knobs_.step(*shared_, last_, state.dt);
    change_ = knobs_.change();
  }
  if (!real_time_) return;
  const double way = state.dt / kFade;
  gain_ = std::clamp(gain_ + (paused_ ? -way : way), 0.0, 1.0);
  change_.gain = gain_;
}

void LiveControl::take(const driver::TickRecord& record) noexcept {
  last_ = record;
  if (shared_ == nullptr) return;  // not connected: the session is stepped directly
  const bool paused = shared_->pause_asked();
  if (paused != paused_) {
    paused_ = paused;
    steps_ = shared_->steps_asked();  // earlier requests are dropped
    shared_->set_state(paused ? RunState::kPaused : RunState::kRunning);
    if (simulation_ != nullptr && real_time_) simulation_->hold(paused);
    for (scene::ArmSimulation* other : others_) {
      if (real_time_) other->hold(paused);
    }
  }
  if (hand_by_mouse_ && simulation_ != nullptr) lead_hand();
  if (simulation_ != nullptr) hold_buttons(record.time_ns);
  if (paused_ && !real_time_) wait_while_paused();
  if (pace_ == nullptr) return;
  if (const auto speed = shared_->speed_wanted()) pace_->set_speed(*speed);
}

void LiveControl::lead_hand() noexcept {
  SharedHand asked;
  if (!shared_->hand(asked) || asked.p_WH == hand_.p_WH) return;
  hand_ = asked;
  simulation_->lead(Eigen::Map<const Eigen::Vector3d>(asked.p_WH.data()));
}

// A viewer that is closed or hangs draws no pictures; its buttons are then released.
void LiveControl::hold_buttons(std::int64_t now_ns) noexcept {
  const std::uint64_t asked = shared_->buttons_asked();
  if (asked != buttons_) {
    buttons_ = asked;
    buttons_until_ns_ = now_ns + HeldKey::kLasts_ns;
  } else if ((asked & 0xffffU) == 0 || now_ns <= buttons_until_ns_) {
    return;
  }
  const bool held = now_ns <= buttons_until_ns_;
  simulation_->hold_buttons(held ? static_cast<std::uint16_t>(asked & 0xffffU) : std::uint16_t{0});
}

void LiveControl::wait_while_paused() noexcept {
  while (shared_->pause_asked() && !stop_->load(std::memory_order_relaxed)) {
    // The difference of unsigned counters is valid after a wrap. A larger one is invalid and is
    // dropped.
    const std::uint64_t wanted = shared_->steps_asked() - steps_;
    if (wanted > kStepsMax) steps_ += wanted;
    if (wanted > 0 && wanted <= kStepsMax) {
      ++steps_;
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  paused_ = false;
  shared_->set_state(RunState::kRunning);
}

}  // namespace thimble::session
