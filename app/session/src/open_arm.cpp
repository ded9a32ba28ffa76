#include "open_arm.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "setup.h"
#include "start_pose.h"

namespace thimble::session {
namespace {

/// Reads all idle arms for a short time. While the program waited for one arm, the reports of the
/// others became old, and simulated arms fell behind in time.
void catch_up(const Setup& setup) {
  constexpr int kTicks = 50;  // chosen: the longest time until a board sends reports
  driver::Clock& clock = setup.clock();
  for (int tick = 0; tick < kTicks; ++tick) {
    for (std::size_t i = 0; i < setup.arms(); ++i) {
      const std::int64_t now_ns = clock.now_ns();
      setup.device(i).idle(now_ns, now_ns);
    }
    clock.sleep_until_ns(clock.now_ns() + setup.period_ns());
  }
}

}  // namespace

bool agree_to_forces(const Session& session, bool agreed, const Terminal& terminal,
                     const std::atomic<bool>& stop) {
  const Setup& setup = session.setup();
  if (!setup.any_real()) return true;
  for (std::size_t i = 0; i < setup.arms(); ++i) {
    if (!setup.real_arm(i)) continue;
    const driver::FoundArm& arm = *setup.real_arm(i);
    const bool at_home = !setup.homed() && setup.start_pose(i).has_home();
    terminal.print_line(
        fmt::format("{} {} is about to apply forces. Keep clear of it, hold its grip{}, keep its "
                    "power switch within reach.",
                    arm.arm, arm.name(), at_home ? " in the home pose" : ""));
  }
  if (agreed) return true;
  if (!terminal.there) {
    terminal.print_line("thimble: There is no terminal to confirm; pass --yes to agree.");
    return false;
  }
  terminal.ask("Press Enter to start, Ctrl-C to quit.");
  while (!stop.load()) {
    const EnterKey key = terminal.key();
    if (key != EnterKey::kNothing) return key == EnterKey::kPressed;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

driver::Result<bool> open_arm(Session& session, const Terminal& terminal,
                              const std::atomic<bool>& stop) {
  if (auto opened = session.open_arm(); !opened) return opened.error();
  const Setup& setup = session.setup();
  if (!setup.any_real()) return true;
  for (std::size_t i = 0; i < setup.arms(); ++i) {
    if (!setup.real_arm(i)) continue;
    auto placed = wait_for_start_pose(setup.device(i), setup.clock(), setup.start_pose(i),
                                      !setup.homed(), terminal_of(setup, i, terminal), stop);
    if (!placed || !*placed) return placed;
  }
  if (setup.arms() > 1) {
    catch_up(setup);
    if (auto placed = setup.check_start_pose(); !placed) return placed.error();
  }
  if (auto activated = session.activate(); !activated) return activated.error();
  return true;
}

}  // namespace thimble::session
