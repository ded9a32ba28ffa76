#include "hid_device.h"

#include <string.h>

namespace thimble {
namespace firmware {
namespace {

// Universal Serial Bus Specification 2.0, chapter 9 (requests and descriptors); Device Class
// Definition for HID 1.11, sections 6.2 and 7.2.

// pid.codes, for tests only. Use your own id for boards that you give to others.
constexpr uint16_t kVendorId = 0x1209, kProductId = 0x0001;
constexpr char kManufacturer[] = "thimble";

// Usage page of the vendor, usage 1; input, output and feature report of 64 bytes.
constexpr uint8_t kReportDescriptor[] = {
    0x06, 0x54, 0xff,  // usage page 0xff54
    0x09, 0x01,        // usage 1
    0xa1, 0x01,        // collection, application
    0x15, 0x00,        // logical minimum 0
    0x26, 0xff, 0x00,  // logical maximum 255
    0x75, 0x08,        // report size 8 bits
    0x95, 0x40,        // report count 64
    0x09, 0x01,        // usage 1
    0x81, 0x02,        // input, variable
    0x09, 0x02,        // usage 2
    0x91, 0x02,        // output, variable
    0x09, 0x03,        // usage 3
    0xb1, 0x02,        // feature, variable
    0xc0,              // end of the collection
};

constexpr uint8_t low(uint16_t word) noexcept {
  return static_cast<uint8_t>(word & 0xff);
}
constexpr uint8_t high(uint16_t word) noexcept {
  return static_cast<uint8_t>(word >> 8);
}

constexpr uint8_t kDeviceDescriptor[18] = {
    18,
    1,
    0x00,
    0x02,  // USB 2.0
    0,
    0,
    0,
    HidDevice::kPacketSize,  // class of each interface
    low(kVendorId),
    high(kVendorId),
    low(kProductId),
    high(kProductId),
    0x00,
    0x01,  // release 1.0
    1,
    2,
    3,
    1,  // strings, one configuration
};

// What the device would be at the other speed (9.6.2).
constexpr uint8_t kQualifier[10] = {10, 6, 0x00, 0x02, 0, 0, 0, HidDevice::kPacketSize, 1, 0};

constexpr uint8_t kHidDescriptor[9] = {
    9, 0x21, 0x11, 0x01, 0, 1, 0x22, low(sizeof kReportDescriptor), high(sizeof kReportDescriptor),
};

constexpr uint8_t kConfiguration[41] = {
    9,
    2,
    41,
    0,
    1,
    1,
    0,
    0x80,
    250,  // bus-powered, 500 mA
    9,
    4,
    0,
    0,
    2,
    3,
    0,
    0,
    0,  // interface 0: HID, two endpoints
    9,
    0x21,
    0x11,
    0x01,
    0,
    1,
    0x22,
    low(sizeof kReportDescriptor),
    high(sizeof kReportDescriptor),
    7,
    5,
    0x80 | HidDevice::kEndpoint,
    3,
    HidDevice::kPacketSize,
    0,
    HidDevice::kInterval_ms,
    7,
    5,
    HidDevice::kEndpoint,
    3,
    HidDevice::kPacketSize,
    0,
    HidDevice::kInterval_ms,
};

// Offsets of the polling intervals in the configuration.
constexpr size_t kIntervalsAt[2] = {33, 40};

constexpr uint8_t kLanguages[4] = {4, 3, 0x09, 0x04};  // English
constexpr uint8_t kNoStatus[2] = {0, 0};
constexpr uint8_t kOne = 1, kZero = 0;

UsbReply sending(const uint8_t* data, size_t size) noexcept {
  UsbReply reply;
  reply.kind = UsbReply::kSend;
  reply.data = data;
  reply.size = static_cast<uint16_t>(size);
  return reply;
}

UsbReply acknowledging(UsbReply::Kind kind = UsbReply::kAcknowledge) noexcept {
  UsbReply reply;
  reply.kind = kind;
  return reply;
}

}  // namespace

HidDevice::HidDevice(const char* product, const uint8_t* serial) noexcept : product_(product) {
  constexpr char kDigits[] = "0123456789abcdef";
  for (size_t i = 0; i < 8; ++i) {
    serial_[2 * i] = kDigits[serial[i] >> 4];
    serial_[2 * i + 1] = kDigits[serial[i] & 15];
  }
  serial_[16] = 0;
}

void HidDevice::set_feature(const uint8_t* report) noexcept {
  memcpy(feature_, report, sizeof feature_);
}

UsbReply HidDevice::text(const char* text) noexcept {
  size_t size = 2;
  for (; *text != 0 && size < sizeof answer_; ++text) {
    answer_[size++] = static_cast<uint8_t>(*text);
    answer_[size++] = 0;
  }
  answer_[0] = static_cast<uint8_t>(size);
  answer_[1] = 3;
  return sending(answer_, size);
}

UsbReply HidDevice::configuration(uint8_t type, bool high_speed) noexcept {
  memcpy(answer_, kConfiguration, sizeof kConfiguration);
  answer_[1] = type;
  for (const size_t at : kIntervalsAt) answer_[at] = high_speed ? kHighSpeedInterval : kInterval_ms;
  return sending(answer_, sizeof kConfiguration);
}

UsbReply HidDevice::descriptor(uint8_t type, uint8_t index) noexcept {
  switch (type) {
    case 1:
      return sending(kDeviceDescriptor, sizeof kDeviceDescriptor);
    case 2:
      return index == 0 ? configuration(2, high_speed_) : UsbReply();
    case 3:
      if (index == 0) return sending(kLanguages, sizeof kLanguages);
      if (index == 1) return text(kManufacturer);
      if (index == 2) return text(product_);
      return index == 3 ? text(serial_) : UsbReply();
    case 6:  // only devices of two speeds answer these two
      return offers_high_speed_ ? sending(kQualifier, sizeof kQualifier) : UsbReply();
    case 7:
      return offers_high_speed_ && index == 0 ? configuration(7, !high_speed_) : UsbReply();
    case 0x21:
      return sending(kHidDescriptor, sizeof kHidDescriptor);
    case 0x22:
      return sending(kReportDescriptor, sizeof kReportDescriptor);
    default:
      return UsbReply();
  }
}

UsbReply HidDevice::setup(const uint8_t* packet) noexcept {
  const uint16_t request = static_cast<uint16_t>(packet[0] << 8 | packet[1]);
  const uint8_t value = packet[2], kind = packet[3];
  const uint16_t length = static_cast<uint16_t>(packet[6] | packet[7] << 8);
  UsbReply reply;
  switch (request) {
    case 0x8006:  // get descriptor, device
    case 0x8106:  // interface
      reply = descriptor(kind, value);
      break;
    case 0x0005:  // set address
      reply = acknowledging(UsbReply::kSetAddress);
      reply.address = value & 0x7f;
      break;
    case 0x0009:  // set configuration
      if (value > 1) break;
      configured_ = value == 1;
      reply = acknowledging(configured_ ? UsbReply::kOpenEndpoints : UsbReply::kAcknowledge);
      break;
    case 0x8008:  // get configuration
      reply = sending(configured_ ? &kOne : &kZero, 1);
      break;
    case 0x8000:  // get status, device, interface, endpoint
    case 0x8100:
    case 0x8200:
      reply = sending(kNoStatus, sizeof kNoStatus);
      break;
    case 0x810a:  // get interface
      reply = sending(&kZero, 1);
      break;
    case 0x0201:  // clear feature of an endpoint, set interface: DATA0 follows (9.1.1.5)
    case 0x010b:
      reply = acknowledging(configured_ ? UsbReply::kOpenEndpoints : UsbReply::kAcknowledge);
      break;
    case 0x210a:  // HID: set idle
      reply = acknowledging();
      break;
    case 0xa101:  // HID: get report
      if (kind == 3 && value == 0) reply = sending(feature_, sizeof feature_);
      break;
    default:
      break;
  }
  if (reply.kind != UsbReply::kSend) return reply;
  if (length == 0) return acknowledging();
  if (reply.size > length) reply.size = length;
  reply.ends_empty = reply.size < length && reply.size % kPacketSize == 0;
  return reply;
}

}  // namespace firmware
}  // namespace thimble
