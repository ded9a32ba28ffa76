#include "studies/cost/study_cost.h"

#include <gtest/gtest.h>

#include <set>

#include "studies/cost/cost_subjects.h"
#include "studies/cost/instruction_count.h"
#include "studies/cost/ring_surface.h"
#include "thimble/render/effect/effect_table.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

TEST(RingSurface, DepthAndNormalAreExactAlongEachApproach) {
  const RingSurface ring;
  for (const double around : {0.0, 1.0, 4.0}) {
    for (const double across : {0.0, 0.7, 2.5, 3.1}) {
      const Vector3d p = ring.at(around, across, -0.003);
      EXPECT_NEAR(ring.depth(p), 0.003, 1e-15);
      EXPECT_LT((p + 0.003 * ring.normal(p) - ring.at(around, across, 0)).norm(), 1e-15);
    }
  }
}

TEST(RingStroke, StaysBetweenItsDepthLimits) {
  const RingSurface ring;
  const auto states = ring_stroke(ring, kStrokeTicks, 0.001);
  EXPECT_LT(ring.depth(states.front().p_WT), 0);
  EXPECT_LT(ring.depth(states.back().p_WT), 0);
  double fastest = 0;
  for (std::size_t i = states.size() / 10; i < states.size() * 9 / 10; ++i) {
    EXPECT_GE(ring.depth(states[i].p_WT), 0.00049);
    EXPECT_LE(ring.depth(states[i].p_WT), 0.00151);
    fastest = std::max(fastest, states[i].v_WT.norm());
  }
  EXPECT_GT(fastest, 0.05);
  EXPECT_LT(fastest, 0.2);
}

TEST(CostSubjects, CoverEveryContactAndEffectOnce) {
  const auto states = ring_stroke(kCostRing, kStrokeTicks, 0.001);
  std::set<std::string> names;
  for (const CostSubject& subject : cost_subjects()) {
    EXPECT_TRUE(names.insert(subject.name).second) << subject.name;
    const auto touch = subject.build();
    ASSERT_TRUE(touch.ok()) << subject.name << ": " << touch.error().message;
    int touched = 0;
    for (const auto& state : states) {
      const driver::ForceCommand command = (*touch)->update(state);
      ASSERT_TRUE(command.f_T_W.allFinite()) << subject.name;
      touched += command.touch.in_contact ? 1 : 0;
    }
    EXPECT_GT(touched, kStrokeTicks * 9 / 10) << subject.name;
  }
  for (const render::EffectKind& kind : render::effect_table()) {
    EXPECT_EQ(names.count(std::string(kind.group) + ':' + std::string(kind.name)), 1U);
  }
}

}  // namespace
}  // namespace thimble::studies
