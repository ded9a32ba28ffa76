#include "usb/ftdi_bus.h"

#include <algorithm>

#include "transports/ftdi_packet.h"
#include "usb/ftdi_chip.h"
#include "usb/setup_packet.h"

namespace thimble::device_sim::usb {

void FtdiBus::advance_to(std::int64_t time_ns) noexcept {
  time_ns_ = std::max(time_ns_, time_ns);
  device_.advance_to(time_ns_);
}

std::size_t FtdiBus::read(std::span<std::byte> packet) noexcept {
  const PacketResult result = device_.in(FtdiChip::kInEndpoint, packet);
  return result.answer == Answer::kDone ? std::min(result.size, packet.size()) : 0;
}

bool FtdiBus::write(std::span<const std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    const auto packet = bytes.first(std::min(bytes.size(), UsbDevice::kPacketMax));
    if (device_.out(FtdiChip::kOutEndpoint, packet).answer != Answer::kDone) return false;
    bytes = bytes.subspan(packet.size());
  }
  return true;
}

bool FtdiBusLine::request(std::uint8_t number, std::uint16_t value) {
  const SetupPacket setup{.request_type = 0x40, .request = number, .value = value};
  const bool done = bus_.device().control(setup, {}).answer == Answer::kDone;
  step();  // a control transfer takes one frame
  return done;
}

void FtdiBusLine::step() {
  bus_.frame([this](std::span<const std::byte> packet) {
    driver::for_each_ftdi_packet(packet, [this](std::span<const std::byte> content) {
      heard_.insert(heard_.end(), content.begin(), content.end());
    });
  });
}

bool FtdiBusLine::purge() {
  const bool done = request(0, 1) && request(0, 2);
  heard_.clear();
  return done;
}

bool FtdiBusLine::write(std::span<const std::byte> bytes) {
  constexpr int kFramesMax = 1000;  // as long as the timeout of the real line
  for (int i = 0; i < kFramesMax; ++i) {
    if (bus_.write(bytes)) return true;
    step();
  }
  return false;
}

int FtdiBusLine::read(std::span<std::byte> bytes, int timeout_ms) {
  for (int i = 0; i < timeout_ms && heard_.empty(); ++i) step();
  const std::size_t size = std::min(bytes.size(), heard_.size());
  std::copy_n(heard_.begin(), size, bytes.begin());
  heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(size));
  return static_cast<int>(size);
}

void FtdiBusTransport::pass_frames() noexcept {
  const std::int64_t now_ns = begin_ns_ + clock_.now_ns();
  while (bus_.time_ns() / FtdiBus::kFrame_ns < now_ns / FtdiBus::kFrame_ns) {
    bus_.frame([this](std::span<const std::byte> packet) {
      driver::for_each_ftdi_packet(
          packet, [this](std::span<const std::byte> content) { finder_.push(content); });
    });
  }
  bus_.advance_to(now_ns);
}

driver::TransportRead FtdiBusTransport::read_latest(std::span<std::byte> buffer,
                                                    std::int64_t deadline_ns) noexcept {
  pass_frames();
  while (!finder_.ready() && clock_.now_ns() < deadline_ns) {
    const std::int64_t next_ns = (bus_.time_ns() / FtdiBus::kFrame_ns + 1) * FtdiBus::kFrame_ns;
    clock_.sleep_until_ns(std::min(deadline_ns, next_ns - begin_ns_));
    pass_frames();
  }
  driver::TransportRead read;
  read.size = finder_.take(buffer, read.skipped);
  if (read.size > 0) read.status = driver::TransportStatus::kOk;
  return read;
}

driver::TransportStatus FtdiBusTransport::write(std::span<const std::byte> report) noexcept {
  pass_frames();
  return bus_.write(report) ? driver::TransportStatus::kOk : driver::TransportStatus::kRefused;
}

}  // namespace thimble::device_sim::usb
