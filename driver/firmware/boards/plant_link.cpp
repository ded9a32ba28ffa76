#include "boards/plant_link.h"

#include <string.h>

#include "core/board.h"
#include "core/bytes.h"
#include "core/cobs.h"
#include "core/crc16.h"

namespace thimble {
namespace firmware {
namespace {

constexpr int kHost = 0, kPlant = 1;

ArmConfig arm;
Inputs sensors;
Outputs motors;
FrameReader from_host, from_plant;
size_t message_size;  // of a message of the host that was found but not yet read
uint32_t time_us, pass_began;
bool lit, hang, passing;

void send_frame(int port, const uint8_t* content, size_t size) noexcept {
  uint8_t frame[kFrameMax];
  const size_t length = encode_frame(content, size, frame);
  for (size_t i = 0; i < length; ++i) plant_link::put(port, frame[i]);
}

bool has_crc(const uint8_t* bytes, size_t size) noexcept {
  return size > 2 && get<uint16_t>(bytes + size - 2) == crc16(bytes, size - 2);
}

/// Takes the bytes of the plant until a valid frame is complete; returns its size, or 0.
size_t poll_plant() noexcept {
  uint8_t byte;
  while (plant_link::get(kPlant, byte)) {
    const size_t size = from_plant.take(byte);
    if (size > 0 && has_crc(from_plant.content(), size)) return size;
  }
  return 0;
}

void take_health(const uint8_t* bytes) noexcept {
  for (size_t i = 0; i < kMotorsMax; ++i) sensors.gimbal[i] = get<int16_t>(bytes + 2 + 2 * i);
  sensors.supply_mV = get<uint16_t>(bytes + 8);
  sensors.temperature_dC = get<int16_t>(bytes + 10);
  sensors.encoder_error = bytes[12] != 0;
  sensors.buttons = bytes[13];
  hang = bytes[14] != 0;
}

/// Takes the bytes of the host until a message is complete; returns its size, or 0.
size_t poll_host() noexcept {
  uint8_t byte;
  while (plant_link::get(kHost, byte)) {
    const size_t size = from_host.take(byte);
    if (size > 0) return size;
  }
  return 0;
}

void send_motors() noexcept {
  uint8_t bytes[kMotorsSize] = {kMotors, kWireVersion};
  bytes[2] = motors.motors_on;
  bytes[3] = lit;
  for (size_t i = 0; i < kMotorsMax; ++i) put(bytes + 4 + 4 * i, motors.amperes[i]);
  put(bytes + 16, plant_link::clock() - pass_began);
  put(bytes + 20, plant_link::clock_hz());
  put(bytes + 24, motors.fed_us);
  put(bytes + 28, crc16(bytes, kMotorsSize - 2));
  send_frame(kPlant, bytes, kMotorsSize);
}

}  // namespace

namespace board {

void start() noexcept {
  plant_link::start();
  for (;;) {
    const size_t size = poll_plant();
    const uint8_t* bytes = from_plant.content();
    if (size == kDescriptionSize && bytes[0] == kConfiguration) {
      decode_description(bytes, arm);
      return;
    }
    if (size == 0) plant_link::wait();
  }
}

ArmConfig config() noexcept {
  return arm;
}

bool restarted() noexcept {
  return plant_link::restarted();
}

uint32_t now_us() noexcept {
  return time_us;
}

bool tick_due() noexcept {
  if (passing) send_motors();
  passing = true;
  for (;;) {
    message_size = poll_host();
    if (message_size > 0) {
      pass_began = plant_link::clock();
      return false;
    }
    const size_t size = poll_plant();
    const uint8_t* bytes = from_plant.content();
    if (size == kHealthSize && bytes[0] == kHealth) {
      take_health(bytes);
    } else if (size == kSensorsSize && bytes[0] == kSensors) {
      time_us = get<uint32_t>(bytes + 4);
      for (size_t i = 0; i < kMotorsMax; ++i) sensors.counts[i] = get<int32_t>(bytes + 8 + 4 * i);
      pass_began = plant_link::clock();
      if (!hang) return bytes[2] != 0;
      for (;;) {  // until the hardware watchdog restarts the board
      }
    } else if (size == 0) {
      plant_link::wait();
    }
  }
}

void sample(Inputs& inputs) noexcept {
  inputs = sensors;
}

void apply(const Outputs& outputs) noexcept {
  motors = outputs;
}

void lamp(bool now) noexcept {
  lit = now;
}

void feed_watchdog() noexcept {
  plant_link::feed();
}

bool connected() noexcept {
  return true;
}

size_t receive(uint8_t* message) noexcept {
  const size_t size = message_size;
  message_size = 0;
  if (size > kHidReportSize) return 0;
  memcpy(message, from_host.content(), size);
  return size;
}

void send(const uint8_t* state) noexcept {
  send_frame(kHost, state, kStateSize);
}

void describe(const uint8_t* description) noexcept {
  send_frame(kHost, description, kDescriptionSize);
}

}  // namespace board
}  // namespace firmware
}  // namespace thimble
