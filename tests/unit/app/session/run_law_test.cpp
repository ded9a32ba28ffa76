// The force law of a run: its stages and their order.
#include "run_law.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "support/heap_guard.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

using Eigen::Vector3d;

/// Object that pushes with 1 N along x and counts its calls.
class Pusher final : public render::ObjectTouch {
 public:
  explicit Pusher(int& asked) : asked_(asked) {}
  driver::ForceCommand update(const driver::DeviceState&) noexcept override {
    ++asked_;
    return {.f_T_W = {1, 0, 0}, .touch = {.in_contact = true, .depth = 1e-3}};
  }
  bool inside(const Vector3d&) const noexcept override { return false; }

 private:
  int& asked_;
};

class RunLawTest : public ::testing::Test {
 protected:
  RunLawTest() : objects_(pusher()) { heavy_.carried_weight = 0.5; }

  std::vector<std::unique_ptr<render::ObjectTouch>> pusher() {
    std::vector<std::unique_ptr<render::ObjectTouch>> objects;
    objects.push_back(std::make_unique<Pusher>(asked_));
    return objects;
  }
  /// Returns the force of the first tick of a law, with the tip at rest.
  static Vector3d force_of(session::RunLaw& law) { return law.law()(driver::DeviceState()).f_T_W; }

  /// Opens an arm that has been in fault since its start.
  void open_arm_in_fault() {
    const auto scene =
        std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/scenes/plain_ball.yaml";
    auto opened = session::Session::open(scene);
    ASSERT_TRUE(opened) << opened.error().message;
    session_ = std::move(opened).value();
    session_->device().trip(driver::Fault::kOverSpeed);
  }

  int asked_ = 0;
  render::SceneTouch objects_;
  scene::ArmFile light_, heavy_;
  std::unique_ptr<session::Session> session_;
};

auto two_newton_along_y = [](const driver::DeviceState&) noexcept {
  return driver::ForceCommand{.f_T_W = {0, 2, 0}, .touch = {}};
};

TEST_F(RunLawTest, WithoutOtherStagesItIsTheForceOfTheObjects) {
  session::RunLaw law(objects_, light_);
  EXPECT_EQ(force_of(law), Vector3d(1, 0, 0));
}

TEST_F(RunLawTest, WeightIsAddedToTheForceOfTheObjects) {
  session::RunLaw law(objects_, heavy_);
  EXPECT_EQ(force_of(law), Vector3d(1, 0, 0.5));
}

TEST_F(RunLawTest, LawOfTheCallerReplacesTheObjects) {
  session::RunLaw law(objects_, light_);
  law.set_caller(driver::ForceLaw(two_newton_along_y));
  EXPECT_EQ(force_of(law), Vector3d(0, 2, 0));
  EXPECT_EQ(asked_, 0);
}

TEST_F(RunLawTest, WeightIsAddedToTheForceOfTheCaller) {
  session::RunLaw law(objects_, heavy_);
  law.set_caller(driver::ForceLaw(two_newton_along_y));
  EXPECT_EQ(force_of(law), Vector3d(0, 2, 0.5));
}

TEST_F(RunLawTest, CallerMayAskForTheForceOfTheScene) {
  session::RunLaw law(objects_, heavy_);
  const driver::ForceLaw scene = law.scene().law();
  auto twice = [&](const driver::DeviceState& state) noexcept {
    driver::ForceCommand command = scene(state);
    command.f_T_W *= 2;
    return command;
  };
  law.set_caller(driver::ForceLaw(twice));
  EXPECT_EQ(force_of(law), Vector3d(2, 0, 0.5)) << "the weight is carried once";
}

TEST_F(RunLawTest, ArmInFaultDoesNotTouchTheObjects) {
  open_arm_in_fault();
  session::RunLaw law(objects_, heavy_);
  law.stop_in_fault(session_->device());
  EXPECT_EQ(force_of(law), Vector3d(0, 0, 0.5));
  EXPECT_EQ(asked_, 0);
}

TEST_F(RunLawTest, OnlyAChangeOfTheSceneIsRecorded) {
  session::RunLaw law(objects_, light_);
  EXPECT_EQ(law.change(), nullptr);
  law.set_caller(driver::ForceLaw(two_newton_along_y));
  ASSERT_NE(law.change(), nullptr);
  EXPECT_EQ(law.change()->setting, driver::TickRecord::kOtherLaw);
}

TEST_F(RunLawTest, AllStagesTogetherDoNotUseTheHeap) {
  open_arm_in_fault();
  session::ProgramKnobs knobs(session_->scene(), objects_);
  session::RunLaw law(objects_, heavy_);
  law.scene().set_program_knobs(knobs);
  law.stop_in_fault(session_->device());
  const driver::ForceLaw whole = law.law();
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int i = 0; i < 100; ++i) whole(driver::DeviceState());
            }),
            0);
}

}  // namespace
}  // namespace thimble
