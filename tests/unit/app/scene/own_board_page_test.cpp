// The guide's page "My own board in an afternoon", step by step, with an arm for which the
// repository has no C++.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "arm/wire_bytes.h"
#include "arm/wire_section.h"
#include "bringup/wire_picture.h"
#include "support/boards/described_port.h"
#include "support/scratch.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/real_arm.h"
#include "thimble/session/session.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Returns the blocks of code of the page, with their language as the first line.
std::vector<std::string> blocks() {
  std::vector<std::string> found;
  std::istringstream page(
      support::text_of_file(fs::path(THIMBLE_SOURCE_DIR) / "app/guide/pages/own_board.md"));
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) found.push_back(line.substr(3) + '\n');
      continue;
    }
    if (inside) found.back() += line + '\n';
  }
  return found;
}

/// Returns the block that begins with a text.
std::string block(const std::string& begin) {
  for (const std::string& text : blocks()) {
    if (text.starts_with(begin)) return text.substr(text.find('\n') + 1);
  }
  ADD_FAILURE() << "the page has no block that begins with " << begin;
  return {};
}

/// Writes the arm file of step 2 and returns its path.
fs::path arm_file() {
  const fs::path file = support::scratch_folder() / "afternoon.yaml";
  std::ofstream(file) << support::phantom_with_wire("\n" + block("yaml\n"));
  return file;
}

TEST(OwnBoardPage, ArmFileIsValid) {
  const auto arm = load_arm(arm_file());
  ASSERT_TRUE(arm) << arm.error().message;
  EXPECT_EQ(arm->protocol, driver::ArmKind::kDescribed);
  ASSERT_TRUE(arm->wire);
  EXPECT_EQ(arm->wire->axes(), 3u);
}

TEST(OwnBoardPage, PictureIsThatOfTheCommand) {
  const auto wire = load_wire(arm_file());
  ASSERT_TRUE(wire) << wire.error().message;
  EXPECT_EQ(bringup::picture_of((*wire)->report, "report"), block("\nreport, 20 bytes"));
}

TEST(OwnBoardPage, CapturedBytesHaveTheValuesOfTheTable) {
  const auto wire = load_wire(arm_file());
  ASSERT_TRUE(wire) << wire.error().message;
  const std::string command = block("\nthimble wire check afternoon --capture");
  const std::size_t begin = command.find('"') + 1;
  const auto bytes = parse_wire_bytes(command.substr(begin, command.rfind('"') - begin), false);
  ASSERT_TRUE(bytes) << bytes.error().message;
  driver::WireValues values;
  const driver::WireVerdict verdict = (*wire)->report.read(bytes->bytes, values);
  ASSERT_TRUE(verdict) << driver::describe(verdict.flaw) << " at byte " << int{verdict.byte};
  EXPECT_EQ(values.encoders, (std::array{1000, -1000, 0}));
  EXPECT_EQ(values.sequence, 1);
  EXPECT_EQ(values.buttons, 0u);
  EXPECT_EQ(values.errors, 0u);
  EXPECT_EQ(values.temperature[0], 30.0F);
}

TEST(OwnBoardPage, SimulatedBoardTouchesAScene) {
  const fs::path folder = support::scratch_folder();
  arm_file();
  std::ofstream(folder / "afternoon_scene.yaml")
      << "name: afternoon\narm: afternoon.yaml\nduration: 0.6\nobjects:\n"
         "  - {name: plate, plane: {normal: [0, 0, 1]}, stiffness: 300, damping: 1}\n"
         "hand: {path: [{t: 0, at: [0, 0, 0.02]}, {t: 0.3, at: [0, 0, -0.01]}]}\n";
  auto session = session::Session::open(folder / "afternoon_scene.yaml", {});
  ASSERT_TRUE(session) << session.error().message;
  (*session)->run();
  double max_force = 0;
  for (const driver::TickRecord& tick : (*session)->ticks(0)) {
    max_force = std::max(max_force, tick.f_sent_W[2]);
  }
  EXPECT_GT(max_force, 0.5);
}

TEST(OwnBoardPage, BoardOnAPortIsOpenedAndRead) {
  const auto begin = std::chrono::steady_clock::now();
  const auto arm = load_arm(arm_file());
  ASSERT_TRUE(arm) << arm.error().message;
  auto settings = arm->simulated;
  settings.firmware.protocol = driver::ArmKind::kDescribed;
  settings.firmware.described = arm->wire;
  const Eigen::Vector3d p_BH = arm->R_WB.transpose() * (arm->workspace.middle() - arm->p_WB);
  auto simulated = device_sim::SimulatedArm::make(
      driver::model_as<driver::SerialArm>(arm->model), settings,
      device_sim::HandPath::make({{.time = 0, .p_BH = p_BH}}).value());
  ASSERT_TRUE(simulated) << simulated.error().message;
  support::PortServer server(*simulated, arm->wire);
  driver::FoundArm found;
  found.kind = driver::ArmKind::kDescribed;
  found.board = driver::BoardKind::kDescribed;
  found.vendor_id = 0x16c0;
  found.product_id = 0x0483;
  found.product = "Afternoon arm";
  found.bus = "USB serial";
  found.node = server.node();
  driver::WallClock clock;
  auto link = open_link(found, *arm, "", clock);
  ASSERT_TRUE(link) << link.error().message;
  auto device = driver::Device::open(std::move(link).value(), device_settings(*arm, 1000),
                                     clock.now_ns(), 2'000'000'000);
  ASSERT_TRUE(device) << device.error().message;
  int fresh = 0;
  for (int i = 0; i < 200; ++i) {
    const driver::DeviceState& state = (*device)->idle(clock.now_ns(), clock.now_ns() + 5'000'000);
    fresh += state.fresh ? 1 : 0;
  }
  EXPECT_GT(fresh, 100);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  std::printf("from the arm file to %d reports of the board: %.1f s\n", fresh, time.count());
}

}  // namespace
}  // namespace thimble::scene
