#include "view/input/space_mouse.h"

#include <hidapi.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace thimble::view {
namespace {

/// USB ids of one device.
struct Ids {
  unsigned vendor, product;
};

// [S] Open CASCADE (WNT_HIDSpaceMouse: SpacePid) and spacenavd (dev.c), which agree. Devices from
// before 2013 have Logitech's vendor id, whose keyboards and mice have other product ids.
constexpr std::array kDevices = {
    Ids{0x046d, 0xc626},  // SpaceNavigator
    Ids{0x046d, 0xc627},  // SpaceExplorer
    Ids{0x046d, 0xc628},  // SpaceNavigator for notebooks
    Ids{0x046d, 0xc625},  // SpacePilot
    Ids{0x046d, 0xc629},  // SpacePilot Pro
    Ids{0x046d, 0xc62b},  // SpaceMouse Pro
    Ids{0x256f, 0xc62e},  // SpaceMouse Wireless, by its cable
    Ids{0x256f, 0xc62f},  // SpaceMouse Wireless, by its receiver
    Ids{0x256f, 0xc631},  // SpaceMouse Pro Wireless, by its cable
    Ids{0x256f, 0xc632},  // SpaceMouse Pro Wireless, by its receiver
    Ids{0x256f, 0xc633},  // SpaceMouse Enterprise
    Ids{0x256f, 0xc635},  // SpaceMouse Compact
    Ids{0x256f, 0xc63a},  // SpaceMouse Wireless, Bluetooth
    Ids{0x256f, 0xc652},  // Universal Receiver
};

// [S] HID Usage Tables 1.4, Generic Desktop Page (0x01): Multi-axis Controller.
constexpr unsigned kDesktopPage = 1, kMultiAxis = 8;

constexpr std::chrono::seconds kBetweenLooks{1};
constexpr std::size_t kReportMax = 64;  // bytes: a full-speed interrupt packet [S USB 2.0, 5.7.3]
constexpr int kReportsMax = 256;  // per call; chosen: 4 s of a device that reports every 16 ms

}  // namespace

bool is_space_mouse(unsigned vendor, unsigned product, unsigned usage_page,
                    unsigned usage) noexcept {
  if (usage_page != 0 && (usage_page != kDesktopPage || usage != kMultiAxis)) return false;
  return std::any_of(kDevices.begin(), kDevices.end(), [&](const Ids& ids) {
    return ids.vendor == vendor && ids.product == product;
  });
}

SpaceMouse::~SpaceMouse() {
  close();
}

void SpaceMouse::close() {
  if (device_ != nullptr) hid_close(device_);
  device_ = nullptr;
  state_ = {};
}

void SpaceMouse::look() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_look_) return;
  next_look_ = now + kBetweenLooks;
  trouble_ = "No SpaceMouse. Plug one in; it is detected automatically.";
  const std::unique_ptr<hid_device_info, void (*)(hid_device_info*)> all(hid_enumerate(0, 0),
                                                                         hid_free_enumeration);
  for (const hid_device_info* found = all.get(); found != nullptr; found = found->next) {
    if (!is_space_mouse(found->vendor_id, found->product_id, found->usage_page, found->usage)) {
      continue;
    }
    device_ = hid_open_path(found->path);
    if (device_ != nullptr) {
      trouble_.clear();
      return;
    }
    trouble_ = std::string("The SpaceMouse at ") + found->path +
               " is not readable. Install udev/70-thimble.rules, then unplug it and plug it "
               "in again.";
  }
}

std::optional<SpaceMouseState> SpaceMouse::read() {
  if (device_ == nullptr) look();
  if (device_ == nullptr) return {};
  std::array<unsigned char, kReportMax> report{};
  for (int i = 0; i < kReportsMax; ++i) {
    const int size = hid_read_timeout(device_, report.data(), report.size(), 0);
    if (size < 0) {
      close();
      trouble_ = "The SpaceMouse was disconnected. Plug it in again.";
      return {};
    }
    if (size == 0) break;
    take_space_mouse_report(std::as_bytes(std::span(report).first(static_cast<std::size_t>(size))),
                            state_);
  }
  return state_;
}

}  // namespace thimble::view
