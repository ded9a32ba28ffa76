#include "usb/virtual_arm.h"

#include <chrono>
#include <thread>

#include "arm_table.h"
#include "arms/falcon/falcon_arm.h"
#include "arms/falcon/falcon_boot.h"
#include "arms/falcon/falcon_packet.h"
#include "arms/hfab/hfab_models.h"
#include "arms/hfab/hfab_wire.h"
#include "arms/woody/woody_wire.h"
#include "thimble/driver/transports.h"
#include "thimble/scene/arm_file.h"
#include "transports/ftdi_line.h"

namespace thimble::usb_test {
namespace {

driver::Result<void> home(driver::SerialLine& line) {
  driver::falcon::HomingState state;
  for (int i = 0; i < 5000 && !state.done(); ++i) {
    state = driver::falcon::home_once(line, state.homed);
  }
  if (!state.done()) return driver::Error{"The Falcon did not find its home position."};
  return {};
}

}  // namespace

std::unique_ptr<const driver::Arm> VirtualArm::protocol() const {
  if (is_falcon()) {
    return std::make_unique<driver::falcon::FalconArm>(driver::falcon::falcon_model());
  }
  if (name == "woodenhaptics") {
    return std::make_unique<driver::woody::WoodyArm>(driver::hfab::woody_model());
  }
  if (is_short()) {
    const auto file = scene::load_arm("/data/app/arms/" + name + ".yaml");
    return file ? driver::make_arm(file->protocol, file->model) : nullptr;
  }
  return std::make_unique<driver::WireArm<driver::hfab::ReportWire, driver::LinkageArm>>(
      driver::hfab::polhem_model());
}

std::size_t VirtualArm::message_size() const {
  if (is_falcon()) return 0;
  return name == "woodenhaptics" ? 8 : board() == "polhem" ? 14 : 64;
}

std::string VirtualArm::serial() const {
  return is_falcon() ? "SIM0001" : name == "polhem-64" ? "1234560" : "0123456789";
}

// Only one board is plugged in at a time, so the product id identifies it.
driver::Result<driver::FoundArm> VirtualArm::find(const std::string& serial, int timeout_ms) const {
  const std::uint16_t product = is_falcon() ? 0xcb48 : name == "polhem-64" ? 0x0486 : 0x0006;
  for (int waited_ms = 0; waited_ms < timeout_ms; waited_ms += 10) {
    const auto arms = driver::find_arms();
    if (!arms) return arms.error();
    for (const driver::FoundArm& arm : *arms) {
      const bool wanted = arm.product_id == product && (serial.empty() || arm.serial == serial);
      if (wanted && !arm.node.empty()) return arm;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return driver::Error{"The arm '" + name + "' was not listed in " + std::to_string(timeout_ms) +
                       " ms."};
}

driver::Result<std::unique_ptr<driver::Transport>> VirtualArm::open(
    const driver::FoundArm& found, const driver::Clock& clock) const {
  if (!is_falcon()) {
    return driver::open_hid_transport(found.node, message_size(), clock);
  }
  auto line = driver::FtdiLine::open(found.usb);
  if (!line) return line.error();
  if (const auto prepared = driver::falcon::prepare(**line, firmware); !prepared) {
    return prepared.error();
  }
  if (const auto homed = home(**line); !homed) return homed.error();
  return (*line)->into_transport(driver::falcon::kPacketFraming, clock);
}

driver::DeviceSettings check_settings() {
  driver::DeviceSettings settings;
  settings.limits = {.force_max = 3,
                     .speed_max = 3,
                     .rise_max = 2000,
                     .soft_start = 0.05,
                     .stall_ns = 20'000'000,
                     .watchdog_ns = 100'000'000};
  settings.velocity_corner_frequency = 100;
  return settings;
}

}  // namespace thimble::usb_test
