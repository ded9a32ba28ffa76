// Timing of the reports of a described board at a port.
#include "bringup/wire_timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "arm/wire_section.h"
#include "support/boards/described_port.h"
#include "wires/described_link.h"

namespace thimble::bringup {
namespace {

using driver::WireItem;
using driver::WireType;

/// A numbered wire with a check value.
driver::WireTable numbered_wire() {
  driver::WireDescription wire;
  wire.transport = driver::WireTransport::kSerial;
  wire.streams = true;
  for (driver::WireLayoutText* layout : {&wire.report, &wire.command}) {
    layout->framing = driver::WireFraming::kHeader;
    layout->begin = {std::byte{0xaa}};
    layout->size = 8;
    layout->check = {.kind = driver::WireCheck::kXor8, .at = 7};
  }
  const auto add = [](driver::WireLayoutText& layout, WireItem item, WireType type,
                      std::size_t at) {
    driver::WireFieldText field;
    field.item = item;
    field.type = type;
    field.at = at;
    field.bytes = 2;
    layout.fields.push_back(field);
  };
  add(wire.report, WireItem::kSequence, WireType::kUnsigned, 1);
  add(wire.report, WireItem::kEncoder, WireType::kSigned, 3);
  add(wire.command, WireItem::kMotor, WireType::kSigned, 1);
  const auto compiled = driver::compile_wire(wire);
  EXPECT_TRUE(compiled.table);
  return compiled.table ? *compiled.table : driver::WireTable{};
}

/// One message of a script: its number, the time since the one before, and whether it is damaged.
struct Sent {
  int number = 0;
  double after_ms = 1;
  bool damaged = false;
};

/// A port on virtual time that delivers a script, then stays silent. It must not be written to.
class ScriptedPort final : public driver::Transport {
 public:
  ScriptedPort(const driver::WireTable& wire, driver::VirtualClock& clock, std::vector<Sent> script)
      : wire_(wire), clock_(clock), script_(std::move(script)) {}

  driver::TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept override {
    if (next_ == script_.size()) {
      clock_.sleep_until_ns(deadline_ns);
      return {};
    }
    const Sent& sent = script_[next_++];
    clock_.sleep_until_ns(clock_.now_ns() + static_cast<std::int64_t>(1e6 * sent.after_ms));
    driver::WireValues values;
    values.sequence = sent.number;
    std::array<std::byte, driver::kReportCapacity> bytes{};
    const std::size_t size = wire_.report.write(values, bytes);
    if (sent.damaged) bytes[3] ^= std::byte{1};
    std::copy_n(bytes.begin(), size, buffer.begin());
    return {.status = driver::TransportStatus::kOk, .size = size};
  }
  driver::TransportStatus write(std::span<const std::byte>) noexcept override {
    ++writes_;
    return driver::TransportStatus::kOk;
  }
  int writes() const noexcept { return writes_; }

 private:
  const driver::WireTable& wire_;
  driver::VirtualClock& clock_;
  std::vector<Sent> script_;
  std::size_t next_ = 0;
  int writes_ = 0;
};

WireTiming timing_of(const std::vector<Sent>& script) {
  const driver::WireTable wire = numbered_wire();
  driver::VirtualClock clock;
  ScriptedPort port(wire, clock, script);
  const std::atomic<bool> stop{false};
  const WireTiming timing = time_stream(port, wire, clock, 3, stop);
  EXPECT_EQ(port.writes(), 0);
  return timing;
}

std::vector<Sent> regular(int count, int first = 0) {
  std::vector<Sent> script;
  for (int i = 0; i < count; ++i) script.push_back({.number = (first + i) & 0xffff});
  return script;
}

TEST(WireTiming, RegularReportsHaveTheirRate) {
  const WireTiming timing = timing_of(regular(201, 65'500));
  EXPECT_EQ(timing.reports, 201u);
  EXPECT_NEAR(timing.rate, 1000, 1e-6);
  EXPECT_NEAR(timing.mean, 1e-3, 1e-12);
  EXPECT_NEAR(timing.max, 1e-3, 1e-12);
  EXPECT_EQ(timing.lost, 0u);
  EXPECT_EQ(timing.repeated, 0u);
  EXPECT_EQ(timing.damaged, 0u);
}

TEST(WireTiming, LongestIntervalIsAboveTheValueOfMost) {
  auto script = regular(301);
  script[100].after_ms = 30;
  for (const std::size_t i : {50u, 60u, 70u, 80u}) script[i].after_ms = 2;
  const WireTiming timing = timing_of(script);
  EXPECT_NEAR(timing.max, 30e-3, 1e-12);
  EXPECT_NEAR(timing.p99, 2e-3, 1e-12);
  EXPECT_NEAR(timing.mean, (295 * 1e-3 + 30e-3 + 8e-3) / 300, 1e-12);
}

TEST(WireTiming, MissingNumbersAreLost) {
  auto script = regular(100);
  script.erase(script.begin() + 40, script.begin() + 43);
  script.erase(script.begin() + 10);
  EXPECT_EQ(timing_of(script).lost, 4u);
}

TEST(WireTiming, DamagedReportIsNotLostAsWell) {
  auto script = regular(100);
  script[20].damaged = script[21].damaged = true;
  const WireTiming timing = timing_of(script);
  EXPECT_EQ(timing.damaged, 2u);
  EXPECT_EQ(timing.lost, 0u);
  EXPECT_EQ(timing.flaw.flaw, driver::WireFlaw::kCheck);
  EXPECT_EQ(timing.flaw.byte, 7);
}

TEST(WireTiming, RepeatedNumberIsNoLoss) {
  auto script = regular(100);
  for (std::size_t i = 50; i < script.size(); ++i) --script[i].number;
  const WireTiming timing = timing_of(script);
  EXPECT_EQ(timing.repeated, 1u);
  EXPECT_EQ(timing.lost, 0u);
}

TEST(WireTiming, SilentPortEndsAfterItsTime) {
  const driver::WireTable wire = numbered_wire();
  driver::VirtualClock clock;
  ScriptedPort port(wire, clock, {});
  const std::atomic<bool> stop{false};
  const WireTiming timing = time_stream(port, wire, clock, 3, stop);
  EXPECT_EQ(timing.reports, 0u);
  EXPECT_NEAR(1e-9 * static_cast<double>(clock.now_ns()), 3, 0.03);
}

TEST(WireTiming, StreamAtAPseudoTerminalIsMeasuredWithoutAByteSent) {
  const auto loaded = scene::load_wire(std::filesystem::path(THIMBLE_SOURCE_DIR) /
                                       "app/arms/wires/reference_serial.yaml");
  ASSERT_TRUE(loaded) << loaded.error().message;
  const driver::WireTable& wire = **loaded;
  const support::PortEnd board;
  std::atomic<bool> end{false};
  std::thread speaks([&] {
    driver::WallClock clock;
    driver::WireValues values;
    while (!end.load()) {
      std::array<std::byte, driver::kReportCapacity> bytes{};
      ++values.sequence;
      const std::size_t size = wire.report.write(values, bytes);
      board.say({reinterpret_cast<const char*>(bytes.data()), size});
      clock.sleep_until_ns(clock.now_ns() + 2'000'000);
    }
  });
  driver::WallClock clock;
  auto port = driver::open_to_listen(board.node(), wire, clock);
  ASSERT_TRUE(port) << port.error().message;
  const std::atomic<bool> stop{false};
  const WireTiming timing = time_stream(**port, wire, clock, 0.4, stop);
  port->reset();
  end.store(true);
  speaks.join();
  EXPECT_GT(timing.reports, 20u);
  EXPECT_GE(timing.mean, 1.9e-3);
  EXPECT_EQ(timing.damaged, 0u);
  EXPECT_EQ(board.hear(), "");
}

}  // namespace
}  // namespace thimble::bringup
