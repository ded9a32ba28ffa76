#include "usb_board.h"

#include <array>

#include "firmware/boards/rp2040/rp_usb.h"
#include "firmware/boards/stm32f405/otg_fs.h"
#include "firmware/boards/teensy4/imx_usb.h"
#include "firmware/core/board.h"
#include "firmware/usb/usb_port.h"
#include "imx_usb_model.h"
#include "otg_fs_model.h"
#include "rp_usb_model.h"

namespace thimble::firmware_test {

UsbBoard usb_board;

namespace {

/// Access of a driver to a model.
template <class Model>
struct ModelAccess {
  static inline Model* model = nullptr;
  static std::uint32_t read(std::uintptr_t address) noexcept { return model->read(address); }
  static void write(std::uintptr_t address, std::uint32_t value) noexcept {
    model->write(address, value);
  }
  static std::uint32_t bus_address(const volatile void* object) noexcept {
    return model->bus_address(object);
  }
  static void complete_writes() noexcept { model->complete_writes(); }
  static void wait_cycles() noexcept { model->wait_cycles(); }
};

template <class Model, template <class> class Driver>
class ModelledChip : public UsbChip {
 public:
  template <class... Arguments>
  explicit ModelledChip(Arguments... arguments) : model_(arguments...) {
    ModelAccess<Model>::model = &model_;
  }
  void start(firmware::HidDevice& device) override { driver().start(device); }
  void poll(firmware::HidDevice& device) override { driver().poll(device); }
  bool receive(std::uint8_t* report) override { return driver().receive(report); }
  void send(const std::uint8_t* report, std::uint16_t size) override {
    driver().send(report, size);
  }
  Model& model() override { return model_; }

 protected:
  virtual Driver<ModelAccess<Model>>& driver() = 0;

 private:
  Model model_;
};

class Stm32f405 final : public ModelledChip<OtgFsModel, firmware::OtgFs> {
  firmware::OtgFs<ModelAccess<OtgFsModel>>& driver() override { return driver_; }
  firmware::OtgFs<ModelAccess<OtgFsModel>> driver_;
};

class Rp2040 final : public ModelledChip<RpUsbModel, firmware::RpUsb> {
  firmware::RpUsb<ModelAccess<RpUsbModel>>& driver() override { return driver_; }
  firmware::RpUsb<ModelAccess<RpUsbModel>> driver_;
};

/// Memory of the Teensy's driver, at a page as its controller requires.
using ImxDriver = firmware::ImxUsb<ModelAccess<ImxUsbModel>>;
struct alignas(4096) ImxMemory {
  ImxDriver driver;
};

class Teensy4 final : public ModelledChip<ImxUsbModel, firmware::ImxUsb> {
 public:
  explicit Teensy4(std::unique_ptr<ImxMemory> memory)
      : ModelledChip(std::span(reinterpret_cast<std::uint8_t*>(memory.get()), sizeof(ImxMemory))),
        memory_(std::move(memory)) {}

 private:
  ImxDriver& driver() override { return memory_->driver; }
  std::unique_ptr<ImxMemory> memory_;
};

}  // namespace

std::unique_ptr<UsbChip> rp2040_usb() {
  return std::make_unique<Rp2040>();
}

std::unique_ptr<UsbChip> stm32f405_usb() {
  return std::make_unique<Stm32f405>();
}

std::unique_ptr<UsbChip> teensy4_usb() {
  return std::make_unique<Teensy4>(std::make_unique<ImxMemory>());
}

std::unique_ptr<UsbChip> teensy4_full_speed_usb() {
  auto chip = std::make_unique<Teensy4>(std::make_unique<ImxMemory>());
  chip->model().connect_to_full_speed();
  return chip;
}

}  // namespace thimble::firmware_test

namespace thimble::firmware {

using firmware_test::usb_board;

namespace usb_port {

void start(HidDevice& device) noexcept {
  usb_board.chip->start(device);
}

void poll(HidDevice& device) noexcept {
  usb_board.chip->poll(device);
}

bool receive(uint8_t* report) noexcept {
  return usb_board.chip->receive(report);
}

void send(const uint8_t* report, uint16_t size) noexcept {
  usb_board.chip->send(report, size);
}

}  // namespace usb_port

namespace board {

bool restarted() noexcept {
  return false;
}

uint32_t now_us() noexcept {
  return usb_board.now_us;
}

void sample(Inputs& inputs) noexcept {
  inputs = usb_board.inputs;
}

void apply(const Outputs& outputs) noexcept {
  usb_board.outputs = outputs;
}

void lamp(bool) noexcept {}

void feed_watchdog() noexcept {}

}  // namespace board
}  // namespace thimble::firmware
