#include "work_account.h"

#include <gtest/gtest.h>

namespace thimble::driver {
namespace {

using Eigen::Vector3d;

/// Returns the work that was booked for a tick, J.
double work(WorkAccount& account, const Vector3d& x) {
  return account.flow(x, x, {0, 0, 0}, 0).work;
}

TEST(WorkAccount, WorkIsEffortTimesTheFollowingMotion) {
  WorkAccount account(0);
  EXPECT_EQ(work(account, {0.1, 0, 0}), 0);  // the start position is unknown
  account.sent({2, 0, 0});
  EXPECT_DOUBLE_EQ(work(account, {0.4, 1, 0}), 0.6);
  account.hold();  // the arm accepted nothing: the previous effort still acts
  EXPECT_DOUBLE_EQ(work(account, {0.5, 1, 0}), 0.2);
}

TEST(WorkAccount, DelaysAnEffortByTheDelayOfTheWire) {
  WorkAccount account(2);
  work(account, {0, 0, 0});
  account.sent({1, 0, 0});
  EXPECT_EQ(work(account, {1, 0, 0}), 0);
  account.sent({0, 0, 0});
  EXPECT_EQ(work(account, {2, 0, 0}), 0);
  account.sent({0, 0, 0});
  EXPECT_EQ(work(account, {5, 0, 0}), 3);
}

TEST(WorkAccount, BooksNoWorkAcrossARestart) {
  WorkAccount account(0);
  work(account, {0, 0, 0});
  account.sent({2, 0, 0});
  account.restart();
  const EnergyFlow first = account.flow({1, 0, 0}, {1, 0, 0}, {3, 0, 0}, 4);
  EXPECT_EQ(first.work, 0);
  EXPECT_EQ(first.move_W, Vector3d(0, 0, 0));  // displacement from before the start is not counted
  EXPECT_EQ(first.held, 0);
  EXPECT_EQ(work(account, {2, 0, 0}), 0);  // nor for an effort from before the start
}

}  // namespace
}  // namespace thimble::driver
