#include "wires/described_link.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "thimble/driver/transports.h"
#include "transports/ftdi_transport.h"
#include "transports/stream_transport.h"

namespace thimble::driver {
namespace {

/// The wire of a described board. Owns the table by which its messages are found, and sends the
/// board's last message.
class DescribedTransport final : public Transport {
 public:
  DescribedTransport(std::unique_ptr<WireLayout> layout, std::unique_ptr<Transport> wire,
                     std::vector<std::byte> goodbye) noexcept
      : layout_(std::move(layout)), wire_(std::move(wire)), goodbye_(std::move(goodbye)) {}
  ~DescribedTransport() override {
    if (!goodbye_.empty() && started_) wire_->write(goodbye_);
  }

  TransportRead read_latest(std::span<std::byte> buffer,
                            std::int64_t deadline_ns) noexcept override {
    return wire_->read_latest(buffer, deadline_ns);
  }
  TransportStatus write(std::span<const std::byte> report) noexcept override {
    return wire_->write(report);
  }
  TransportStatus settled() noexcept override { return wire_->settled(); }

  /// Returns the number of damaged messages, if the wire is a stream of bytes.
  std::uint64_t torn() const noexcept {
    const auto* const stream = dynamic_cast<const StreamTransport*>(wire_.get());
    return stream == nullptr ? 0 : stream->counters().torn;
  }

  /// Sets by which table messages are found.
  void find(const WireLayout& layout) noexcept { *layout_ = layout; }
  /// Ends the start-up: from now on the board gets its last message.
  void set_started() noexcept { started_ = true; }

 private:
  std::unique_ptr<WireLayout> layout_;  // outlives the wire
  std::unique_ptr<Transport> wire_;
  std::vector<std::byte> goodbye_;
  bool started_ = false;
};

/// Returns the table that finds an answer in the stream: by its first known bytes, if there are
/// any.
WireLayout layout_of(const WireStep& step) {
  WireLayout layout;
  layout.size = step.expect.size();
  layout.padded = layout.size;
  while (layout.begin.size < kWireMarkMax && layout.begin.size < step.expect.size() &&
         !step.any[layout.begin.size]) {
    layout.begin.bytes[layout.begin.size] = step.expect[layout.begin.size];
    ++layout.begin.size;
  }
  layout.framing = layout.begin.size > 0 ? WireFraming::kHeader : WireFraming::kFixed;
  return layout;
}

bool is_answer(std::span<const std::byte> bytes, const WireStep& step) {
  if (bytes.size() < step.expect.size()) return false;
  for (std::size_t i = 0; i < step.expect.size(); ++i) {
    if (!step.any[i] && bytes[i] != step.expect[i]) return false;
  }
  return true;
}

/// Sends one start-up message and waits for its answer.
Result<void> take_step(DescribedTransport& wire, const WireStep& step, std::size_t number,
                       const Clock& clock) {
  const std::string name = "Start-up message " + std::to_string(number) + " (line " +
                           std::to_string(step.line.number) + " of the arm file): ";
  if (!step.expect.empty()) wire.find(layout_of(step));
  if (!step.send.empty() && wire.write(step.send) != TransportStatus::kOk) {
    return Error{name + "the board did not accept it. Check its power and cable."};
  }
  const std::int64_t end_ns = clock.now_ns() + static_cast<std::int64_t>(1e9 * step.within);
  if (step.expect.empty()) return {};
  // A wall clock ends the wait; this bound ends it if the clock does not advance. [chosen]
  constexpr int kReadsMax = 20'000;
  for (int i = 0; i < kReadsMax && clock.now_ns() < end_ns; ++i) {
    std::array<std::byte, kReportCapacity> buffer{};
    const TransportRead read = wire.read_latest(buffer, end_ns);
    if (read.status == TransportStatus::kLost) {
      return Error{name + "the board was disconnected. Check its cable and power."};
    }
    if (read.status == TransportStatus::kOk &&
        is_answer(std::span<const std::byte>(buffer).first(read.size), step)) {
      return {};
    }
  }
  return Error{name + "the expected answer did not arrive within " +
               std::to_string(static_cast<int>(1e3 * step.within)) +
               " ms, so this is another board or its firmware differs. No command was sent. Check "
               "its power, and compare its bytes with the file by `thimble wire check`."};
}

Result<std::unique_ptr<Transport>> open_transport(const std::string& node, const WireTable& wire,
                                                  const WireLayout& layout, const Clock& clock,
                                                  const UsbAddress& usb) {
  const Framing framing{.described = &layout};
  switch (wire.text.transport) {
    case WireTransport::kHid:
      return open_hid_transport(node, wire.command.padded, clock);
    case WireTransport::kSerial:
      return open_serial_transport(node, framing, clock, wire.text.baud);
    case WireTransport::kBulk:
      break;
  }
  const BulkEnds ends{
      .in = wire.text.identity.endpoint_in, .out = wire.text.identity.endpoint_out, .ftdi = false};
  auto device = open_bulk_device(usb, ends);
  if (!device) return device.error();
  return start_ftdi_transport(std::move(device).value(), framing, clock, ends);
}

/// Opens a board without sending anything. The transport sends the last message only after
/// `set_started`.
Result<std::unique_ptr<DescribedTransport>> open_quietly(const std::string& node,
                                                         const WireTable& wire, const Clock& clock,
                                                         const UsbAddress& usb) {
  auto layout = std::make_unique<WireLayout>(wire.report);
  auto opened = open_transport(node, wire, *layout, clock, usb);
  if (!opened) return opened.error();
  return std::make_unique<DescribedTransport>(std::move(layout), std::move(opened).value(),
                                              wire.text.goodbye);
}

}  // namespace

Result<void> listen_for_described(Transport& transport, const WireTable& wire, const Clock& clock) {
  // As for the WoodenHaptics board (woody_proof.cpp): 20 in a row are not chance.
  constexpr int kWanted = 20;
  constexpr std::int64_t kListen_ns = 1'000'000'000, kWait_ns = 20'000'000;
  constexpr int kReadsMax = 2000;
  const std::int64_t end_ns = clock.now_ns() + kListen_ns;
  bool any_before = false;
  std::uint16_t before = 0;  // number of the report before, if there is one
  int in_a_row = 0, reports = 0;
  WireVerdict last;
  for (int i = 0; i < kReadsMax && clock.now_ns() < end_ns; ++i) {
    std::array<std::byte, kReportCapacity> buffer{};
    const TransportRead read = transport.read_latest(buffer, clock.now_ns() + kWait_ns);
    if (read.status == TransportStatus::kLost) {
      return Error{
          "The board was disconnected while its reports were checked. Check its cable and power."};
    }
    if (read.status != TransportStatus::kOk) continue;
    ++reports;
    const auto bytes = std::span<const std::byte>(buffer).first(read.size);
    // Zeros, or one value again and again, have a right sum.
    if (std::adjacent_find(bytes.begin(), bytes.end(), std::not_equal_to<>()) == bytes.end()) {
      in_a_row = 0;
      continue;
    }
    WireValues values;
    const WireVerdict verdict = wire.report.read(bytes, values);
    if (!verdict && verdict.flaw != WireFlaw::kErrors) {
      last = verdict;
      any_before = false;
      in_a_row = 0;
      continue;
    }
    const auto number = static_cast<std::uint16_t>(values.sequence);
    const auto bits = wire.sequence_bits();
    const auto step = static_cast<std::uint16_t>((number - (any_before ? before : number - 1)) &
                                                 ((1U << bits) - 1));
    const bool follows = !wire.numbered || step == ((1 + read.skipped) & ((1U << bits) - 1));
    in_a_row = follows ? in_a_row + 1 : 0;
    before = number;
    any_before = true;
    if (in_a_row == kWanted) return {};
  }
  if (reports == 0) {
    return Error{
        "The board sends no reports by itself, but its arm file has exchange: stream. Nothing was "
        "sent to it. Check its power, or set exchange: ask."};
  }
  return Error{
      std::string("The reports of the board are not those of its arm file (") +
      (last ? "their numbers do not follow each other"
            : std::string(describe(last.flaw)) + " at byte " + std::to_string(last.byte)) +
      "). Nothing was sent to it. Compare its bytes with the file by `thimble wire check`."};
}

Result<std::unique_ptr<Transport>> open_to_listen(const std::string& node, const WireTable& wire,
                                                  const Clock& clock, const UsbAddress& usb) {
  auto transport = open_quietly(node, wire, clock, usb);
  if (!transport) return transport.error();
  return std::unique_ptr<Transport>(std::move(transport).value());
}

std::uint64_t torn_messages(const Transport& port) noexcept {
  const auto* const described = dynamic_cast<const DescribedTransport*>(&port);
  return described == nullptr ? 0 : described->torn();
}

Result<std::unique_ptr<Transport>> open_described(const std::string& node, const WireTable& wire,
                                                  const Clock& clock, const UsbAddress& usb) {
  auto opened = open_quietly(node, wire, clock, usb);
  if (!opened) return opened.error();
  auto transport = std::move(opened).value();
  if (wire.text.streams) {
    if (auto right = listen_for_described(*transport, wire, clock); !right) {
      return Error{node + ": " + right.error().message};
    }
  }
  std::size_t number = 0;
  for (const WireStep& step : wire.text.start) {
    if (auto right = take_step(*transport, step, ++number, clock); !right) {
      return Error{node + ": " + right.error().message};
    }
  }
  transport->find(wire.report);
  transport->set_started();
  return std::unique_ptr<Transport>(std::move(transport));
}

}  // namespace thimble::driver
