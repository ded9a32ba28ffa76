#include "board_identity.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"
#include "transports/hid_descriptor.h"

namespace thimble::driver {
namespace {

/// Returns whether `text` contains `word`, ignoring case; `word` is in lower case.
bool has_word(std::string_view text, std::string_view word) {
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  return std::search(text.begin(), text.end(), word.begin(), word.end(), same) != text.end();
}

/// Returns whether two texts are equal, ignoring case.
bool is_same_word(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char c, char d) {
           return std::tolower(static_cast<unsigned char>(c)) ==
                  std::tolower(static_cast<unsigned char>(d));
         });
}

/// Returns whether a product string is that of one of our arms. The whole string is compared,
/// because the name of another device may contain a part of it. No published firmware sets one:
/// boards keep the strings of their makers' examples. A builder of firmware may set it
/// (Teensyduino's usb_names.h); no other proof is then needed. [chosen]
bool is_ours(std::string_view product) {
  return is_same_word(product, "woodenhaptics") || is_same_word(product, "polhem") ||
         is_same_word(product, "haptikfabriken");
}

/// Returns the name of an arm on Haptikfabriken's protocols from its product string.
const char* arm_named(std::string_view product) {
  if (has_word(product, "woodenhaptics")) return "WoodenHaptics";
  return has_word(product, "polhem") ? "Polhem" : "Haptikfabriken arm";
}

// mbed's USB library uses 1234:0006 for every HID program [S mbed USBHID.h]. The report descriptor
// distinguishes the arms' firmware [S woody-experimental mbed-code/WoodenHapticsHID/main.cpp,
// USBHID hid(8, 8); haptikfabrikenapi firmware/main.cpp, USBHID hid(14, 14)].
BoardIdentity identify_mbed(const UsbFacts& facts) {
  // The 8-byte firmware sends unasked and numbers its reports, so it is verified at opening.
  if (is_raw_hid(facts.hid, woody::kReportSize)) {
    return {BoardKind::kMbedHid8, Certainty::kProvesItself, "WoodenHaptics", kHidBus};
  }
  // The 14-byte firmware sends only after it was written to.
  if (is_raw_hid(facts.hid, hfab::kReportSize)) {
    const bool ours = is_ours(facts.product);
    return {BoardKind::kMbedHid14, ours ? Certainty::kKnown : Certainty::kUnknown,
            ours ? arm_named(facts.product) : "mbed HID, 14 bytes", kHidBus};
  }
  return {BoardKind::kOther, Certainty::kUnknown, "mbed HID", kHidBus};
}

// A Teensy's product id only shows the USB type that its program selected [S Teensyduino
// usb_desc.h].
std::optional<BoardIdentity> identify_teensy(const UsbFacts& facts) {
  constexpr std::uint16_t kSerialId = 0x0483, kRawHidId = 0x0486;
  // Haply's arm is a Teensy with this product string [S lerobot_teleoperator_inverse3].
  if (has_word(facts.product, "haply") || has_word(facts.product, "inverse3")) {
    return BoardIdentity{BoardKind::kOther, Certainty::kUnsupported, "Haply Inverse3", kSerialBus};
  }
  const bool ours = is_ours(facts.product);
  const Certainty certainty = ours ? Certainty::kKnown : Certainty::kUnknown;
  if (facts.has_tty || facts.product_id == kSerialId) {
    return BoardIdentity{BoardKind::kTextLines, certainty,
                         ours ? arm_named(facts.product) : "Teensy, serial", kSerialBus};
  }
  if (facts.product_id != kRawHidId) return std::nullopt;  // for example a keyboard
  if (is_raw_hid(facts.hid, hfab::kPaddedReportSize)) {
    return BoardIdentity{BoardKind::kTeensyRawHid64, certainty,
                         ours ? arm_named(facts.product) : "Teensy, raw HID", kHidBus};
  }
  return BoardIdentity{BoardKind::kOther, Certainty::kUnknown, "Teensy, raw HID", kHidBus};
}

constexpr std::uint16_t kMbedVendor = 0x1234, kMbedProduct = 0x0006;
constexpr std::uint16_t kTeensyVendor = 0x16c0, kTeensyFirst = 0x0480, kTeensyLast = 0x048f;

/// An id that only one maker's arm uses [S the arms' open drivers, their vendors' udev rules].
struct OwnId {
  std::uint16_t vendor_id, product_id;
  BoardIdentity identity;
};
constexpr OwnId kOwnIds[] = {
    {0x0403, 0xcb48, {BoardKind::kFalconFtdi, Certainty::kKnown, "Novint Falcon", "USB FTDI"}},
    {kTouchMaker, 0x0302, {BoardKind::kOther, Certainty::kUnsupported, "Touch", kSerialBus}},
    {kTouchMaker, 0x0304, {BoardKind::kOther, Certainty::kUnsupported, "Touch X", kHidBus}},
    {kForceDimension,
     0x0402,
     {BoardKind::kOther, Certainty::kUnsupported, "Force Dimension", "USB"}},
};

}  // namespace

bool is_common_product(std::string_view product) {
  // Words of boards as they are sold, of converters, and of the examples of USB libraries [S
  // Arduino boards.txt, Teensyduino usb_desc.h, mbed USBDevice.h, pico-sdk usb_descriptors.c,
  // STM32Cube usbd_desc.c, Espressif usb_descriptors.c, Linux cp210x.c and ftdi_sio_ids.h]. A
  // product string of such words alone names no arm.
  constexpr std::string_view kWords[] = {
      "acm",       "adapter", "bridge",     "board",     "cdc",       "com",         "comport",
      "composite", "cmsis",   "controller", "converter", "dap",       "daplink",     "debug",
      "demo",      "device",  "due",        "dual",      "espressif", "ev",          "example",
      "feather",   "fs",      "gadget",     "hid",       "hs",        "in",          "interface",
      "leonardo",  "link",    "mega",       "micro",     "mode",      "nano",        "native",
      "nucleo",    "of",      "pi",         "port",      "prog",      "programming", "quad",
      "raspberry", "raw",     "rawhid",     "s",         "seeed",     "st",          "test",
      "the",       "to",      "tool",       "uno",       "unit",      "v",           "virtual",
      "vcp",       "xiao",    "zephyr",     "zero"};
  constexpr std::string_view kParts[] = {"arduino", "teensy", "pico", "stm32", "stlink", "uart",
                                         "usb",     "serial", "jtag", "esp32", "rp20",   "samd",
                                         "sam3",    "atmega", "cp21", "ft2",   "ft4",    "ch34",
                                         "pl23",    "mbed",   "mcp22"};
  const auto is_common_word = [&](const std::string& word) {
    return word.find_first_not_of("0123456789") == std::string::npos ||
           std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords) ||
           std::any_of(std::begin(kParts), std::end(kParts), [&word](std::string_view part) {
             return word.find(part) != std::string::npos;
           });
  };
  std::string word;
  for (const char c : product) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    if (!is_common_word(word)) return false;
    word.clear();
  }
  return is_common_word(word);
}

bool matches(const DescribedBoard& board, const UsbFacts& facts) {
  const bool ids = board.vendor_id == facts.vendor_id && board.product_id == facts.product_id;
  const bool product = board.product.empty() || board.product == facts.product;
  const bool usage = board.usage_page == 0 ||
                     (board.usage_page == facts.hid.usage_page && board.usage == facts.hid.usage);
  const bool connected = board.bulk || (board.serial ? facts.has_tty : facts.has_hidraw);
  return ids && product && usage && connected;
}

Certainty certainty_of(const DescribedBoard& board) {
  const bool named = !board.product.empty() && !is_common_product(board.product);
  const bool raw_hid_example = board.usage_page == kRawHidPage && board.usage == kRawHidUsage;
  if (named || (board.usage_page != 0 && !raw_hid_example)) return Certainty::kKnown;
  return board.proves_itself ? Certainty::kProvesItself : Certainty::kUnknown;
}

std::optional<BoardIdentity> identify(const UsbFacts& facts) {
  for (const OwnId& own : kOwnIds) {
    if (own.vendor_id == facts.vendor_id && own.product_id == facts.product_id) {
      return own.identity;
    }
  }
  if (facts.vendor_id == kMbedVendor && facts.product_id == kMbedProduct) {
    return identify_mbed(facts);
  }
  if (facts.vendor_id == kTeensyVendor && kTeensyFirst <= facts.product_id &&
      facts.product_id <= kTeensyLast) {
    return identify_teensy(facts);
  }
  return std::nullopt;
}

}  // namespace thimble::driver
