#include "cli/wire/wire_serve.h"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include "board/port_board.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "signals.h"
#include "simulated_arm.h"
#include "thimble/driver/clock.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::cli {
namespace {

/// A pseudo-terminal; closed at the end.
class Terminal {
 public:
  Terminal() : file_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (file_ < 0 || grantpt(file_) != 0 || unlockpt(file_) != 0) return;
    const char* const name = ptsname(file_);
    if (name == nullptr) return;
    name_ = name;
    // The other end is not held open, because programs that check who uses the port would refuse
    // it. Without a reader, reads fail until the next one opens it.
    termios settings{};
    if (tcgetattr(file_, &settings) != 0) return;
    cfmakeraw(&settings);
    tcsetattr(file_, TCSANOW, &settings);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() {
    if (file_ >= 0) close(file_);
  }
  int file() const { return file_; }
  const std::string& name() const { return name_; }

 private:
  int file_;
  std::string name_;
};

int serve(const std::string& arm) {
  const auto file = scene::load_arm(arm);
  if (!file) return report_error(file.error(), kExitBadInput);
  if (!file->wire || !file->can_simulate) {
    return report_error({arm + ": needs protocol: described and a section simulation."},
                        kExitBadInput);
  }
  auto simulation = scene::ArmSimulation::make(*file, {{0.0, file->workspace.middle()}});
  if (!simulation) return report_error(simulation.error(), kExitBadInput);
  device_sim::SimulatedArm* const simulated = (*simulation)->board_arm();
  const Terminal terminal;
  if (terminal.name().empty() || simulated == nullptr) {
    return report_error({"The pseudo-terminal could not be opened."}, kExitTrouble);
  }
  scene::print_format("The board of %s is at %s. Press Ctrl-C to end it.\n", file->name.c_str(),
                      terminal.name().c_str());
  std::fflush(stdout);
  device_sim::PortBoard board(*simulated, file->wire);
  driver::WallClock clock;
  const std::int64_t begin_ns = clock.now_ns();
  constexpr std::int64_t kStep_ns = 100'000;  // [chosen: a tenth of a USB frame]
  const std::atomic<bool>& stop = scene::catch_interrupts();
  while (!stop.load()) {
    std::array<std::byte, 512> bytes;
    board.advance_to(clock.now_ns() - begin_ns);
    if (const ssize_t size = read(terminal.file(), bytes.data(), bytes.size()); size > 0) {
      board.hear(std::span<const std::byte>(bytes).first(static_cast<std::size_t>(size)));
    }
    if (const std::size_t size = board.say(bytes); size > 0) {
      // A host that does not read loses bytes, as on a serial port.
      (void)!write(terminal.file(), bytes.data(), size);
    }
    clock.sleep_until_ns(clock.now_ns() + kStep_ns);
  }
  scene::print_format("Ended. Commands: %llu, not valid: %llu.\n",
                      static_cast<unsigned long long>(board.commands()),
                      static_cast<unsigned long long>(board.refused()));
  return kExitDone;
}

}  // namespace

void add_wire_serve_command(CLI::App& wire_command, int& exit_code) {
  CLI::App* command = wire_command.add_subcommand(
      "serve", "Put the simulated board of an arm behind a pseudo-terminal");
  auto arm = std::make_shared<std::string>();
  command->add_option("ARM", *arm, "Arm file with a described wire, or its name")->required();
  add_example(*command, "thimble wire serve my_arm");
  command->callback([arm, &exit_code] { exit_code = serve(*arm); });
}

}  // namespace thimble::cli
