// Ticks that reach the bound of a tick.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "support/tip_at.h"
#include "world/contact_world.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kStiffness = 800;

/// A half-space n . p < 0 that can be made to let go and to be met again without end.
class RestlessWall final : public WorldSolid {
 public:
  explicit RestlessWall(const Vector3d& n) : n_(n) {}

  bool restless = false;

  SolidBox box() const noexcept override { return {{-1, -1, -1}, {1, 1, 1}}; }
  double rounding() const noexcept override { return 1e-17; }
  double stiffness() const noexcept override { return kStiffness; }
  bool inside(const Vector3d& p) const noexcept override { return n_.dot(p) < 0; }
  SolidEntry first_entry(const Vector3d& from, const Vector3d& to) noexcept override {
    if (restless) return {.triangle = 0, .parameter = 0};
    const double before = n_.dot(from), after = n_.dot(to);
    if (!(before >= 0 && after < 0)) return {};
    return {.triangle = 0, .parameter = before / (before - after)};
  }
  const ContactState& begin(std::int32_t triangle, const Vector3d& p_WP) noexcept override {
    // The normal of a face in front of which the tip is.
    state_ = {.touching = true, .triangle = triangle, .n_W = restless ? Vector3d(-n_) : n_};
    state_.p_WP = p_WP;
    return state_;
  }
  void revive(const Vector3d& p_WP) noexcept override { begin(0, p_WP); }
  const ContactState& follow(const Vector3d& p) noexcept override {
    state_.depth = -n_.dot(p);
    state_.touching = !restless && state_.depth > 0;
    state_.n_W = n_;
    state_.p_WP = p + state_.depth * n_;
    return state_;
  }
  bool follows_closely() const noexcept override { return false; }
  const ContactState& follow_closely(const ContactState&, const Vector3d& p) noexcept override {
    return follow(p);
  }
  driver::ForceCommand feel(const driver::DeviceState&,
                            const ContactState& contact) noexcept override {
    driver::ForceCommand command;
    command.f_T_W = kStiffness * contact.depth * contact.n_W;
    command.touch.in_contact = true;
    return command;
  }
  void leave() noexcept override {}

 private:
  Vector3d n_;
  ContactState state_;
};

TEST(WorldUnsettled, ATickThatDoesNotSettleKeepsTheForce) {
  RestlessWall one(Vector3d::UnitX()), two(Vector3d::UnitZ());
  ContactWorld world({{.solid = &one, .object = 0}, {.solid = &two, .object = 1}});
  world(support::tip_at({0.001, 0, 0.001}));
  double before = 0;
  for (int i = 0; i < 100; ++i) {
    const double z = 0.001 - 5e-5 * i;
    one.restless = two.restless = i == 80;
    const double force = world(support::tip_at({z, 0, z})).f_T_W.norm();
    ASSERT_LE(std::abs(force - before), 5 * kStiffness * 5e-5 * std::numbers::sqrt2 + 1e-9) << i;
    before = force;
  }
  EXPECT_EQ(world.counters().unsettled, 1u);
  EXPECT_EQ(world.active_count(), 2u);
  EXPECT_GT(before, 2);
}

}  // namespace
}  // namespace thimble::render
