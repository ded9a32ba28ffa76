#include "bringup/board_advice.h"

#include <fmt/core.h>

#include "board_identity.h"

namespace thimble::bringup {
namespace {

using driver::BoardKind;
using driver::FoundArm;

/// Prevents a device's own string from ending the quotes around it.
std::string unquoted(const std::string& text) {
  std::string safe = text;
  for (char& sign : safe) {
    if (sign == '"' || sign == '\\' || sign == '\'') sign = '?';
  }
  return safe;
}

}  // namespace

std::string what_it_may_be(const FoundArm& board) {
  const std::string product =
      board.product.empty() ? "no product string" : "\"" + board.product + "\"";
  const std::string ids = fmt::format("{:04x}:{:04x}", board.vendor_id, board.product_id);
  if (board.board != BoardKind::kOther) {
    return "a board of unknown kind (" + ids + ", " + product +
           "): its firmware cannot be identified without writing to it. It is used only if "
           "--device names it.";
  }
  if (board.node.empty())
    return "its reports cannot be read because no kernel driver is bound to it.";
  return fmt::format(
      "a board of unknown kind ({}, {}): its reports of {} bytes in and {} bytes out match no "
      "known arm. It is never opened.",
      ids, product, static_cast<int>(board.hid.in_bytes), static_cast<int>(board.hid.out_bytes));
}

std::string how_to_use(const FoundArm& board) {
  if (board.board == BoardKind::kOther) return "If it is an arm, check its firmware.";
  const std::string kind(name(board.board));
  const bool described = board.board == BoardKind::kDescribed;
  std::string advice;
  if (!board.accessible) {
    advice = "If it is your arm: echo '" + udev_line(board) +
             "' | sudo tee -a /etc/udev/rules.d/71-my-arm.rules && sudo udevadm control --reload, "
             "plug it in again, and then ";
  } else {
    advice = "If it is your arm: ";
  }
  return advice + "thimble run SCENE --device " + board.name() +
         (described ? " --arm " + board.arm_file + ", the file that describes the board"
                    : " --arm FILE, with a file that contains `board: " + kind + "`");
}

std::string udev_line(const FoundArm& board) {
  const bool tty = board.board == BoardKind::kTextLines || board.bus == driver::kSerialBus;
  const bool by_serial = board.name() == board.serial;
  const std::string which = by_serial ? "ATTRS{serial}==\"" + unquoted(board.serial) + "\""
                                      : "KERNELS==\"" + board.sysfs.filename().string() + "\"";
  return fmt::format(
             "SUBSYSTEM==\"{}\", ATTRS{{idVendor}}==\"{:04x}\", ATTRS{{idProduct}}==\"{:04x}\", ",
             tty ? "tty" : "hidraw", board.vendor_id, board.product_id) +
         which + ", TAG+=\"uaccess\", GROUP=\"plugdev\", MODE=\"0660\"" +
         (tty ? ", ENV{ID_MM_DEVICE_IGNORE}=\"1\"" : "");
}

}  // namespace thimble::bringup
