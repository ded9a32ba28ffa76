#include "bringup/loop_priority.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

namespace thimble::bringup {
namespace {

TEST(LateTicks, AreManyAboveOneInAThousand) {
  LateTicks ticks;
  for (int i = 0; i < 2000; ++i) ticks.count(0.0004, 0.001);
  EXPECT_EQ(ticks.late, 0u);
  for (int i = 0; i < 2; ++i) ticks.count(0.0012, 0.001);
  EXPECT_FALSE(ticks.many());
  ticks.count(0.003, 0.001);
  EXPECT_TRUE(ticks.many());
  EXPECT_EQ(ticks.worst, 0.003);
}

TEST(LoopPriority, RestoresTheFormerPriority) {
  int before = 0, after = 0;
  sched_param parameters{};
  ASSERT_EQ(pthread_getschedparam(pthread_self(), &before, &parameters), 0);
  { const LoopPriority raised(true); }
  ASSERT_EQ(pthread_getschedparam(pthread_self(), &after, &parameters), 0);
  EXPECT_EQ(after, before);
}

}  // namespace
}  // namespace thimble::bringup
