#pragma once

#include <array>

namespace thimble::support {

/// Builds the report descriptor of mbed's and Teensy's raw HID examples with reports of the given
/// sizes, bytes [S mbed USBHID.cpp, reportDesc], or of another usage page.
constexpr std::array<unsigned char, 27> raw_hid_descriptor(unsigned char in_bytes,
                                                           unsigned char out_bytes,
                                                           unsigned page = 0xffab) {
  return {0x06,
          static_cast<unsigned char>(page & 0xffU),
          static_cast<unsigned char>(page >> 8U),
          0x0a,
          0x00,
          0x02,  // usage 0x0200
          0xa1,
          0x01,  // collection
          0x75,
          0x08,  // 8 bits each
          0x15,
          0x00,
          0x26,
          0xff,
          0x00,  // 0 to 255
          0x95,
          in_bytes,
          0x09,
          0x01,
          0x81,
          0x02,  // inputs
          0x95,
          out_bytes,
          0x09,
          0x02,
          0x91,
          0x02};  // outputs; the end of the collection is implied
}

}  // namespace thimble::support
