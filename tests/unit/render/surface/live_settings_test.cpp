#include "thimble/render/effect/live_settings.h"

#include <gtest/gtest.h>

#include <limits>

namespace thimble::render {
namespace {

struct Knob {
  double value = 0;
};
void turn(Knob& knob, double value) noexcept {
  knob.value = value;
}

LiveSetting setting(double least, double most, double value) {
  return {.name = "gain", .unit = "1", .min = least, .max = most, .value = value};
}

TEST(LiveSettings, ChangeTheirStage) {
  Knob one, other;
  LiveSettings settings(1000, 10);
  settings.set_group("texture");
  settings.add<turn>(one, setting(0, 2, 1));
  settings.set_group("");
  settings.add<turn>(other, setting(0, 2, 1));
  ASSERT_EQ(settings.list().size(), 2u);
  EXPECT_EQ(settings.list()[0].name, "texture gain");
  EXPECT_EQ(settings.list()[1].name, "gain");
  settings.list()[0].set(settings.list()[0].stage, 1.5);
  EXPECT_EQ(one.value, 1.5);
  EXPECT_EQ(other.value, 0);
  settings.list()[1].set(settings.list()[1].stage, 0.5);
  EXPECT_EQ(other.value, 0.5);
}

TEST(LiveSettings, BoundsIncludeTheScenesValues) {
  Knob knob;
  LiveSettings settings(1000, 10);
  settings.add<turn>(knob, setting(0, 2, 3));
  settings.add<turn>(knob, setting(0, 2, -1));
  ASSERT_EQ(settings.list().size(), 2u);
  EXPECT_EQ(settings.list()[0].min, 0);
  EXPECT_EQ(settings.list()[0].max, 3);
  EXPECT_EQ(settings.list()[1].min, -1);
  EXPECT_EQ(settings.list()[1].max, 2);
}

TEST(LiveSettings, OmitFixedSettings) {
  Knob knob;
  LiveSettings settings(1000, 10);
  settings.add<turn>(knob, setting(2, 2, 2));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  settings.add<turn>(knob, setting(nan, nan, nan));
  EXPECT_TRUE(settings.list().empty());
  LiveSettings more(1000, 10);
  more.add<turn>(knob, setting(0, 1, 1));
  settings.take(more);
  ASSERT_EQ(settings.list().size(), 1u);
  EXPECT_EQ(settings.list()[0].max, 1);
}

}  // namespace
}  // namespace thimble::render
