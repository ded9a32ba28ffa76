#include "open_arm.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "setup.h"
#include "start_pose.h"

namespace thimble::session {

bool agree_to_forces(const Session& session, bool agreed, const Terminal& terminal,
                     const std::atomic<bool>& stop) {
  const Setup& setup = session.setup();
  if (!setup.real_arm()) return true;
  const driver::FoundArm& arm = *setup.real_arm();
  const bool at_home = !setup.homed() && setup.start_pose().has_home();
  terminal.tell(
      fmt::format("{} {} is about to get forces. Keep clear of it, hold its grip{}, keep its "
                  "switch at hand.",
                  arm.arm, arm.name(), at_home ? " in the home pose" : ""));
  if (agreed) return true;
  if (!terminal.there) {
    terminal.tell("thimble: Nobody is at the terminal to agree; say so with --yes.");
    return false;
  }
  terminal.ask("Press Enter to begin, Ctrl-C to leave.");
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
  if (!setup.real_arm()) return true;
  auto placed = wait_for_start_pose(setup.device(), setup.clock(), setup.start_pose(),
                                    !setup.homed(), terminal, stop);
  if (!placed || !*placed) return placed;
  if (auto activated = session.activate(); !activated) return activated.error();
  return true;
}

}  // namespace thimble::session
