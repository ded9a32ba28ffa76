#include "support/mock/fake_hidapi.h"

#include <hidapi.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>

#include "support/boards/raw_hid.h"

namespace thimble::support {

FakeHidapi& fake_hidapi() {
  static FakeHidapi only;
  return only;
}

}  // namespace thimble::support

using thimble::support::fake_hidapi;

extern "C" {

hid_device_info* hid_enumerate(unsigned short, unsigned short) {
  static char path[] = "/dev/hidraw7";
  static hid_device_info only{};
  if (fake_hidapi().listed_vendor == 0) return nullptr;
  only.path = path;
  only.vendor_id = fake_hidapi().listed_vendor;
  only.product_id = fake_hidapi().listed_product;
  only.usage_page = 1;
  only.usage = 8;
  return &only;
}
void hid_free_enumeration(hid_device_info*) {}
hid_device* hid_open_path(const char*) {
  static int place = 0;
  if (fake_hidapi().refused) return nullptr;
  ++fake_hidapi().open;
  return reinterpret_cast<hid_device*>(&place);
}
void hid_close(hid_device*) {
  --fake_hidapi().open;
}
int hid_read_timeout(hid_device*, unsigned char* data, std::size_t length, int milliseconds) {
  auto& hid = fake_hidapi();
  hid.last_timeout_ms = milliseconds;
  if (hid.interruptions > 0) {
    --hid.interruptions;
    errno = EINTR;
    return -1;
  }
  if (hid.gone) {
    errno = ENODEV;
    return -1;
  }
  if (!hid.script.empty()) {
    const std::size_t report_size = hid.script[0];
    std::copy_n(hid.script.data() + 1, std::min(report_size, length), data);
    hid.script = hid.script.subspan(1 + report_size);
    return static_cast<int>(std::min(report_size, length));
  }
  int& left = hid.reports == 0 && milliseconds > 0 ? hid.coming : hid.reports;
  if (left == 0) return 0;
  --left;
  const std::size_t size = std::min<std::size_t>(length, 8);
  std::fill_n(data, size, static_cast<unsigned char>(0));
  hid.number = static_cast<std::uint16_t>(hid.number + hid.number_step);
  data[hid.numbered_last ? 6 : 0] = static_cast<unsigned char>(hid.number);
  if (hid.numbered_last) data[7] = static_cast<unsigned char>(hid.number >> 8);
  return static_cast<int>(size);
}
int hid_write(hid_device*, const unsigned char* data, std::size_t length) {
  auto& hid = fake_hidapi();
  if (hid.interruptions > 0) {
    --hid.interruptions;
    errno = EINTR;
    return -1;
  }
  if (hid.write_error != 0) {
    errno = hid.write_error;
    return -1;
  }
  hid.last_message_size = std::min(length, hid.last_message.size());
  std::copy_n(data, hid.last_message_size, hid.last_message.begin());
  ++hid.messages;
  return static_cast<int>(length);
}

int ioctl(int file, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  const auto bytes = static_cast<unsigned char>(fake_hidapi().report_bytes);
  const auto descriptor = thimble::support::raw_hid_descriptor(bytes, bytes);
  if (bytes > 0 && request == HIDIOCGRDESCSIZE) {
    *static_cast<int*>(argument) = static_cast<int>(descriptor.size());
    return 0;
  }
  if (bytes > 0 && request == HIDIOCGRDESC) {
    std::copy(descriptor.begin(), descriptor.end(),
              static_cast<hidraw_report_descriptor*>(argument)->value);
    return 0;
  }
  return static_cast<int>(syscall(SYS_ioctl, file, request, argument));
}

}  // extern "C"
