#include "support/mock/fake_libusb.h"

#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <cstdlib>

using thimble::support::fake_libusb;
using thimble::support::FakeLibusb;

namespace thimble::support {

FakeLibusb& fake_libusb() {
  static FakeLibusb only;
  return only;
}

void FakeLibusb::say(std::string_view text) {
  Read& read = chat_[chat_end_++ % kChatMax];
  read.status = LIBUSB_TRANSFER_COMPLETED;
  read.bytes[0] = std::byte{0x31};  // modem and line status
  read.bytes[1] = std::byte{0x60};
  std::transform(text.begin(), text.end(), read.bytes.begin() + 2,
                 [](char letter) { return static_cast<std::byte>(letter); });
  read.size = 2 + text.size();
}

void FakeLibusb::fail(int status) {
  Read& read = chat_[chat_end_++ % kChatMax];
  read.status = status;
  read.size = 0;
}

bool FakeLibusb::take_read(Read& read) {
  if (chat_begin_ == chat_end_) return false;
  read = chat_[chat_begin_++ % kChatMax];
  return true;
}

}  // namespace thimble::support

namespace {

// The library hides its types, so any address is valid.
int place = 0;
libusb_device* const kDevice = reinterpret_cast<libusb_device*>(&place);
std::array<libusb_device*, 2> list{kDevice, nullptr};

bool inwards(const libusb_transfer& transfer) {
  return (transfer.endpoint & LIBUSB_ENDPOINT_IN) != 0;
}

void complete(void*& slot, int status, int length) {
  auto* transfer = static_cast<libusb_transfer*>(slot);
  slot = nullptr;
  --fake_libusb().under_way;
  transfer->status = static_cast<libusb_transfer_status>(status);
  transfer->actual_length = length;
  transfer->callback(transfer);
}

}  // namespace

extern "C" {

int libusb_init(libusb_context** context) {
  ++fake_libusb().contexts;
  *context = reinterpret_cast<libusb_context*>(&place);
  return 0;
}
void libusb_exit(libusb_context*) {
  --fake_libusb().contexts;
}
ssize_t libusb_get_device_list(libusb_context*, libusb_device*** devices) {
  *devices = list.data();
  return 1;
}
void libusb_free_device_list(libusb_device**, int) {}
std::uint8_t libusb_get_bus_number(libusb_device*) {
  return 1;
}
std::uint8_t libusb_get_device_address(libusb_device*) {
  return 7;
}
int libusb_open(libusb_device*, libusb_device_handle** handle) {
  if (fake_libusb().open_code != 0) return fake_libusb().open_code;
  ++fake_libusb().handles;
  *handle = reinterpret_cast<libusb_device_handle*>(&place);
  return 0;
}
void libusb_close(libusb_device_handle*) {
  --fake_libusb().handles;
}
int libusb_set_auto_detach_kernel_driver(libusb_device_handle*, int) {
  return 0;
}
int libusb_claim_interface(libusb_device_handle*, int) {
  ++fake_libusb().claimed;
  return 0;
}
int libusb_release_interface(libusb_device_handle*, int) {
  --fake_libusb().claimed;
  return 0;
}
int libusb_clear_halt(libusb_device_handle*, unsigned char) {
  ++fake_libusb().cleared_halts;
  return 0;
}
int libusb_control_transfer(libusb_device_handle*, std::uint8_t, std::uint8_t, std::uint16_t,
                            std::uint16_t, unsigned char*, std::uint16_t, unsigned) {
  FakeLibusb& usb = fake_libusb();
  const auto& refused = usb.requests_refused;
  const bool taken =
      std::find(refused.begin(), refused.end(), usb.control_requests) == refused.end();
  ++usb.control_requests;
  return taken ? 0 : LIBUSB_ERROR_PIPE;
}
int libusb_bulk_transfer(libusb_device_handle*, unsigned char endpoint, unsigned char* bytes,
                         int size, int* moved, unsigned) {
  FakeLibusb& usb = fake_libusb();
  *moved = 0;
  FakeLibusb::Read read;
  if ((endpoint & LIBUSB_ENDPOINT_IN) == 0 || !usb.take_read(read)) {
    return usb.read_code != 0 ? usb.read_code : LIBUSB_ERROR_TIMEOUT;
  }
  *moved = std::min(size, static_cast<int>(read.size));
  std::copy_n(reinterpret_cast<const unsigned char*>(read.bytes.data()), *moved, bytes);
  return 0;
}
const char* libusb_strerror(int) {
  return "scripted";
}
libusb_transfer* libusb_alloc_transfer(int) {
  ++fake_libusb().transfers;
  return static_cast<libusb_transfer*>(std::calloc(1, sizeof(libusb_transfer)));
}
void libusb_free_transfer(libusb_transfer* transfer) {
  if (transfer == nullptr) return;
  --fake_libusb().transfers;
  std::free(transfer);
}
int libusb_submit_transfer(libusb_transfer* transfer) {
  FakeLibusb& usb = fake_libusb();
  if (usb.submit_code != 0) return usb.submit_code;
  if (usb.interruptions > 0) {
    --usb.interruptions;
    return LIBUSB_ERROR_INTERRUPTED;
  }
  auto* slot = std::find(usb.waiting.begin(), usb.waiting.end(), nullptr);
  if (slot == usb.waiting.end()) return LIBUSB_ERROR_NO_MEM;
  *slot = transfer;
  ++usb.under_way;
  return 0;
}
int libusb_cancel_transfer(libusb_transfer* transfer) {
  FakeLibusb& usb = fake_libusb();
  auto* slot = std::find(usb.waiting.begin(), usb.waiting.end(), transfer);
  if (slot == usb.waiting.end()) return LIBUSB_ERROR_NOT_FOUND;
  complete(*slot, LIBUSB_TRANSFER_CANCELLED, 0);
  return 0;
}
int libusb_handle_events_timeout_completed(libusb_context*, timeval*, int*) {
  FakeLibusb& usb = fake_libusb();
  if (usb.interruptions > 0) {
    --usb.interruptions;
    return LIBUSB_ERROR_INTERRUPTED;
  }
  for (void*& slot : usb.waiting) {
    auto* transfer = static_cast<libusb_transfer*>(slot);
    if (transfer == nullptr || inwards(*transfer) || !usb.takes) continue;
    usb.last_message_size =
        std::min(static_cast<std::size_t>(transfer->length), usb.last_message.size());
    std::copy_n(reinterpret_cast<const std::byte*>(transfer->buffer), usb.last_message_size,
                usb.last_message.begin());
    ++usb.messages;
    if (usb.answers) usb.say(usb.answer);
    complete(slot, usb.write_status, transfer->length);
  }
  // A completed read is submitted again by its callback, into the same place.
  FakeLibusb::Read read;
  for (std::size_t i = 0, idle = 0; idle < usb.waiting.size(); i = (i + 1) % usb.waiting.size()) {
    void*& slot = usb.waiting[i];
    auto* transfer = static_cast<libusb_transfer*>(slot);
    if (transfer == nullptr || !inwards(*transfer)) {
      ++idle;
      continue;
    }
    if (!usb.take_read(read)) break;
    idle = 0;
    std::copy_n(reinterpret_cast<const unsigned char*>(read.bytes.data()), read.size,
                transfer->buffer);
    complete(slot, read.status, static_cast<int>(read.size));
  }
  return 0;
}

}  // extern "C"
