#include "touch_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "host_wire.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_arm.h"
#include "thimble/driver/wire_link.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/hand_route.h"

namespace thimble::firmware_test {
namespace {

scene::Scene box_scene() {
  auto scene = scene::load_scene(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/box.yaml");
  if (scene) return std::move(scene).value();
  ADD_FAILURE() << scene.error().message;
  return {};
}

}  // namespace

device_sim::SimulatedArmSettings reference_settings(const scene::ArmFile& file,
                                                    device_sim::ReferenceProgram* program) {
  device_sim::SimulatedArmSettings settings = file.simulated;
  settings.firmware.protocol = file.protocol;
  settings.firmware.reference = true;
  settings.firmware.program = program;
  settings.firmware.watchdog_ns = 50'000'000;
  return settings;
}

firmware::ArmConfig box_config() {
  const scene::ArmFile file = box_scene().arms.front().arm;
  return device_sim::reference_config(file.model, reference_settings(file, nullptr).firmware);
}

TouchRig::TouchRig(device_sim::ReferenceProgram* program) : scene_(box_scene()) {
  build(program);
}

void TouchRig::build(device_sim::ReferenceProgram* program) {
  auto objects = scene::SceneObjects::build(scene_);
  ASSERT_TRUE(objects) << objects.error().message;
  objects_ = std::move(objects).value();
  const auto route = scene::plan_hand(scene_.arms.front().hand, {});
  ASSERT_TRUE(route) << route.error().message;
  std::vector<device_sim::HandPath::Point> points;
  for (const auto& [time, p_WH] : *route) {
    points.push_back({time, file().R_WB.transpose() * (p_WH - file().p_WB)});
  }
  auto arm = device_sim::SimulatedArm::make(driver::model_as<driver::SerialArm>(file().model),
                                            reference_settings(file(), program),
                                            device_sim::HandPath::make(std::move(points)).value());
  ASSERT_TRUE(arm) << arm.error().message;
  arm_ = std::make_unique<device_sim::SimulatedArm>(std::move(arm).value());
  auto transport = std::make_unique<device_sim::SimTransport>(clock_, *arm_);
  transport_ = transport.get();
  const auto model = driver::model_as<driver::SerialArm>(file().model);
  auto device = driver::Device::open(
      std::make_unique<driver::WireLink>(
          std::move(transport),
          std::make_unique<driver::WireArm<HostWire, driver::SerialArm>>(model)),
      scene::device_settings(file(), 1000), clock_.now_ns());
  ASSERT_TRUE(device) << device.error().message;
  device_ = std::move(device).value();
  ASSERT_TRUE(device_->activate());
}

TouchRig::~TouchRig() = default;

void TouchRig::tick() {
  clock_.sleep_until_ns((clock_.now_ns() / kPeriod_ns + 1) * kPeriod_ns);
  const driver::DeviceState& state = device_->read(clock_.now_ns(), clock_.now_ns());
  device_->write(objects_->touch()(state));
  force_max_ = std::max(force_max_, device_->f_sent_W().norm());
  const Eigen::Vector3d& amperes = arm_->firmware().currents();
  for (int i = 0; i < 3; ++i) {
    trace_.push_back(state.p_WT[i]);
    trace_.push_back(amperes[i]);
  }
}

void TouchRig::pass(std::int64_t time_ns) {
  clock_.sleep_until_ns(clock_.now_ns() + time_ns);
  arm_->advance_to(clock_.now_ns());
}

}  // namespace thimble::firmware_test
