// The firmware of driver/firmware for Hapkit boards, in simavr's ATmega328P. The processor's cycles
// are those of the chip. The image is built with this test; without the tools, it is skipped.
#include <gtest/gtest.h>

extern "C" {
#include <simavr/avr_adc.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
}

#include <cstdio>
#include <filesystem>
#include <vector>

#include "firmware/core/bytes.h"
#include "firmware/core/cobs.h"
#include "firmware/core/packet.h"
#include "host_wire.h"
#include "program_flags.h"

namespace thimble::firmware_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Registers that switch the motor: PWM output connected, and its level (DS40002061B, section 36).
constexpr std::size_t kTimer0CtrlA = 0x44, kTimer0CompareB = 0x48;
constexpr std::uint64_t kCyclesPerSecond = 16'000'000;

Bytes drive_one(float amperes) {
  Bytes bytes(16);
  bytes[0] = firmware::kDrive;
  bytes[1] = firmware::kWireVersion;
  firmware::put(bytes.data() + 4, amperes);
  return closed(bytes);
}

class AvrFirmware : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(THIMBLE_AVR_IMAGE)) {
      GTEST_SKIP() << "The firmware was not compiled. Install the part `firmware` "
                      "(app/optional_parts.list).";
    }
    avr_ = avr_make_mcu_by_name("atmega328p");
    ASSERT_NE(avr_, nullptr);
    avr_init(avr_);
    avr_->log = LOG_ERROR;
    elf_firmware_t image{};
    ASSERT_EQ(elf_read_firmware(THIMBLE_AVR_IMAGE, &image), 0);
    avr_load_firmware(avr_, &image);
    avr_->frequency = kCyclesPerSecond;
    avr_->vcc = avr_->avcc = avr_->aref = 5000;
    std::uint32_t flags = 0;
    avr_ioctl(avr_, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
    flags &= ~static_cast<std::uint32_t>(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POLL_SLEEP);
    avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(
        avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
        [](avr_irq_t*, std::uint32_t byte, void* self) {
          static_cast<AvrFirmware*>(self)->take(static_cast<std::uint8_t>(byte));
        },
        this);
    input_ = avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
    sensor_ = avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC2);
    set_sensor(500);
  }
  void TearDown() override {
    if (avr_ != nullptr) avr_terminate(avr_);
  }

  /// Sets the voltage of the sensor, in steps of the converter.
  void set_sensor(int steps) {
    avr_raise_irq(sensor_, static_cast<std::uint32_t>(steps * 5000 / 1023 + 1));
  }
  /// Runs for a time, with the bytes of `frame` at the rate of the line.
  void run(double seconds, const Bytes& message = {}) {
    std::array<std::uint8_t, firmware::kFrameMax> frame{};
    const std::size_t size =
        message.empty() ? 0 : firmware::encode_frame(message.data(), message.size(), frame.data());
    std::size_t sent = 0;
    const std::uint64_t begin = avr_->cycle;
    const auto end = begin + static_cast<std::uint64_t>(seconds * kCyclesPerSecond);
    while (avr_->cycle < end) {
      constexpr std::uint64_t kCyclesPerByte = 160;
      if (sent < size && avr_->cycle >= begin + kCyclesPerByte * (sent + 1)) {
        avr_raise_irq(input_, frame[sent++]);
      }
      const int state = avr_run(avr_);
      ASSERT_TRUE(state == cpu_Running || state == cpu_Sleeping);
    }
  }
  /// Drives for a number of ticks.
  void drive_for(int ticks, float amperes) {
    for (int i = 0; i < ticks; ++i) run(1e-3, drive_one(amperes));
  }
  /// Returns the level of the motor's output, 0 to 255.
  int level() const {
    return (avr_->data[kTimer0CtrlA] & 1 << 5) != 0 ? avr_->data[kTimer0CompareB] : 0;
  }
  std::uint16_t word(std::size_t at) const { return firmware::get<std::uint16_t>(&state_[at]); }

  avr_t* avr_ = nullptr;
  avr_irq_t *input_ = nullptr, *sensor_ = nullptr;
  Bytes state_ = Bytes(firmware::kStateSize), description_;
  int states_ = 0, lost_ = 0, damaged_ = 0;
  std::uint16_t loop_max_us_ = 0;

 private:
  void take(std::uint8_t byte) {
    const std::size_t size = reader_.take(byte);
    if (size == 0) return;
    const Bytes content(reader_.content(), reader_.content() + size);
    const Bytes sound = closed({content.begin(), content.end() - 2});
    if (sound != content) {
      ++damaged_;
      return;
    }
    if (size == firmware::kDescriptionSize) {
      description_ = content;
      return;
    }
    const std::uint16_t before = word(2);
    state_ = content;
    if (states_++ > 0) lost_ += static_cast<std::uint16_t>(word(2) - before - 1);
    loop_max_us_ = std::max(loop_max_us_, word(44));
  }

  firmware::FrameReader reader_;
};

TEST_F(AvrFirmware, DescribesItselfAtItsStart) {
  run(2e-3);
  ASSERT_EQ(description_.size(), firmware::kDescriptionSize);
  EXPECT_EQ(description_[2], 1);
  EXPECT_EQ(description_[3], static_cast<int>(firmware::Geometry::kPaddle));
}

TEST_F(AvrFirmware, Reports1000TimesPerSecondWhileItIsDriven) {
  run(5e-3);
  drive_for(5, 0);
  const int before = states_;
  drive_for(1000, 0.5f);
  EXPECT_NEAR(states_ - before, 1000, 1);
  EXPECT_EQ(lost_, 0);
  EXPECT_EQ(damaged_, 0);
  EXPECT_EQ(word(20), 0);
  EXPECT_LT(loop_max_us_, 1000);
  std::printf("Longest loop: %d us, %d cycles of an ATmega328P at 16 MHz\n", loop_max_us_,
              16 * loop_max_us_);
}

TEST_F(AvrFirmware, MotorNeedsAZeroMessageFirst) {
  run(5e-3);
  drive_for(5, 0.5f);
  EXPECT_EQ(level(), 0);
  drive_for(5, 0);
  drive_for(5, 0.5f);
  // 0.5 A over 2 ohm are a twelfth of 12 V.
  EXPECT_NEAR(level(), 255 / 12, 1);
}

TEST_F(AvrFirmware, WatchdogActsWithin51ms) {
  run(5e-3);
  drive_for(5, 0);
  drive_for(5, 0.5f);
  ASSERT_GT(level(), 0);
  run(48e-3);
  EXPECT_GT(level(), 0);
  run(4e-3);
  EXPECT_EQ(level(), 0);
  EXPECT_EQ(word(20), firmware::kWatchdog);
}

TEST_F(AvrFirmware, CountsTheSensorOverItsJump) {
  run(5e-3);
  const auto before = firmware::get<std::int32_t>(&state_[8]);
  constexpr int kStep = 50;
  int raw = 500;
  for (int i = 0; i < 40; ++i) {
    raw += kStep;
    if (raw > 980) raw -= 965;
    set_sensor(raw);
    run(1e-3);
  }
  run(3e-3);
  EXPECT_NEAR(firmware::get<std::int32_t>(&state_[8]) - before, 40 * kStep, 3);
}

TEST_F(AvrFirmware, RefusesADamagedMessage) {
  run(5e-3);
  drive_for(5, 0);
  Bytes damaged = drive_one(0.5f);
  damaged[6] ^= 4;
  for (int i = 0; i < 5; ++i) run(1e-3, damaged);
  run(3e-3);
  EXPECT_EQ(level(), 0);
  EXPECT_EQ(word(42), 5);
}

}  // namespace
}  // namespace thimble::firmware_test
