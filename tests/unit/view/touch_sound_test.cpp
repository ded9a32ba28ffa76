#include "view/feedback/touch_sound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "support/scratch.h"
#include "view/feedback/wav_file.h"

namespace thimble::view {
namespace {

constexpr double kPi = std::numbers::pi;

/// Returns the ticks of a touch whose force is `force(t)` (N) and which slides at `speed` along x.
template <class Force>
std::vector<driver::TickRecord> ticks_of(double rate, double seconds, Force force,
                                         double speed = 0) {
  std::vector<driver::TickRecord> ticks(static_cast<std::size_t>(rate * seconds));
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    ticks[i].time_ns = std::llround(1e9 * static_cast<double>(i) / rate);
    const Eigen::Vector3d f = force(static_cast<double>(i) / rate);
    ticks[i].f_sent_W = {f.x(), f.y(), f.z()};
    ticks[i].n_W = {0, 0, 1};
    ticks[i].v_WT = {speed, 0, 0};
    ticks[i].in_contact = true;
  }
  return ticks;
}

std::vector<float> sound_at(double rate, const std::vector<driver::TickRecord>& ticks) {
  return sound_of(ticks, std::llround(1e9 / rate));
}

/// Returns the loudness of a frequency in the second half of a sound.
double loudness(const std::vector<float>& sound, double hertz) {
  std::complex<double> sum = 0;
  const std::size_t half = sound.size() / 2;
  for (std::size_t i = half; i < sound.size(); ++i) {
    const double turn = 2 * kPi * hertz * static_cast<double>(i) / TouchSound::kRate;
    sum += static_cast<double>(sound[i]) * std::polar(1.0, turn);
  }
  return 2 * std::abs(sum) / static_cast<double>(sound.size() - half);
}

double loudest(const std::vector<float>& sound, std::size_t from = 0) {
  double max = 0;
  for (std::size_t i = from; i < sound.size(); ++i) {
    max = std::max(max, std::abs(static_cast<double>(sound[i])));
  }
  return max;
}

TEST(TouchSound, GivesTheFrequencyOfATexture) {
  for (const double rate : {1000.0, 2000.0, 4000.0, 8000.0}) {
    const auto ticks = ticks_of(rate, 1, [](double t) {
      return Eigen::Vector3d(0, 0, 1 + 0.3 * std::sin(2 * kPi * 250 * t));
    });
    const auto sound = sound_at(rate, ticks);
    EXPECT_EQ(sound.size(), 48000U);
    const double at_250 = loudness(sound, 250);
    EXPECT_NEAR(at_250, 0.4 * 0.3, 0.01) << rate;
    // Frequencies that a step function of ticks would add: at 1 kHz 750 and 1250 Hz, with a third
    // and a fifth of the loudness.
    for (const double other : {125.0, 500.0, 750.0, 1000.0, 1250.0, 1750.0}) {
      EXPECT_LT(loudness(sound, other), 0.02 * at_250) << rate << ": " << other;
    }
  }
}

TEST(TouchSound, TangentialForceSoundsAtItsFrequency) {
  const auto ticks = ticks_of(1000, 1, [](double t) {
    return Eigen::Vector3d(0.2 * std::sin(2 * kPi * 120 * t), -0.2 * std::sin(2 * kPi * 120 * t),
                           2);
  });
  const auto sound = sound_at(1000, ticks);
  EXPECT_NEAR(loudness(sound, 120), 0.4 * 0.2 * std::numbers::sqrt2, 0.01);
  EXPECT_LT(loudness(sound, 240), 0.02 * loudness(sound, 120));
}

TEST(TouchSound, IsSilentAtRestAndForSlowForces) {
  const auto rest =
      sound_at(1000, ticks_of(1000, 1, [](double) { return Eigen::Vector3d(1, 0.5, 3); }));
  EXPECT_LT(loudest(rest, rest.size() / 2), 1e-6);
  const auto slow = sound_at(1000, ticks_of(1000, 2, [](double t) {
                               return Eigen::Vector3d(0, 0, 2 + std::sin(2 * kPi * 2 * t));
                             }));
  EXPECT_LT(loudest(slow, slow.size() / 2), 0.01);
}

TEST(TouchSound, IsExactlySilentWithoutContact) {
  auto ticks = ticks_of(
      1000, 1, [](double t) { return Eigen::Vector3d(0, 0, 1 + std::sin(2 * kPi * 200 * t)); });
  for (std::size_t i = 500; i < ticks.size(); ++i) ticks[i].in_contact = false;
  auto sound = sound_at(1000, ticks);
  EXPECT_GT(loudest(sound), 0.2);
  EXPECT_EQ(loudest(sound, 600 * 48), 0);
  for (driver::TickRecord& tick : ticks) tick.in_contact = false;
  EXPECT_EQ(loudest(sound_at(1000, ticks)), 0) << "a force without contact is silent";
}

TEST(TouchSound, NeverExceedsItsLimit) {
  const auto ticks = ticks_of(
      1000, 0.5,
      [](double t) { return Eigen::Vector3d(0, 0, std::fmod(t, 0.004) < 0.002 ? 1e4 : -1e4); },
      100);
  const auto sound = sound_at(1000, ticks);
  EXPECT_LE(loudest(sound), TouchSound::kLoudest);
  EXPECT_GT(loudest(sound), 0.9 * TouchSound::kLoudest);
}

TEST(TouchSound, ClickLoudnessFollowsSpeed) {
  double before = 0;
  for (const double speed : {0.02, 0.05, 0.1, 0.2}) {
    auto ticks = ticks_of(1000, 0.2, [](double) { return Eigen::Vector3d::Zero(); });
    ticks[0].in_contact = false;
    ticks[1].v_WT = {0, 0, -speed};
    const auto sound = sound_at(1000, ticks);
    EXPECT_GT(loudest(sound), 1.2 * before) << speed;
    EXPECT_LT(loudest(sound, sound.size() / 2), 1e-3) << "it has rung out";
    before = loudest(sound);
  }
}

TEST(TouchSound, HissesOnlyWhileFrictionSlides) {
  const auto rubbed = [](double speed) {
    const auto sound =
        sound_at(1000, ticks_of(
                           1000, 0.5, [](double) { return Eigen::Vector3d(-0.5, 0, 1); }, speed));
    return loudest(sound, sound.size() / 2);
  };
  EXPECT_LT(rubbed(0), 1e-6);
  EXPECT_GT(rubbed(0.1), 0.005);
  EXPECT_GT(rubbed(0.2), 1.1 * rubbed(0.1));
}

TEST(TouchSound, MissingTicksKeepTheTime) {
  auto ticks = ticks_of(1000, 1, [](double t) {
    return Eigen::Vector3d(0, 0, 1 + 0.1 * std::sin(2 * kPi * 100 * t));
  });
  ticks.erase(ticks.begin() + 300, ticks.begin() + 303);
  EXPECT_EQ(sound_at(1000, ticks).size(), 48000U);
  ticks[500].f_sent_W = {std::nan(""), 0, 0};
  ticks[501].v_WT = {INFINITY, 0, 0};
  ticks[501].f_sent_W = {1, 0, 1};
  ticks[502].time_ns = -5;
  for (const float x : sound_at(1000, ticks)) ASSERT_LE(std::abs(x), 0.5F);
}

TEST(TouchSound, IsEqualInOneOrSeveralParts) {
  const auto ticks = ticks_of(
      1000, 0.2, [](double t) { return Eigen::Vector3d(0.1, 0, std::sin(700 * t)); }, 0.1);
  TouchSound sound(1'000'000);
  std::vector<float> parts;
  for (const driver::TickRecord& tick : ticks) {
    std::vector<float> part;
    sound.take(tick, part);
    parts.insert(parts.end(), part.begin(), part.end());
  }
  EXPECT_EQ(parts, sound_at(1000, ticks));
}

TEST(WavFile, HasStandardFormat) {
  const std::string file = (support::scratch_folder() / "out.wav").string();
  const std::vector<float> samples{0, 0.5F, -1, 2, std::nanf("")};
  ASSERT_TRUE(write_wav(samples, 48000, file));
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_EQ(bytes.size(), 44U + 10U);
  const auto number = [&bytes](std::size_t at, std::size_t size) {
    std::uint32_t n = 0;
    for (std::size_t i = size; i-- > 0;) n = n << 8U | static_cast<std::uint8_t>(bytes[at + i]);
    return n;
  };
  EXPECT_EQ(bytes.substr(0, 4) + bytes.substr(8, 8) + bytes.substr(36, 4), "RIFFWAVEfmt data");
  EXPECT_EQ(number(4, 4), 46U);
  EXPECT_EQ(number(22, 2), 1U);
  EXPECT_EQ(number(24, 4), 48000U);
  EXPECT_EQ(number(34, 2), 16U);
  EXPECT_EQ(number(40, 4), 10U);
  EXPECT_EQ(number(46, 2), 16384U);
  EXPECT_EQ(number(48, 2), 0x8001U);
  EXPECT_EQ(number(50, 2), 0x7fffU);
  EXPECT_EQ(number(52, 2), 0U);
  const auto refused =
      write_wav(samples, 48000, (support::scratch_folder() / "no" / "out.wav").string());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("out.wav cannot be written"), std::string::npos);
}

}  // namespace
}  // namespace thimble::view
