#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/core/bytes.h"
#include "firmware/core/crc16.h"
#include "firmware/core/packet.h"

namespace thimble::firmware::test {

using Message = std::vector<std::uint8_t>;

/// Closes a message with its CRC.
inline Message closed(Message bytes) {
  const std::uint16_t crc = crc16(bytes.data(), bytes.size());
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xff));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  return bytes;
}

/// Returns a message without content.
inline Message message(MessageType type, std::uint16_t number = 1) {
  return closed({type, kWireVersion, static_cast<std::uint8_t>(number & 0xff),
                 static_cast<std::uint8_t>(number >> 8)});
}

/// Returns a message with three fields of four bytes, or one of two.
template <class Field, std::size_t kFields>
Message message(MessageType type, const std::array<Field, kFields>& fields,
                std::uint16_t number = 1) {
  Message bytes{type, kWireVersion, static_cast<std::uint8_t>(number & 0xff),
                static_cast<std::uint8_t>(number >> 8)};
  bytes.resize(4 + kFields * sizeof(Field));
  for (std::size_t i = 0; i < kFields; ++i) put(bytes.data() + 4 + i * sizeof(Field), fields[i]);
  return closed(bytes);
}

/// Returns a drive message.
inline Message drive(float a, float b, float c, std::uint16_t number = 1) {
  return message(kDrive, std::array<float, 3>{a, b, c}, number);
}

}  // namespace thimble::firmware::test
