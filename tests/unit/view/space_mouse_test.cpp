#include "view/input/space_mouse.h"

#include <gtest/gtest.h>

#include <array>

#include "support/mock/fake_hidapi.h"

namespace thimble::view {
namespace {

/// A process without any other HID device.
class SpaceMouseTest : public ::testing::Test {
 protected:
  SpaceMouseTest() { hid_ = {.listed_vendor = 0x256f, .listed_product = 0xc635}; }
  ~SpaceMouseTest() override { hid_ = {}; }

  support::FakeHidapi& hid_ = support::fake_hidapi();
};

TEST_F(SpaceMouseTest, ReadsToNewestReportAndNeverWrites) {
  constexpr std::array<unsigned char, 25> kScript{
      7, 1, 0x5e, 1, 0, 0, 0, 0,  // pushed to the right
      7, 1, 0,    0, 9, 0, 0, 0,  // and towards the user
      2, 3, 1,                    // the left button
      2, 9, 9,                    // an unknown report
      2, 2, 5};                   // incomplete
  hid_.script = kScript;
  {
    SpaceMouse mouse;
    const auto state = mouse.read();
    ASSERT_TRUE(state);
    EXPECT_EQ(state->translation, (std::array<std::int16_t, 3>{0, 9, 0}));
    EXPECT_EQ(state->buttons, 1U);
    EXPECT_EQ(mouse.trouble(), "");
    EXPECT_EQ(mouse.read(), state) << "it keeps the last state";
    EXPECT_EQ(hid_.last_timeout_ms, 0) << "drawing does not wait for it";
  }
  EXPECT_EQ(hid_.messages, 0U);
  EXPECT_EQ(hid_.open, 0) << "it is closed";
}

TEST_F(SpaceMouseTest, ErrorNamesTheRemedyIfAbsentOrUnreadable) {
  hid_.listed_product = 0xc650;  // a mouse by the same maker
  SpaceMouse none;
  EXPECT_FALSE(none.read());
  EXPECT_EQ(none.trouble(), "No SpaceMouse. Plug one in; it is detected automatically.");
  hid_.listed_product = 0xc635;
  hid_.refused = true;
  SpaceMouse refused;
  EXPECT_FALSE(refused.read());
  EXPECT_NE(refused.trouble().find("/dev/hidraw7 is not readable. Install udev/70-thimble.rules"),
            std::string::npos);
}

TEST_F(SpaceMouseTest, IsAtRestAfterUnplugging) {
  constexpr std::array<unsigned char, 8> kScript{7, 1, 0x5e, 1, 0, 0, 0, 0};
  hid_.script = kScript;
  SpaceMouse mouse;
  ASSERT_TRUE(mouse.read());
  hid_.gone = true;
  EXPECT_FALSE(mouse.read());
  EXPECT_EQ(mouse.trouble(), "The SpaceMouse was disconnected. Plug it in again.");
  EXPECT_EQ(hid_.open, 0);
}

}  // namespace
}  // namespace thimble::view
