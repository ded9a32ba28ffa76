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

/// Returns whether a product string names one of our arms. No published firmware sets one: boards
/// keep the strings of their makers' examples. A builder of firmware may set it (Teensyduino's
/// usb_names.h); no other proof is then needed. [chosen]
bool is_ours(std::string_view product) {
  return has_word(product, "woodenhaptics") || has_word(product, "polhem") ||
         has_word(product, "haptikfabriken");
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
