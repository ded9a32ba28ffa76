#include "share/arm_lines.h"

#include <gtest/gtest.h>

#include "share/describe_scene.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::scene {
namespace {

TEST(ArmLines, EndAtTheTipWithConstantLengthsInEveryPose) {
  for (const char* name : {"vintage_phantom", "woodenhaptics", "polhem", "falcon"}) {
    SCOPED_TRACE(name);
    const auto arm = scene::load_arm(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" /
                                     (std::string(name) + ".yaml"));
    ASSERT_TRUE(arm) << arm.error().message;
    const session::SharedScene::Arm described = session::describe_arm(*arm, "sim");
    const Eigen::Vector3d middle = 0.5 * (arm->workspace.min_W + arm->workspace.max_W);
    std::vector<std::vector<double>> lengths;
    int poses = 0;
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3d corner(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const Eigen::Vector3d p_WT = middle + 0.01 * corner;
      const auto q = scene::joint_angles_at(*arm, p_WT);
      if (!q) continue;
      ++poses;
      driver::TickRecord tick;
      tick.q = {q->x(), q->y(), q->z()};
      tick.p_WT = {p_WT.x(), p_WT.y(), p_WT.z()};
      const auto lines = session::arm_lines(described, tick);
      EXPECT_LT((lines.front().back() - p_WT).norm(), 1e-9);
      std::vector<std::vector<double>> now;
      for (const session::ArmLine& line : lines) {
        now.emplace_back();
        for (std::size_t k = 1; k < line.size(); ++k) {
          now.back().push_back((line[k] - line[k - 1]).norm());
        }
      }
      if (lengths.empty()) lengths = now;
      // Bars are rigid. A leg of the Falcon ends at short links that are not drawn (delta_arm.h).
      const double slack = arm->is<driver::DeltaArm>() ? 0.03 : 1e-9;
      ASSERT_EQ(now.size(), lengths.size());
      for (std::size_t line = 0; line < now.size(); ++line) {
        ASSERT_EQ(now[line].size(), lengths[line].size());
        for (std::size_t k = 0; k < now[line].size(); ++k) {
          EXPECT_NEAR(now[line][k], lengths[line][k], slack) << line << ", " << k;
        }
      }
    }
    EXPECT_GT(poses, 20);
  }
}

}  // namespace
}  // namespace thimble::scene
