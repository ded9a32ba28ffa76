// Requests of viewers to restart, single-step, or change the speed of a run.
#include <algorithm>
#include <cmath>

#include "share/shared_reader.h"

namespace thimble::session {

std::string SharedReader::why_real() const {
  const auto real = [](const SharedScene::Arm& arm) { return arm.device != "sim"; };
  const auto found = std::find_if(scene_.arms.begin(), scene_.arms.end(), real);
  if (found == scene_.arms.end()) return {};
  return "The run has a physical arm (" + found->device +
         "): it runs in real time and can only be paused and stopped. Only a person at the arm may "
         "start a run.";
}

driver::Result<void> SharedReader::check_accepted() const {
  // Pairs with SharedRun::close: either the run sees the request, or this sees that it is closed.
  std::atomic_thread_fence(std::memory_order_seq_cst);
  if (live_->closed.load() != 1) return {};
  return driver::Error{
      "The run has just ended and accepts no requests. If it restarts, try again shortly."};
}

std::string SharedReader::why_no_restart() const {
  if (std::string real = why_real(); !real.empty()) return real;
  if (scene_.restarts) return {};
  return "This run cannot be restarted from a viewer; restart it in the terminal where it was "
         "started.";
}

std::string SharedReader::why_no_step() const {
  if (std::string real = why_real(); !real.empty()) return real;
  if (!scene_.wall_clock) return {};
  return "This run is in real time, which has no single ticks; start it with --clock paced.";
}

std::string SharedReader::why_no_speed() const {
  if (std::string real = why_real(); !real.empty()) return real;
  if (scene_.paced) return {};
  return scene_.wall_clock
             ? "This run is in real time; start it with --clock paced to choose its speed."
             : "This run is as fast as possible; start it with --clock paced to choose its speed.";
}

driver::Result<void> SharedReader::ask_steps(std::uint64_t ticks) {
  if (std::string why = why_no_step(); !why.empty()) return driver::Error{why};
  if (auto now = check_accepted(); !now) return now;
  if (state() != RunState::kPaused) {
    return driver::Error{"Only a paused run can be single-stepped; pause it first."};
  }
  live_->requests.steps.fetch_add(std::clamp<std::uint64_t>(ticks, 1, kStepsMax));
  return check_accepted();
}

driver::Result<void> SharedReader::ask_speed(double speed) {
  if (std::string why = why_no_speed(); !why.empty()) return driver::Error{why};
  if (auto now = check_accepted(); !now) return now;
  if (std::isnan(speed)) return driver::Error{"The speed must be a number from 0.1 to 4."};
  live_->requests.speed.store(std::clamp(speed, kSpeedMin, kSpeedMax));
  return check_accepted();
}

double SharedReader::speed_asked() const noexcept {
  const double speed = live_->requests.speed.load();
  return speed >= kSpeedMin && speed <= kSpeedMax ? speed : 1;
}

driver::Result<void> SharedReader::ask_restart(const std::string& scene) {
  if (std::string why = why_no_restart(); !why.empty()) return driver::Error{why};
  if (auto now = check_accepted(); !now) return now;
  SharedRestart order;
  if (scene.size() >= order.scene.size()) {
    return driver::Error{"The path of the scene is too long; copy the file to a shorter path."};
  }
  if (!take_turn()) return driver::Error{"Another viewer is sending a request; try again."};
  order.number = live_->requests.restart_number.load() + 1;
  std::copy(scene.begin(), scene.end(), order.scene.begin());
  live_->requests.restart.store(order);
  live_->requests.restart_number.store(order.number);
  end_turn();
  return check_accepted();
}

driver::Result<void> SharedReader::ask_loop(bool loop) {
  if (std::string why = why_no_restart(); !why.empty()) return driver::Error{why};
  if (auto now = check_accepted(); !now) return now;
  live_->requests.loop.store(loop ? 1 : 0);
  return check_accepted();
}

}  // namespace thimble::session
