#include "thimble/scene/real_arm.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "arm/wire_mention.h"
#include "arm_table.h"
#include "arms/falcon/falcon_boot.h"
#include "arms/hfab/hfab_report.h"
#include "arms/hfab/hfab_wire.h"
#include "arms/woody/woody_proof.h"
#include "arms/woody/woody_report.h"
#include "board_identity.h"
#include "log/logger.h"
#include "signals.h"
#include "thimble/driver/transports.h"
#include "thimble/driver/wire_link.h"
#include "thimble/scene/shipped_files.h"
#include "transports/ftdi_line.h"
#include "vendors/dhd/dhd_link.h"
#include "vendors/haply/haply_link.h"
#include "vendors/hd/hd_link.h"
#include "wires/described_link.h"

namespace thimble::scene {
namespace {

namespace falcon = driver::falcon;
namespace hfab = driver::hfab;
using driver::ArmKind;
using driver::BoardKind;
using driver::Certainty;
using driver::Error;
using driver::FoundArm;
using driver::Result;

/// Requests a report of a board on USB serial, with zero currents, and checks its model number.
Result<void> check_board(driver::Transport& wire, const ArmFile& file, const FoundArm& arm,
                         driver::Clock& clock) {
  constexpr int kAttempts = 20;
  constexpr std::int64_t kWait_ns =
      100'000'000;  // period of the requests of the published library [S]
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::array<std::byte, hfab::kLineCapacity> message{};
    const std::size_t size = hfab::encode_host_line({}, message);
    wire.write(std::span<const std::byte>(message).first(size));
    std::array<std::byte, driver::kReportCapacity> buffer{};
    const auto read = wire.read_latest(buffer, clock.now_ns() + kWait_ns);
    if (read.status == driver::TransportStatus::kLost) break;
    const auto line = hfab::decode_arm_line(std::span<const std::byte>(buffer).first(read.size));
    if (!line) continue;
    if (file.board_model == 0 || line->model == file.board_model) return {};
    return Error{arm.node + " reports model " + std::to_string(line->model) +
                 ", but the arm file " + file.name + " is for model " +
                 std::to_string(file.board_model) + ". Choose the right file with --arm."};
  }
  return Error{
      arm.node +
      " does not answer as a Haptikfabriken arm. Check its power. If it is another Teensy, "
      "choose your arm by name (thimble devices)."};
}

Result<void> home(driver::SerialLine& line) {
  constexpr int kRequestsMax =
      60'000;  // a minute at one request per millisecond; a slow hand may take longer
  std::uint8_t homed = 0;
  bool prompted = false;
  int silent = 0;
  for (int i = 0; i < kRequestsMax; ++i) {
    if (stop_asked()) return Error{"Stopped before the Falcon was homed; it got no force."};
    const falcon::HomingState state = falcon::home_once(line, homed);
    silent = state.answered ? 0 : silent + 1;
    if (silent > 20)
      return Error{"The Falcon stopped answering during homing. Check its power and cable."};
    if (state.done()) return {};
    homed = state.homed;
    if (!prompted && state.answered) {
      terminal().info("Pull the Falcon's grip all the way out, then push it in.");
      prompted = true;
    }
  }
  return Error{"The Falcon was not homed. Pull its grip all the way out, push it in, and retry."};
}

Result<std::unique_ptr<driver::Transport>> open_falcon(const FoundArm& arm,
                                                       const std::filesystem::path& firmware,
                                                       driver::Clock& clock) {
  auto line = driver::FtdiLine::open(arm.usb);
  if (!line) return line.error();
  if (auto prepared = falcon::prepare(**line, firmware); !prepared) return prepared.error();
  if (auto homed = home(**line); !homed) return homed.error();
  return (*line)->into_transport(falcon::kPacketFraming, clock);
}

/// Returns why a board is never opened.
Error cannot_drive(const FoundArm& arm) {
  if (arm.certainty == Certainty::kUnsupported) {
    return Error{"The protocol of the " + arm.arm + " (" + arm.name() +
                 ") is not public, so Thimble does not open it."};
  }
  return Error{
      "The board " + arm.name() + " (" + arm.arm +
      ") has a report format that no known arm uses, or no driver, so Thimble does not open it. "
      "See `thimble doctor`."};
}

/// Opens the connection to an arm and initialises the arm. Precondition: `check_fits`.
Result<std::unique_ptr<driver::Transport>> open_wire(const FoundArm& arm, const ArmFile& file,
                                                     const std::filesystem::path& firmware,
                                                     driver::Clock& clock) {
  switch (arm.board) {
    case BoardKind::kMbedHid8: {
      auto wire = driver::open_hid_transport(arm.node, driver::woody::kReportSize, clock);
      if (!wire) return wire;
      if (auto right = driver::woody::listen_for_board(**wire, clock); !right) {
        return Error{arm.node + ": " + right.error().message};
      }
      return wire;
    }
    case BoardKind::kMbedHid14:
      return driver::open_hid_transport(arm.node, hfab::kReportSize, clock);
    case BoardKind::kTeensyRawHid64:
      return driver::open_hid_transport(arm.node, hfab::kPaddedReportSize, clock);
    case BoardKind::kTextLines: {
      auto wire = driver::open_serial_transport(arm.node, hfab::kLineFraming, clock);
      if (!wire) return wire;
      if (auto right = check_board(**wire, file, arm, clock); !right) return right.error();
      return wire;
    }
    case BoardKind::kFalconFtdi:
      return open_falcon(arm, firmware, clock);
    case BoardKind::kHaplyService:
    case BoardKind::kDhdLibrary:
    case BoardKind::kHdLibrary:
    case BoardKind::kDescribed:
    case BoardKind::kOther:
      break;
  }
  return cannot_drive(arm);
}

/// Returns the board that the wire of an arm file describes.
driver::DescribedBoard board_of(const ArmFile& file, const std::string& arm_file) {
  const driver::WireTable& wire = *file.wire;
  const driver::WireIdentity& identity = wire.text.identity;
  return {.arm = file.name,
          .arm_file = arm_file,
          .vendor_id = identity.vendor_id,
          .product_id = identity.product_id,
          .product = identity.product,
          .usage_page = identity.usage_page,
          .usage = identity.usage,
          .serial = wire.text.transport == driver::WireTransport::kSerial,
          .bulk = wire.text.transport == driver::WireTransport::kBulk,
          .proves_itself = wire.text.streams && (wire.numbered || wire.report.check_bytes > 0)};
}

/// Returns the boards that the installed arm files describe.
std::vector<driver::DescribedBoard> described_boards() {
  std::vector<driver::DescribedBoard> boards;
  for (const ShippedFile& installed : installed_arms()) {
    // Most arm files describe no wire; they are not read each time.
    if (!names_described_wire(installed.path)) continue;
    const auto file = load_arm(installed.path);
    if (!file) {
      terminal().warn("The board of this arm file is not recognised: {}", file.error().message);
      continue;
    }
    if (file->wire) boards.push_back(board_of(*file, installed.name));
  }
  return boards;
}

/// Fails if a board has not the USB properties that the wire of an arm file describes.
Result<void> check_described(const ArmFile& file, const FoundArm& arm) {
  const driver::DescribedBoard board = board_of(file, "");
  const driver::UsbFacts facts{.vendor_id = arm.vendor_id,
                               .product_id = arm.product_id,
                               .product = arm.product,
                               .has_hidraw = arm.hid.in_bytes > 0 || arm.bus == driver::kHidBus,
                               .hid = arm.hid,
                               .has_tty = arm.bus == driver::kSerialBus};
  if (driver::matches(board, facts)) return {};
  return Error{fmt::format(
      "The arm file {} describes a board {:04x}:{:04x}{} on {}, but {} is {:04x}:{:04x} \"{}\" on "
      "{}. Choose the right file with --arm FILE, or correct the section wire, usb.",
      file.name, board.vendor_id, board.product_id,
      board.product.empty() ? "" : " \"" + board.product + '"',
      board.bulk     ? driver::kBulkBus
      : board.serial ? driver::kSerialBus
                     : driver::kHidBus,
      arm.name(), arm.vendor_id, arm.product_id, arm.product, arm.bus)};
}

}  // namespace

Result<std::optional<FoundArm>> choose_arm(const std::vector<FoundArm>& plugged_in,
                                           const std::string& wanted) {
  if (wanted == "sim") return std::optional<FoundArm>();
  const bool by_itself = wanted == "auto";
  std::optional<FoundArm> found;
  std::string names;
  bool several = false;
  for (const FoundArm& arm : plugged_in) {
    if (arm.kind == ArmKind::kUnsupported) {
      if (arm.name() == wanted) return cannot_drive(arm);
      continue;
    }
    if (by_itself && arm.certainty == Certainty::kUnknown) continue;
    names.append(names.empty() ? "" : ", ").append(arm.name() + " (" + arm.arm + ")");
    if (!by_itself && arm.name() != wanted) continue;
    several = several || found;
    found = arm;
  }
  if (several) {
    return Error{
        fmt::format("'{}' fits several arms: {}. Name one with --device NAME.", wanted, names)};
  }
  if (!found && !by_itself) {
    return Error{"No arm is called '" + wanted + "'. " +
                 (names.empty() ? "No arm that Thimble can drive is plugged in."
                                : "Plugged in: " + names + ".") +
                 " See `thimble devices`."};
  }
  if (found && !found->accessible) {
    if (found->certainty == Certainty::kUnknown || found->kind == ArmKind::kDescribed) {
      return Error{"No access to " + found->name() + " (" + found->arm +
                   "): the installed udev rule covers known arms only. `thimble doctor` prints the "
                   "line to add for this board."};
    }
    if (found->kind == ArmKind::kHd || found->kind == ArmKind::kDhd) {
      return Error{"No access to " + found->arm + " " + found->name() + " (" + found->node +
                   "), which the library of its vendor needs: `thimble doctor` prints what to do."};
    }
    return Error{"No access to " + found->arm + " " + found->name() +
                 ": install udev/70-thimble.rules and plug it in again (see `thimble doctor`)."};
  }
  return found;
}

std::string boards_left_out(const std::vector<FoundArm>& plugged_in) {
  std::string boards, thimble_services;
  for (const FoundArm& arm : plugged_in) {
    if (arm.certainty != Certainty::kUnknown) continue;
    if (arm.board == BoardKind::kHaplyService) {
      thimble_services.append(thimble_services.empty() ? "" : ", ").append(arm.name());
      continue;
    }
    boards.append(boards.empty() ? "" : ", ").append(arm.name()).append(": ").append(arm.arm);
  }
  std::string sentences;
  if (!thimble_services.empty()) {
    sentences =
        "Ignored, because `thimble exec --serve haply` answers there and not an Inverse3: " +
        thimble_services + ". Use it with --device NAME.";
  }
  if (boards.empty()) return sentences;
  return sentences + (sentences.empty() ? "" : " ") +
         "Ignored, because their kind is unknown: " + boards +
         ". If one is your arm, use it with --device NAME and an arm file that names its board "
         "(`thimble doctor` prints it).";
}

std::optional<FoundArm> find_again(const std::vector<FoundArm>& plugged_in, const FoundArm& lost) {
  for (const FoundArm& arm : plugged_in) {
    // Another board with the same ids, or the same board with other firmware, is not the same arm.
    const bool same_kind = arm.vendor_id == lost.vendor_id && arm.product_id == lost.product_id &&
                           arm.board == lost.board && arm.product == lost.product &&
                           arm.serial == lost.serial;
    if (same_kind && arm.name() == lost.name() && arm.accessible) return arm;
  }
  return std::nullopt;
}

driver::Result<std::vector<FoundArm>> find_arms(const std::filesystem::path& root) {
  return driver::find_arms(root, described_boards());
}

Result<void> check_fits(const ArmFile& file, const FoundArm& arm) {
  if (file.wire) return check_described(file, arm);
  if (arm.kind == ArmKind::kUnsupported) return cannot_drive(arm);
  if (std::find(file.boards.begin(), file.boards.end(), arm.board) != file.boards.end()) return {};
  std::string boards;
  for (const driver::BoardKind board : file.boards) {
    boards.append(boards.empty() ? "" : ", ").append(name(board));
  }
  const std::string board(name(arm.board));
  return Error{
      "The arm file " + file.name + " is for the board " + boards + ", but " + arm.name() + " (" +
      arm.arm + ") is a " + board +
      ". Choose the right file with --arm FILE (see app/arms); signs and currents of one board "
      "are dangerous on another."};
}

Result<std::unique_ptr<driver::ArmLink>> open_link(const FoundArm& arm, const ArmFile& file,
                                                   const std::filesystem::path& firmware,
                                                   driver::Clock& clock) {
  if (auto fits = check_fits(file, arm); !fits) return fits.error();
  if (arm.board == BoardKind::kHaplyService) {
    return driver::haply::open_link(arm.serial, driver::haply::port_of_user(), clock);
  }
  if (arm.board == BoardKind::kDhdLibrary) {
    const auto library = driver::dhd::library();
    if (!library) return library.error();
    return driver::dhd::open_link(*library, clock);
  }
  if (arm.board == BoardKind::kHdLibrary) {
    const auto library = driver::hd::library();
    if (!library) return library.error();
    return driver::hd::open_link(*library, clock);
  }
  auto wire = file.wire ? driver::open_described(arm.node, *file.wire, clock, arm.usb)
                        : open_wire(arm, file, firmware, clock);
  if (!wire) return wire.error();
  return std::unique_ptr<driver::ArmLink>(std::make_unique<driver::WireLink>(
      std::move(wire).value(),
      make_arm(file.wire ? ArmKind::kDescribed : arm.kind, file.model, file.wire.get())));
}

}  // namespace thimble::scene
