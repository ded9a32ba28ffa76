#include "packet.h"

#include "bytes.h"
#include "crc16.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the wire is little endian");

namespace thimble {
namespace firmware {
namespace {

constexpr size_t kHeader = 4;
constexpr size_t kCrc = 2;

void begin(uint8_t type, uint16_t number, uint8_t* bytes) noexcept {
  bytes[0] = type;
  bytes[1] = kWireVersion;
  put(bytes + 2, number);
}

void end(uint8_t* bytes, size_t size) noexcept {
  put(bytes + size - kCrc, crc16(bytes, size - kCrc));
}

/// Returns the length of a message to the board; 0 for an unknown type.
size_t size_of(uint8_t type) noexcept {
  switch (type) {
    case kDrive:
    case kSetCounters:
      return kHeader + 12 + kCrc;
    case kBlink:
      return kHeader + 2 + kCrc;
    case kStop:
    case kClear:
    case kDescribe:
      return kHeader + kCrc;
    default:
      return 0;
  }
}

}  // namespace

void encode_state(const State& state, uint8_t* bytes) noexcept {
  begin(kState, state.number, bytes);
  put(bytes + 4, state.time_us);
  for (size_t i = 0; i < kMotorsMax; ++i) {
    put(bytes + 8 + 4 * i, state.counts[i]);
    put(bytes + 24 + 2 * i, state.current_mA[i]);
    put(bytes + 36 + 2 * i, state.gimbal[i]);
  }
  put(bytes + 20, state.flags);
  bytes[22] = static_cast<uint8_t>(state.stage);
  bytes[23] = state.buttons;
  put(bytes + 30, state.temperature_dC);
  put(bytes + 32, state.supply_mV);
  put(bytes + 34, state.echo);
  put(bytes + 42, state.refused);
  put(bytes + 44, state.loop_us);
  end(bytes, kStateSize);
}

void encode_description(const ArmConfig& config, uint16_t flags, uint8_t* bytes) noexcept {
  bytes[0] = kDescription;
  bytes[1] = kWireVersion;
  bytes[2] = config.motors;
  bytes[3] = static_cast<uint8_t>(config.geometry);
  memcpy(bytes + 4, config.serial, sizeof config.serial);
  put(bytes + 12, config.arm_file_hash);
  put(bytes + 16, config.watchdog_ms);
  put(bytes + 18, config.loop_hz);
  put(bytes + 20, config.report_hz);
  put(bytes + 22, config.current_max_mA);
  put(bytes + 24, config.speed_max);
  put(bytes + 26, config.temperature_max_dC);
  put(bytes + 28, config.supply_min_mV);
  put(bytes + 30, flags);
  for (size_t i = 0; i < kMotorsMax; ++i) {
    put(bytes + 32 + 4 * i, config.counts_per_turn[i]);
    put(bytes + 44 + 4 * i, config.ratio[i]);
  }
  memcpy(bytes + 56, config.board, sizeof config.board);
  end(bytes, kDescriptionSize);
}

void decode_description(const uint8_t* bytes, ArmConfig& config) noexcept {
  if (bytes[2] >= 1 && bytes[2] <= kMotorsMax) config.motors = bytes[2];
  config.geometry = static_cast<Geometry>(bytes[3]);
  memcpy(config.serial, bytes + 4, sizeof config.serial);
  config.arm_file_hash = get<uint32_t>(bytes + 12);
  config.watchdog_ms = get<uint16_t>(bytes + 16);
  if (get<uint16_t>(bytes + 18) != 0) config.loop_hz = get<uint16_t>(bytes + 18);
  if (get<uint16_t>(bytes + 20) != 0) config.report_hz = get<uint16_t>(bytes + 20);
  config.current_max_mA = get<uint16_t>(bytes + 22);
  config.speed_max = get<uint16_t>(bytes + 24);
  config.temperature_max_dC = get<int16_t>(bytes + 26);
  config.supply_min_mV = get<uint16_t>(bytes + 28);
  for (size_t i = 0; i < kMotorsMax; ++i) {
    config.counts_per_turn[i] = get<uint32_t>(bytes + 32 + 4 * i);
    config.ratio[i] = get<float>(bytes + 44 + 4 * i);
  }
  memcpy(config.board, bytes + 56, sizeof config.board);
}

bool decode_command(const uint8_t* bytes, size_t size, Command& command) noexcept {
  if (size < kHeader + kCrc || bytes[1] != kWireVersion) return false;
  const size_t length = size_of(bytes[0]);
  if (length == 0 || (size != length && size != kHidReportSize)) return false;
  if (get<uint16_t>(bytes + length - kCrc) != crc16(bytes, length - kCrc)) return false;
  command = Command();
  command.type = bytes[0];
  command.number = get<uint16_t>(bytes + 2);
  for (size_t i = 0; i < kMotorsMax; ++i) {
    if (command.type == kDrive) command.amperes[i] = get<float>(bytes + kHeader + 4 * i);
    if (command.type == kSetCounters) command.counters[i] = get<int32_t>(bytes + kHeader + 4 * i);
  }
  if (command.type == kBlink) command.duration_ms = get<uint16_t>(bytes + kHeader);
  return true;
}

}  // namespace firmware
}  // namespace thimble
