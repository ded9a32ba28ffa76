#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "figures/lost_contacts.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

TEST(SeveralObjects, EachIsTouchedWithItsOwnStiffness) {
  const auto opened = session::Session::open(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/scenes/two_boxes.yaml", {});
  ASSERT_TRUE(opened) << opened.error().message;
  session::Session& session = **opened;
  ASSERT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone);

  std::size_t ticks_on[2] = {0, 0};
  for (const auto& row : session.ticks()) {
    if (!row.in_contact) {
      EXPECT_EQ(row.object, -1);
      continue;
    }
    ASSERT_TRUE(row.object == 0 || row.object == 1);
    ++ticks_on[row.object];
    const auto& object = session.scene().objects[static_cast<std::size_t>(row.object)];
    const Eigen::Map<const Eigen::Vector3d> n(row.n_W.data()), v(row.v_WT.data()),
        f(row.f_wanted_W.data());
    const double push = object.stiffness * row.depth - object.damping * n.dot(v);
    EXPECT_LT((f - std::max(push, 0.0) * n).norm(), 1e-12) << "tick " << row.tick;
    // The left box lies at negative y, the right one at positive y.
    EXPECT_EQ(row.p_WT[1] > 0, row.object == 1);
  }
  EXPECT_GT(ticks_on[0], 300u);
  EXPECT_GT(ticks_on[1], 300u);
  EXPECT_EQ(session::count_lost_contacts(session.ticks(), session.touch()), 0u);
}

}  // namespace
}  // namespace thimble
