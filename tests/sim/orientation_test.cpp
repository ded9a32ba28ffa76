#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <string>

#include "support/run_hash.h"
#include "support/scratch.h"
#include "thimble/driver/orientation.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/recording.h"
#include "thimble/session/session.h"

// Orientation of the stylus, and each arm's own wire, through the complete chain: hand, gimbal,
// encoders, reports, driver, law, recording.

namespace thimble {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = THIMBLE_SOURCE_DIR;

std::unique_ptr<session::Session> open_arm(const std::string& arm,
                                           session::SessionOptions options) {
  options.arm_file = kSource / "app/arms" / (arm + ".yaml");
  auto opened = session::Session::open(kSource / "tests/data/scenes/two_boxes.yaml", options);
  if (!opened) {
    ADD_FAILURE() << arm << ": " << opened.error().message;
    return nullptr;
  }
  return std::move(opened).value();
}

std::uint64_t hash_of(session::Session& session) {
  EXPECT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  support::RunHash hash;
  double force = 0;
  for (const auto& row : session.ticks()) {
    hash.add(row);
    force = std::max(force, Eigen::Map<const Eigen::Vector3d>(row.f_sent_W.data()).norm());
  }
  EXPECT_GT(force, 0.1) << "nothing was touched";
  return hash.value();
}

TEST(OwnWire, WoodenHapticsKeepsItsForces) {
  const auto own = open_arm("woodenhaptics", {.duration = 2});
  const auto before = open_arm("woodenhaptics", {.duration = 2, .adjust = [](scene::Scene& scene) {
                                                   scene.arms.front().arm.protocol =
                                                       driver::ArmKind::kPolhem;
                                                 }});
  ASSERT_TRUE(own && before);
  EXPECT_EQ(hash_of(*own), hash_of(*before));
}

TEST(Orientation, PolhemGimbalChangesNoForce) {
  const auto with = open_arm("polhem", {.duration = 2});
  const auto without = open_arm("polhem", {.duration = 2, .adjust = [](scene::Scene& scene) {
                                             scene.arms.front().arm.model.gimbal.reset();
                                           }});
  ASSERT_TRUE(with && without);
  EXPECT_EQ(hash_of(*with), hash_of(*without));
  double least = 1;
  const auto rows = with->ticks();
  const Eigen::Matrix3d first = driver::rotation_of(rows.front().q_WT);
  for (const auto& row : rows) {
    const Eigen::Map<const Eigen::Vector4f> q(row.q_WT.data());
    ASSERT_NEAR(q.norm(), 1, 1e-6);
    least = std::min(least, (driver::rotation_of(row.q_WT).col(0)).dot(first.col(0)));
  }
  EXPECT_LT(least, 0.99) << "the hand turns the stylus";
  for (const auto& row : without->ticks()) ASSERT_EQ(row.q_WT, driver::TipQuaternion{});
}

TEST(Orientation, ReplayIsBitIdentical) {
  const fs::path file = support::scratch_folder() / "stylus.h5";
  session::SessionOptions options{.duration = 1};
  options.record = file;
  auto session = open_arm("polhem", options);
  ASSERT_TRUE(session);
  session->run(std::atomic<bool>{false});
  const std::vector<driver::TickRecord> rows(session->ticks().begin(), session->ticks().end());
  ASSERT_TRUE(session->end_recording());
  const auto recording = session::read_recording(file);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->ticks.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(recording->ticks[i].q_WT, rows[i].q_WT);
    ASSERT_EQ(recording->ticks[i].gimbal, rows[i].gimbal);
  }
}

}  // namespace
}  // namespace thimble
