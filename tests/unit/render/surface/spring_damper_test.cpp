#include "thimble/render/surface/spring_damper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

#include "support/meshes/shapes.h"
#include "support/seed.h"
#include "thimble/render/object_touch.h"
#include "track/mesh_contact.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

ContactState contact_at(double depth, const Vector3d& n_W) {
  ContactState contact;
  contact.touching = true;
  contact.depth = depth;
  contact.n_W = n_W;
  return contact;
}

TEST(SpringDamper, IsKxPlusBvAlongTheNormalAndNeverPulls) {
  std::mt19937_64 random(support::seed_of(1));
  std::uniform_real_distribution<double> uniform(-1, 1);
  const SpringDamper spring{1234.5, 6.7};
  int pushed = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vector3d n = Vector3d{uniform(random), uniform(random), uniform(random)}.normalized();
    driver::DeviceState state;
    state.v_WT = Vector3d{uniform(random), uniform(random), uniform(random)};
    const double depth = 0.005 * (1 + uniform(random));
    const double wanted = 1234.5 * depth - 6.7 * n.dot(state.v_WT);
    const Vector3d force = spring.force(contact_at(depth, n), state);
    EXPECT_NEAR((force - std::max(wanted, 0.0) * n).norm(), 0, 1e-12);
    EXPECT_GE(force.dot(n), 0);
    pushed += wanted > 0;
  }
  EXPECT_GT(pushed, 1000);
  EXPECT_LT(pushed, 9900);
}

TEST(SpringDamper, GivesNoForceForNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const SpringDamper spring{1000, 1};
  driver::DeviceState state;
  EXPECT_EQ(spring.force(contact_at(nan, {0, 0, 1}), state), Vector3d::Zero());
  EXPECT_EQ(spring.force(contact_at(0.001, {0, nan, 1}), state), Vector3d::Zero());
  state.v_WT.x() = nan;
  EXPECT_EQ(spring.force(contact_at(0.001, {0, 0, 1}), state), Vector3d::Zero());
}

TEST(ContactForceLaw, PushesBackWithStiffnessTimesDepthOnABox) {
  auto contact = MeshContact::build(support::box({0.05, 0.05, 0.05}));
  ASSERT_TRUE(contact.ok());
  ContactForceLaw<MeshContact, SpringDamper> touch(std::move(contact).value(),
                                                   SpringDamper{1000, 0});
  driver::DeviceState state;
  for (const double z : {0.06, 0.051, 0.049, 0.047}) {
    state.p_WT = {0.011, 0.007, z};
    const driver::ForceCommand command = touch(state);
    EXPECT_NEAR(command.f_T_W.z(), 1000 * std::max(0.05 - z, 0.0), 1e-12);
    EXPECT_EQ(command.touch.in_contact, z < 0.05);
  }
}

}  // namespace
}  // namespace thimble::render
