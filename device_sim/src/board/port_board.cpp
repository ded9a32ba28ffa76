#include "board/port_board.h"

#include <algorithm>
#include <utility>

#include "wires/slip.h"

namespace thimble::device_sim {

PortBoard::PortBoard(SimulatedArm& arm, std::shared_ptr<const driver::WireTable> wire)
    : arm_(arm), wire_(std::move(wire)), heard_(driver::Framing{.described = &wire_->command}) {
  // The first bytes from the host are the beginning of a message.
  switch (wire_->command.framing) {
    case driver::WireFraming::kText:
      heard_.push(wire_->command.end.span());
      break;
    case driver::WireFraming::kCobs:
      heard_.push(std::span<const std::byte>(recent_).first(1));
      break;
    case driver::WireFraming::kSlip:
      heard_.push({&driver::kSlipEnd, 1});
      break;
    case driver::WireFraming::kFixed:
    case driver::WireFraming::kHeader:
    case driver::WireFraming::kLength:
      break;
  }
}

void PortBoard::advance_to(std::int64_t time_ns) noexcept {
  arm_.advance_to(time_ns);
  if (!wire_->text.streams) return;
  std::array<std::byte, driver::kReportCapacity> report;
  std::uint32_t skipped = 0;
  const std::size_t size = arm_.take_report(report, skipped);
  if (size > 0) put(std::span<const std::byte>(report).first(size));
}

void PortBoard::hear(std::span<const std::byte> bytes) noexcept {
  for (const std::byte byte : bytes) {
    // The last byte of a start-up message is not the first of a command.
    if (hear_start(byte)) continue;
    heard_.push(std::span(&byte, 1));
    if (!heard_.ready()) continue;
    std::array<std::byte, driver::kReportCapacity> message;
    std::uint32_t skipped = 0;
    const std::size_t size = heard_.take(message, skipped);
    const auto command = std::span<const std::byte>(message).first(size);
    arm_.put_message(command);
    driver::WireValues ignored;
    if (wire_->text.streams || !wire_->command.read(command, ignored)) continue;
    put(arm_.sample_now());
  }
}

bool PortBoard::hear_start(std::byte byte) noexcept {
  if (wire_->text.start.empty()) return false;
  if (recent_size_ == recent_.size()) {
    std::copy(recent_.begin() + 1, recent_.end(), recent_.begin());
    --recent_size_;
  }
  recent_[recent_size_++] = byte;
  for (const driver::WireStep& step : wire_->text.start) {
    if (step.send.empty() || recent_size_ < step.send.size()) continue;
    const auto last = recent_.begin() + static_cast<std::ptrdiff_t>(recent_size_);
    const auto first = last - static_cast<std::ptrdiff_t>(step.send.size());
    if (!std::equal(first, last, step.send.begin())) continue;
    put(step.expect);
    recent_size_ = 0;
    heard_.forget_partial();
    return true;
  }
  return false;
}

void PortBoard::put(std::span<const std::byte> bytes) noexcept {
  if (waiting_size_ + bytes.size() > waiting_.size()) return;
  std::copy(bytes.begin(), bytes.end(),
            waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_size_));
  waiting_size_ += bytes.size();
}

std::size_t PortBoard::say(std::span<std::byte> room) noexcept {
  const std::size_t size = std::min(room.size(), waiting_size_);
  std::copy_n(waiting_.begin(), size, room.begin());
  std::copy(waiting_.begin() + static_cast<std::ptrdiff_t>(size),
            waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_size_), waiting_.begin());
  waiting_size_ -= size;
  return size;
}

}  // namespace thimble::device_sim
