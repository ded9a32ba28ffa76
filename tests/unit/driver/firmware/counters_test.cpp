#include "firmware/core/counters.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "firmware/core/motor_law.h"

namespace thimble::firmware::test {
namespace {

TEST(FirmwareCounters, SixteenBitsAreExtendedOverTheirWrap) {
  WideCounter counter;
  std::int32_t truth = 0;
  for (const int step : {30000, 30000, 30000, -20000, -32000, -32000, -32000, 1}) {
    truth += step;
    EXPECT_EQ(counter.take(static_cast<std::uint16_t>(truth)), truth);
  }
}

TEST(FirmwareCounters, QuadratureCountsEachEdge) {
  constexpr std::uint8_t kForward[] = {0b10, 0b11, 0b01, 0b00};
  Quadrature counter;
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(counter.take(kForward[i % 4]));
  EXPECT_EQ(counter.count(), 40);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(counter.take(kForward[(42 - i) % 4]));
  EXPECT_EQ(counter.count(), 20);
}

TEST(FirmwareCounters, QuadratureReportsMissedEdges) {
  Quadrature counter;
  EXPECT_FALSE(counter.take(0b11));
  EXPECT_EQ(counter.count(), 0);
}

std::uint16_t frame_of(std::uint16_t angle) {
  const int parity = std::popcount(angle) & 1;
  return static_cast<std::uint16_t>(angle | parity << 15);
}

TEST(FirmwareCounters, AbsoluteEncoderIsFollowedOverWholeTurns) {
  As5047 encoder;
  for (int count = 0; count < 100'000; count += 8000) {
    ASSERT_TRUE(encoder.take(frame_of(static_cast<std::uint16_t>(count & 0x3fff))));
    EXPECT_EQ(encoder.count(), count);
  }
}

TEST(FirmwareCounters, AbsoluteEncoderRefusesParityAndErrorFlag) {
  As5047 encoder;
  ASSERT_TRUE(encoder.take(frame_of(100)));
  for (int bit = 0; bit < 16; ++bit) {
    EXPECT_FALSE(encoder.take(static_cast<std::uint16_t>(frame_of(200) ^ 1 << bit))) << bit;
  }
  EXPECT_FALSE(encoder.take(frame_of(0x4000 | 200)));
  EXPECT_EQ(encoder.count(), 100);
}

TEST(FirmwareMotorLaw, VoltageCoversWindingAndInducedVoltage) {
  const VoltageMotor motor{.resistance = 2, .back_emf = 0.01f, .supply = 10};
  EXPECT_FLOAT_EQ(duty_of(motor, 1, 0), 0.2f);
  EXPECT_FLOAT_EQ(duty_of(motor, 1, 100), 0.3f);
  EXPECT_FLOAT_EQ(duty_of(motor, -9, 0), -1);
}

TEST(FirmwareMotorLaw, ReferenceCoversTheRangeOfTheAmplifier) {
  EXPECT_FLOAT_EQ(reference_of(0, 6, 0.1f, 0.9f), 0.5f);
  EXPECT_FLOAT_EQ(reference_of(6, 6, 0.1f, 0.9f), 0.9f);
  EXPECT_FLOAT_EQ(reference_of(-60, 6, 0.1f, 0.9f), 0.1f);
}

TEST(FirmwareMotorLaw, NanGivesZeroCurrent) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(duty_of({}, nan, 0), 0);
  EXPECT_FLOAT_EQ(reference_of(nan, 6, 0.1f, 0.9f), 0.5f);
}

}  // namespace
}  // namespace thimble::firmware::test
