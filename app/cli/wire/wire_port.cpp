#include "cli/wire/wire_port.h"

#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "bringup/wire_timing.h"
#include "cli/arm_choice.h"
#include "cli/report_error.h"
#include "log/printed_text.h"
#include "signals.h"
#include "thimble/driver/clock.h"
#include "thimble/scene/real_arm.h"
#include "wires/described_link.h"

namespace thimble::cli {
namespace {

using bringup::WireTiming;
using driver::FoundArm;
using driver::Result;
using driver::Transport;

constexpr double kSeconds = 3;  // [chosen: 3000 reports at 1 kHz, so that 30 are above 99 %]

bool is_port(const std::string& device) {
  return device.starts_with('/');
}

/// Returns the listed board at a port, or with a name; without one, only the port.
Result<FoundArm> find_board(const std::string& device) {
  const auto plugged_in = scene::find_arms();
  const auto boards = plugged_in ? *plugged_in : std::vector<FoundArm>();
  if (!is_port(device)) {
    const auto chosen = scene::choose_arm(boards, device);
    if (!chosen) return chosen.error();
    if (!*chosen) return driver::Error{"--device: " + device + " is no board."};
    return **chosen;
  }
  for (const FoundArm& board : boards) {
    std::error_code ignored;
    if (!board.node.empty() && std::filesystem::equivalent(board.node, device, ignored)) {
      return board;
    }
  }
  FoundArm port;
  port.node = device;
  return port;
}

/// Opens a board that streams. Nothing is sent to it, so its identity need not be proven.
Result<std::unique_ptr<Transport>> open_stream(const driver::WireTable& wire,
                                               const std::string& device,
                                               const driver::Clock& clock) {
  const auto board = find_board(device);
  if (!board) return board.error();
  if (board->usb.bus == 0 && wire.text.transport == driver::WireTransport::kBulk) {
    return driver::Error{"--device: " + device +
                         " is not listed by `thimble devices`. A board on USB bulk transfers must "
                         "be; check its ids."};
  }
  return driver::open_to_listen(board->node, wire, clock, board->usb);
}

/// Opens a board that answers commands, if its identity is proven.
Result<std::unique_ptr<Transport>> open_asked(const std::string& file, const std::string& device,
                                              const driver::Clock& clock) {
  const auto board = find_board(device);
  if (!board) return board.error();
  if (board->kind == driver::ArmKind::kUnsupported) {
    return driver::Error{
        "--device: " + device +
        " has no USB properties of an arm, and a board that answers commands is only asked if its "
        "identity is proven. Nothing was sent. Name a board of `thimble devices`."};
  }
  ArmChoice choice;
  choice.device = board->name();
  choice.arm_file = file;
  choice.falls_back_to_simulation = false;
  const auto chosen = resolve(choice, true);
  if (!chosen) return chosen.error();
  if (!chosen->real_arm || !chosen->file.wire) {
    return driver::Error{"--device: " + device + " is no board with a described wire."};
  }
  if (auto fits = scene::check_fits(chosen->file, *chosen->real_arm); !fits) return fits.error();
  return driver::open_described(chosen->real_arm->node, *chosen->file.wire, clock,
                                chosen->real_arm->usb);
}

void print(const WireTiming& timing, bool streams) {
  if (timing.reports > 0) {
    scene::print_format("%s: %zu reports in %.2f s, %.1f per second\n",
                        streams ? "port" : "port, zero force", timing.reports, timing.duration,
                        timing.rate);
    scene::print_format("%s: mean %.3f ms, 99 %% %.3f ms, longest %.3f ms\n",
                        streams ? "interval" : "answer", 1e3 * timing.mean, 1e3 * timing.p99,
                        1e3 * timing.max);
  }
  if (timing.lost) {
    scene::print_format("numbers: %zu lost, %zu repeated\n", *timing.lost, *timing.repeated);
  } else {
    scene::print_format("numbers: none, so lost reports are not detected\n");
  }
  scene::print_format("damaged: %zu messages%s\n", timing.damaged,
                      timing.flaw
                          ? ""
                          : fmt::format(", the last one by {} at byte {}",
                                        driver::describe(timing.flaw.flaw), timing.flaw.byte)
                                .c_str());
  if (timing.unusable > 0) {
    scene::print_format("error flags: %zu reports are not used\n", timing.unusable);
  }
  if (!streams) scene::print_format("without an answer: %zu commands\n", timing.unanswered);
}

nlohmann::ordered_json json_of(const WireTiming& timing, bool streams) {
  nlohmann::ordered_json json{{"exchange", streams ? "stream" : "ask"},
                              {"reports", timing.reports},
                              {"damaged", timing.damaged},
                              {"unusable", timing.unusable},
                              {"lost", nullptr},
                              {"repeated", nullptr},
                              {"unanswered", timing.unanswered},
                              {"duration_s", timing.duration},
                              {"rate_Hz", timing.rate},
                              {"mean_s", timing.mean},
                              {"p99_s", timing.p99},
                              {"max_s", timing.max}};
  if (timing.lost) json["lost"] = *timing.lost;
  if (timing.repeated) json["repeated"] = *timing.repeated;
  return json;
}

}  // namespace

int time_port(const std::string& file, const driver::WireTable& wire, const std::string& device,
              nlohmann::ordered_json& result) {
  const std::atomic<bool>& stop = scene::catch_interrupts();
  const bool streams = wire.text.streams;
  driver::WallClock clock;
  auto port = streams ? open_stream(wire, device, clock) : open_asked(file, device, clock);
  if (!port) return report_error(port.error(), kExitNoDevice);
  const WireTiming timing = streams ? bringup::time_stream(**port, wire, clock, kSeconds, stop)
                                    : bringup::time_answers(**port, wire, clock, kSeconds, stop);
  print(timing, streams);
  result["port"] = json_of(timing, streams);
  if (timing.disconnected) {
    return report_error({device + " was disconnected. Check its cable and power."}, kExitNoDevice);
  }
  if (timing.reports > 0) return kExitDone;
  if (stop.load()) return kExitInterrupted;
  return report_error(
      {timing.damaged > 0
           ? device + ": no message is a report of the arm file. Compare its bytes with "
                      "the picture by --capture."
       : streams
           ? device + ": no bytes of a report arrived. Check power and baud; a board that sends "
                      "only after a start-up message is silent here."
           : device + ": the board answered none of the commands. Check power and firmware."},
      kExitUnmet);
}

}  // namespace thimble::cli
