#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ball/ball_contact.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/object_touch.h"
#include "track/path_bounded.h"
#include "world_solid.h"

namespace thimble::render {
namespace ball_solid {

template <class Law>
struct OfBall : std::false_type {};
template <class Source, class... Stages>
struct OfBall<ContactForceLaw<PathBounded<BallContact<Source>>, Stages...>> : std::true_type {};

}  // namespace ball_solid

/// A force law of an object that is touched by a ball.
template <class Law>
concept BallLaw = ball_solid::OfBall<Law>::value;

/// WorldSolid over the force law of an object that is touched by a ball.
template <BallLaw Law>
class BallSolid final : public WorldSolid {
 public:
  /// Keeps a reference: the law must outlive the solid.
  explicit BallSolid(Law& law) noexcept : law_(law) {}

  SolidBox box() const noexcept override { return contact().source().box(); }
  double rounding() const noexcept override { return contact().source().rounding(); }
  double stiffness() const noexcept override { return law_.spring_stiffness(); }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override {
    return contact().source().inside(p_W);
  }
  bool in_solid(const Eigen::Vector3d& p_W) const noexcept override {
    return contact().source().in_solid(p_W);
  }
  SolidEntry first_entry(const Eigen::Vector3d& p_from,
                         const Eigen::Vector3d& p_to) noexcept override {
    return contact().source().first_entry(p_from, p_to);
  }
  const ContactState& begin(std::int32_t id, const Eigen::Vector3d& p_WP) noexcept override {
    contact().begin(id, p_WP);
    id_ = id;
    return contact().state();
  }
  void revive(const Eigen::Vector3d& p_WP) noexcept override { contact().begin(id_, p_WP); }
  const ContactState& follow(const Eigen::Vector3d& p_W) noexcept override {
    driver::DeviceState state;
    state.p_WT = p_W;
    const ContactState& found = contact().update(state);
    if (found.touching) id_ = found.triangle;
    return found;
  }
  bool follows_closely() const noexcept override { return true; }
  int steps() const noexcept override { return contact().steps(); }
  const ContactState& follow_closely(const ContactState&,
                                     const Eigen::Vector3d& p_W) noexcept override {
    return follow(p_W);
  }
  std::size_t holding_faces(std::array<Eigen::Vector3d, 3>& n_W) const noexcept override {
    const auto held = contact().held();
    if (held.size() < 2) return 0;
    for (std::size_t i = 0; i < held.size(); ++i) n_W[i] = held[i].n_W;
    return held.size();
  }
  driver::ForceCommand feel(const driver::DeviceState& state,
                            const ContactState& felt) noexcept override {
    return law_.respond(state, felt, contact());
  }
  void leave() noexcept override { law_.respond({}, {}, contact()); }

 private:
  auto& contact() const noexcept { return law_.contact().contact(); }

  Law& law_;
  std::int32_t id_ = 0;
};

}  // namespace thimble::render
