#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "support/heap_guard.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/scene_touch.h"

// A law that prepares itself for a tick only reads: its forces are bit-identical.

namespace thimble::render {
namespace {

using Eigen::Vector3d;

struct Way {
  TrackerChoice tracker;
  bool smooth;  // whether the felt normal is blended, with curved depth
};

std::string name_of(const Way& way) {
  return std::string(kTrackerNames[static_cast<std::size_t>(way.tracker)]) +
         (way.smooth ? "_smooth" : "");
}
void PrintTo(const Way& way, std::ostream* out) {
  *out << name_of(way);
}

SceneTouch scene_of(const Way& way) {
  ContactChoice choice;
  choice.tracker = way.tracker;
  if (way.smooth) {
    choice.blending = BlendingChoice::kPhong;
    choice.curved_depth = true;
  }
  auto touch = build_object_touch(support::bumpy_sphere(4, 0.05, 0.1, 5), choice,
                                  {.spring = {.stiffness = 800, .damping = 1}});
  EXPECT_TRUE(touch) << touch.error().message;
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  objects.push_back(std::move(touch).value());
  return SceneTouch(std::move(objects));
}

// The tip of tick `i`: approaches and leaves, slowly and in jumps of several triangles.
Vector3d tip_of(std::size_t i) {
  const double t = 1e-3 * static_cast<double>(i);
  const Vector3d direction(std::sin(3 * t), std::cos(5 * t), std::sin(11 * t + 1));
  return (0.049 + 0.006 * std::sin(20 * t)) * direction.normalized();
}

class Preparation : public ::testing::TestWithParam<Way> {};

TEST_P(Preparation, ChangesNoForceWhateverTickItIsFor) {
  SceneTouch prepared = scene_of(GetParam());
  SceneTouch plain = scene_of(GetParam());
  support::Random random(3);
  std::size_t touching = 0;
  for (std::size_t i = 0; i < 3000; ++i) {
    driver::DeviceState state;
    state.dt = 1e-3;
    state.p_WT = tip_of(i);
    driver::DeviceState expected = state;
    switch (i % 4) {
      case 0:
        break;  // as predicted
      case 1:
        expected.p_WT += random.in_box(1e-3);
        break;
      case 2:
        expected.p_WT = random.in_box(0.1);  // anywhere, also deep inside
        break;
      default:
        expected.p_WT.x() = NAN;
    }
    ASSERT_EQ(support::heap_calls_of([&] { prepared.prepare(expected); }), 0);
    const driver::ForceCommand one = prepared(state), other = plain(state);
    touching += other.touch.in_contact ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(one.f_T_W[axis]),
                std::bit_cast<std::uint64_t>(other.f_T_W[axis]))
          << "tick " << i;
    }
    ASSERT_EQ(one.touch.feature, other.touch.feature) << "tick " << i;
    ASSERT_EQ(one.touch.hops, other.touch.hops) << "tick " << i;
  }
  EXPECT_GT(touching, 500u);
  EXPECT_LT(touching, 2500u);
}

INSTANTIATE_TEST_SUITE_P(OfEachTracker, Preparation,
                         ::testing::Values(Way{TrackerChoice::kEdgePlanes, false},
                                           Way{TrackerChoice::kEdgePlanes, true},
                                           Way{TrackerChoice::kNormalProjection, false},
                                           Way{TrackerChoice::kOffset, false},
                                           Way{TrackerChoice::kGodObject, false},
                                           Way{TrackerChoice::kPacked, false}),
                         [](const auto& way) { return name_of(way.param); });

}  // namespace
}  // namespace thimble::render
