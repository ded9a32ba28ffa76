#pragma once

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "board/reference_program.h"
#include "firmware/core/bytes.h"
#include "firmware/core/packet.h"

namespace thimble::firmware_test {

using Report = std::array<std::uint8_t, firmware::kHidReportSize>;

/// Closes a message with its CRC.
inline std::vector<std::uint8_t> closed(std::vector<std::uint8_t> bytes) {
  std::vector<std::byte> covered(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) covered[i] = static_cast<std::byte>(bytes[i]);
  const std::uint16_t crc = HostWire::crc(covered);
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xff));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  return bytes;
}

/// Returns a drive message with the same current for all motors, A.
inline std::vector<std::uint8_t> drive(float amperes) {
  std::vector<std::uint8_t> bytes(16);
  bytes[0] = firmware::kDrive;
  bytes[1] = firmware::kWireVersion;
  for (std::size_t i = 0; i < 3; ++i) firmware::put(bytes.data() + 4 + 4 * i, amperes);
  return closed(bytes);
}

/// A program of a board with time and inputs.
class ProgramBench {
 public:
  explicit ProgramBench(device_sim::ReferenceProgram& program) : program_(program) {
    inputs.supply_mV = 24'000;
    inputs.temperature_dC = 250;
  }

  void tick() {
    time_us += 1000;
    program_.tick(inputs, time_us, report);
  }
  void send(const std::vector<std::uint8_t>& bytes) { program_.receive(bytes, time_us); }
  /// Clears old faults, and drives for 20 ticks.
  void start() {
    tick();
    send(closed({firmware::kClear, firmware::kWireVersion, 0, 0}));
    for (int i = 0; i < 20; ++i) {
      tick();
      send(drive(i < 2 ? 0.0f : 0.25f));
    }
  }
  std::uint16_t flags() const { return firmware::get<std::uint16_t>(report.data() + 20); }
  bool on() const { return program_.outputs().motors_on; }

  firmware::Inputs inputs;
  std::uint32_t time_us = 0;
  Report report{};

 private:
  device_sim::ReferenceProgram& program_;
};

/// Causes each fault once, and checks that it switches the motors off and reports its own flag.
inline void check_every_flag(device_sim::ReferenceProgram& program) {
  struct Cause {
    firmware::Flag flag;
    void (*begin)(ProgramBench&);
  };
  const Cause causes[] = {
      {firmware::kWatchdog,
       [](ProgramBench& bench) {
         for (int i = 0; i < 50; ++i) bench.tick();
       }},
      {firmware::kOverSpeed, [](ProgramBench& bench) { bench.inputs.counts[2] -= 100'000; }},
      {firmware::kOverTemperature, [](ProgramBench& bench) { bench.inputs.temperature_dC = 801; }},
      {firmware::kBrownOut, [](ProgramBench& bench) { bench.inputs.supply_mV = 11'999; }},
      {firmware::kEncoder, [](ProgramBench& bench) { bench.inputs.encoder_error = true; }},
      {firmware::kBadCommand,
       [](ProgramBench& bench) { bench.send(drive(std::numeric_limits<float>::quiet_NaN())); }},
      {firmware::kLateLoop, [](ProgramBench& bench) { bench.time_us += 4001; }},
  };
  ProgramBench bench(program);
  for (const Cause& cause : causes) {
    bench.start();
    EXPECT_TRUE(bench.on()) << cause.flag;
    EXPECT_EQ(bench.flags(), 0) << cause.flag;
    const firmware::Inputs healthy = bench.inputs;
    cause.begin(bench);
    bench.tick();
    EXPECT_FALSE(bench.on()) << cause.flag;
    EXPECT_EQ(bench.flags(), cause.flag);
    const std::int32_t counts = bench.inputs.counts[2];
    bench.inputs = healthy;
    bench.inputs.counts[2] = counts;
    for (int i = 0; i < 10; ++i) bench.tick();
    EXPECT_EQ(bench.flags(), cause.flag) << "not latched";
  }
}

}  // namespace thimble::firmware_test
