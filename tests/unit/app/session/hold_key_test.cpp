#include "hold_key.h"

#include <gtest/gtest.h>

#include <string>

#include "support/refuses.h"

namespace thimble::session {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(HeldKey, OnePressDoesNotCount) {
  HeldKey key;
  key.press(1000 * kMs);
  EXPECT_LE(key.until_ns(), 1000 * kMs);
}

TEST(HeldKey, RepeatedKeyIsHeld) {
  // Delay and repeat interval of a desktop, a Linux console, and a slow keyboard.
  for (const std::int64_t every : {33, 40, 92, 110}) {
    HeldKey key;
    std::int64_t now = 1000 * kMs;
    key.press(now);
    now += 500 * kMs;
    for (int i = 0; i < 20; ++i, now += every * kMs) {
      if (i >= 3) {
        EXPECT_GT(key.until_ns(), now) << every;
      }
      key.press(now);
    }
  }
}

TEST(HeldKey, LapsesSoonAfterTheLastPress) {
  HeldKey key;
  for (int i = 0; i < 10; ++i) key.press((1000 + 33 * i) * kMs);
  EXPECT_EQ(key.until_ns(), (1000 + 33 * 9) * kMs + HeldKey::kLasts_ns);
}

TEST(HeldKey, SlowTypingDoesNotCount) {
  HeldKey key;
  for (int i = 0; i < 20; ++i) {
    key.press((1000 + 200 * i) * kMs);
    EXPECT_LE(key.until_ns(), (1000 + 200 * i) * kMs);
  }
}

TEST(ViewerKey, IsNotHeldWithoutAPicture) {
  ViewerKey key(7);
  key.update(7, 1000 * kMs);
  EXPECT_LE(key.until_ns(), 1000 * kMs);
}

TEST(ViewerKey, IsHeldWhilePicturesReportIt) {
  ViewerKey key(7);
  for (int i = 0; i < 100; ++i) {
    const std::int64_t now = (1000 + 16 * i) * kMs;
    key.update(8 + static_cast<std::uint64_t>(i), now);
    EXPECT_GT(key.until_ns(), now + 16 * kMs);
  }
}

TEST(ViewerKey, LapsesSoonAfterTheLastPicture) {
  ViewerKey key(7);
  key.update(8, 1000 * kMs);
  for (int i = 1; i < 100; ++i) key.update(8, (1000 + 5 * i) * kMs);
  EXPECT_EQ(key.until_ns(), 1000 * kMs + HeldKey::kLasts_ns);
}

TEST(HoldNamed, NamesButtonsAndTheKey) {
  EXPECT_FALSE(hold_named("")->named());
  EXPECT_EQ(hold_named("button")->buttons, 1);
  EXPECT_EQ(hold_named("button1")->buttons, 1);
  EXPECT_EQ(hold_named("button3")->buttons, 4);
  EXPECT_EQ(hold_named("button16")->buttons, 0x8000);
  EXPECT_FALSE(hold_named("button")->by_caller);
  EXPECT_TRUE(hold_named("key")->by_caller);
}

TEST(HoldNamed, RejectsUnknownNames) {
  for (const std::string name : {"foot", "button0", "button17", "Key", "buttons", "button 1"}) {
    EXPECT_TRUE(support::refuses(hold_named(name), "button2 to button16, or key")) << name;
  }
}

}  // namespace
}  // namespace thimble::session
