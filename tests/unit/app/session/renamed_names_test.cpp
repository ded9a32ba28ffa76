// Deprecated names of the public headers are the same as their new names.
#include <gtest/gtest.h>

#include <concepts>
#include <filesystem>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/energy_guard.h"
#include "thimble/driver/heat_guard.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/render/effect/stage_list.h"
#include "thimble/render/object_touch.h"
#include "thimble/scene/real_arm_terms.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"

namespace thimble {
namespace {

using driver::DeviceState;
using driver::GateLimits;

/// Contact stage of an older program: its closest point is called `foot`.
struct OldContact {
  render::ContactState contact{.touching = true, .depth = 0.001, .n_W = {0, 0, 1}};
  const render::ContactState& state() const noexcept { return contact; }
  const render::ContactState& update(const DeviceState&) noexcept { return contact; }
  render::SurfaceFoot foot(const Eigen::Vector3d& p_WT) const noexcept {
    return {.p_M = p_WT + Eigen::Vector3d(7, 0, 0), .n_M = {0, 0, 1}};
  }
};

/// Contact stage without a closest point.
struct FlatContact {
  render::ContactState contact{.touching = true, .n_W = {0, 0, 1}, .p_WP = {1, 2, 3}};
  const render::ContactState& state() const noexcept { return contact; }
};

/// Texture of an older program; its force is the position at which it is evaluated.
struct OldTexture {
  void touch(const DeviceState&, render::SurfaceResponse&) noexcept {}
  void touch_at(const render::SurfaceFoot& foot, const DeviceState&,
                render::SurfaceResponse& response) noexcept {
    response.f_T_W = foot.p_M;
  }
  void leave() noexcept {}
};
static_assert(render::FootStage<OldTexture> && render::ClosestPointStage<OldTexture>);

/// Stage and object of an older program, which override the old names.
struct OldStage final : render::AnyStage {
  void touch(const DeviceState&, render::SurfaceResponse&) noexcept override {}
  void leave() noexcept override {}
  bool needs_foot() const noexcept override { return true; }
  void list_settings(render::LiveSettings&) override {}
};
struct OldObject : render::ObjectTouch {
  driver::ForceCommand update(const DeviceState&) noexcept override { return {}; }
  bool inside(const Eigen::Vector3d&) const noexcept override { return false; }
  bool stands_still() const noexcept override { return false; }
};
/// Object that overrides neither name.
struct PlainObject : render::ObjectTouch {
  driver::ForceCommand update(const DeviceState&) noexcept override { return {}; }
  bool inside(const Eigen::Vector3d&) const noexcept override { return false; }
};

static_assert(std::same_as<driver::ToldArm, driver::VendorPoseArm>);
static_assert(std::same_as<render::SurfaceFoot, render::ClosestSurfacePoint>);
static_assert(std::same_as<render::FootFollower, render::ClosestPointFollower>);
static_assert(std::same_as<render::FootStageList, render::ClosestPointStageList>);
static_assert(std::same_as<scene::RealArmTerms, scene::ArmPolicy>);
static_assert(std::same_as<scene::RealArmRequest, scene::ArmPolicyRequest>);
static_assert(GateLimits::kSoftStartLeast == GateLimits::kSoftStartMin);
static_assert(GateLimits::kRiseMost == GateLimits::kRiseMax);
static_assert(GateLimits::kRiseTimeLeast == GateLimits::kRiseTimeMin);
static_assert(GateLimits::kWatchdogMost_ns == GateLimits::kWatchdogMax_ns);
static_assert(GateLimits::kForceMost == GateLimits::kForceMax);
static_assert(GateLimits::kSpeedMost == GateLimits::kSpeedMax);
static_assert(driver::EnergyGuardSettings::kDelayMost == driver::EnergyGuardSettings::kDelayMax);
static_assert(device_sim::MotorHeatSettings::kRiseMost == device_sim::MotorHeatSettings::kRiseMax);

TEST(RenamedNames, FunctionsReturnTheSame) {
  driver::HeatSettings heat;
  heat.at_start = {0.25, 0.5, 0.125};
  const driver::HeatGuard guard(heat, {}, 0.1);
  EXPECT_EQ(guard.heat_most(), guard.max_heat());
  device_sim::DriveTrainSettings joints;
  joints.viscous = {0.1, 0, 0};
  EXPECT_TRUE(joints.has_joint_friction());
  EXPECT_EQ(joints.joints_rub(), joints.has_joint_friction());
  const FlatContact flat;
  EXPECT_EQ(render::flat_foot(flat.contact).p_M, render::flat_closest_point(flat.contact).p_M);
  EXPECT_EQ(render::foot_of(flat, {1, 1, 1}).p_M, Eigen::Vector3d(1, 2, 3));
}

TEST(RenamedNames, FootOfAContactStageIsItsClosestPoint) {
  EXPECT_EQ(render::closest_point_of(OldContact{}, {1, 2, 3}).p_M, Eigen::Vector3d(8, 2, 3));
  render::ContactForceLaw law(OldContact{}, OldTexture{});
  DeviceState state;
  state.p_WT = {1, 2, 3};
  EXPECT_EQ(law(state).f_T_W, Eigen::Vector3d(8, 2, 3));
}

TEST(RenamedNames, VirtualFunctionsOfOlderProgramsAreCalled) {
  std::vector<std::unique_ptr<render::AnyStage>> stages;
  EXPECT_FALSE(render::StageList({}).needs_closest_point());
  stages.push_back(std::make_unique<OldStage>());
  const render::StageList list(std::move(stages));
  EXPECT_TRUE(list.needs_closest_point());
  EXPECT_TRUE(list.needs_foot());
  EXPECT_TRUE(render::AnyStageOf(OldTexture{}).needs_foot());
  EXPECT_FALSE(OldObject().is_static());
  EXPECT_TRUE(PlainObject().is_static());
  EXPECT_TRUE(PlainObject().stands_still());
}

TEST(RenamedNames, ArmPolicyIsFoundAndApplied) {
  scene::RealArmRequest request;
  request.arm_file = "no_such_arm";
  const auto before = scene::terms_for({}, request);
  const auto now = scene::find_arm_policy({}, request);
  ASSERT_FALSE(before);
  ASSERT_FALSE(now);
  EXPECT_EQ(before.error().message, now.error().message);
  static_assert(std::same_as<decltype(&scene::put_on_terms), decltype(&scene::apply_arm_policy)>);
}

TEST(RenamedNames, SessionReturnsItsWarnings) {
  std::filesystem::current_path(THIMBLE_SOURCE_DIR);
  session::SessionOptions options;
  options.duration = 0.01;
  const auto opened = session::Session::open("box", options);
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(&(*opened)->told(), &(*opened)->warnings());
}

}  // namespace
}  // namespace thimble

#pragma GCC diagnostic pop
