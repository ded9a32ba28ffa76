#pragma once

#include <memory>

#include "device_model.h"
#include "firmware/core/controller.h"
#include "firmware/usb/hid_device.h"

namespace thimble::firmware_test {

/// The USB driver of a board over the model of its controller.
class UsbChip {
 public:
  UsbChip() = default;
  UsbChip(const UsbChip&) = delete;
  UsbChip& operator=(const UsbChip&) = delete;
  virtual ~UsbChip() = default;

  virtual void start(firmware::HidDevice& device) = 0;
  virtual void poll(firmware::HidDevice& device) = 0;
  virtual bool receive(std::uint8_t* report) = 0;
  virtual void send(const std::uint8_t* report, std::uint16_t size) = 0;
  virtual DeviceModel& model() = 0;
};

/// The boards whose USB drivers are tested.
std::unique_ptr<UsbChip> rp2040_usb();
std::unique_ptr<UsbChip> stm32f405_usb();
std::unique_ptr<UsbChip> teensy4_usb();
/// The Teensy on a bus of full speed.
std::unique_ptr<UsbChip> teensy4_full_speed_usb();

/// State of the board that the functions of core/board.h and usb_port.h use in the tests.
struct UsbBoard {
  UsbChip* chip = nullptr;
  std::uint32_t now_us = 0;
  firmware::Inputs inputs;
  firmware::Outputs outputs;
};
extern UsbBoard usb_board;

}  // namespace thimble::firmware_test
