#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "world_solid.h"

namespace thimble::render {

/// WorldSolid that forwards everything to another; a base of those that add something. Keeps a
/// reference: the other must outlive it.
class SolidOver : public WorldSolid {
 public:
  /// Takes the other solid. Real-time: never from the servo thread.
  explicit SolidOver(WorldSolid& surface) noexcept : surface_(surface) {}

  SolidBox box() const noexcept override { return surface_.box(); }
  double rounding() const noexcept override { return surface_.rounding(); }
  double stiffness() const noexcept override { return surface_.stiffness(); }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override { return surface_.inside(p_W); }
  bool in_solid(const Eigen::Vector3d& p_W) const noexcept override {
    return surface_.in_solid(p_W);
  }
  bool changes() const noexcept override { return surface_.changes(); }
  bool moves() const noexcept override { return surface_.moves(); }
  SolidMove begin_tick(const driver::DeviceState& state, const Eigen::Vector3d& p_WP,
                       bool touching) noexcept override {
    return surface_.begin_tick(state, p_WP, touching);
  }
  double end_tick(const Eigen::Vector3d& p_WP, bool touching) noexcept override {
    return surface_.end_tick(p_WP, touching);
  }
  SolidEntry first_entry(const Eigen::Vector3d& p_from,
                         const Eigen::Vector3d& p_to) noexcept override {
    return surface_.first_entry(p_from, p_to);
  }
  const ContactState& begin(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept override {
    return surface_.begin(triangle, p_WP);
  }
  void revive(const Eigen::Vector3d& p_WP) noexcept override { surface_.revive(p_WP); }
  const ContactState& follow(const Eigen::Vector3d& p_W) noexcept override {
    return surface_.follow(p_W);
  }
  bool follows_closely() const noexcept override { return surface_.follows_closely(); }
  bool is_exact() const noexcept override { return surface_.is_exact(); }
  int steps() const noexcept override { return surface_.steps(); }
  const ContactState& follow_closely(const ContactState& last,
                                     const Eigen::Vector3d& p_W) noexcept override {
    return surface_.follow_closely(last, p_W);
  }
  std::size_t holding_faces(std::array<Eigen::Vector3d, 3>& n_W) const noexcept override {
    return surface_.holding_faces(n_W);
  }
  driver::ForceCommand feel(const driver::DeviceState& state,
                            const ContactState& contact) noexcept override {
    return surface_.feel(state, contact);
  }
  void leave() noexcept override { surface_.leave(); }
  void prepare(const driver::DeviceState& expected) const noexcept override {
    surface_.prepare(expected);
  }
  void prepare_fallback() override { surface_.prepare_fallback(); }

 protected:
  WorldSolid& surface() noexcept { return surface_; }              ///< Returns the other solid.
  const WorldSolid& surface() const noexcept { return surface_; }  ///< Const overload.

 private:
  WorldSolid& surface_;
};

}  // namespace thimble::render
