#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "solid_over.h"
#include "thimble/render/effect/live_settings.h"
#include "thimble/render/object_touch.h"
#include "world/contact_world.h"

namespace thimble::render {

/// The force law of one object of several parts, each a separate solid. The parts share one
/// proxy.
class PartsTouch final : public ObjectTouch {
 public:
  /// A part, and the number in the object's mesh of each of its triangles.
  struct Part {
    std::unique_ptr<ObjectTouch> touch;
    std::vector<std::int32_t> triangles;
  };

  /// Takes the parts, each with one solid, and the whole mesh (null if it is not in memory).
  /// Real-time: never from the servo thread.
  PartsTouch(std::vector<Part> parts, std::shared_ptr<const ContactMesh> mesh)
      : parts_(std::move(parts)), mesh_(std::move(mesh)) {
    std::vector<ContactWorld::Member> members;
    for (const Part& part : parts_) {
      numbered_.push_back(
          std::make_unique<NumberedSolid>(*part.touch->solids().front(), part.triangles));
      solids_.push_back(numbered_.back().get());
      members.push_back({.solid = solids_.back(), .object = 0});
    }
    world_ = std::make_unique<ContactWorld>(std::move(members));
  }

  /// Returns the force of the parts, for an object that is no part of a larger world: one that
  /// moves.
  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    return (*world_)(state);
  }
  void prepare(const driver::DeviceState& expected) const noexcept override {
    world_->prepare(expected);
  }
  std::span<WorldSolid* const> solids() noexcept override { return solids_; }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override {
    for (const Part& part : parts_) {
      if (part.touch->inside(p_W)) return true;
    }
    return false;
  }
  const ContactMesh* mesh() const noexcept override { return mesh_.get(); }

  /// A setting of the object sets that of all parts.
  void list_settings(LiveSettings& settings) override {
    std::vector<LiveSettings> lists;
    for (const Part& part : parts_) {
      lists.emplace_back(settings.stiffness_max(), settings.damping_max());
      part.touch->list_settings(lists.back());
    }
    for (std::size_t i = 0; i < lists.front().list().size(); ++i) {
      shared_.push_back(std::make_unique<SharedSetting>());
      for (const LiveSettings& list : lists) shared_.back()->settings.push_back(list.list()[i]);
      settings.add<set_all>(*shared_.back(), lists.front().list()[i]);
    }
  }

 private:
  // Reports the triangles of the whole mesh.
  class NumberedSolid final : public SolidOver {
   public:
    NumberedSolid(WorldSolid& part, std::span<const std::int32_t> triangles) noexcept
        : SolidOver(part), triangles_(triangles) {}
    driver::ForceCommand feel(const driver::DeviceState& state,
                              const ContactState& contact) noexcept override {
      driver::ForceCommand command = SolidOver::feel(state, contact);
      if (command.touch.feature >= 0) {
        command.touch.feature = triangles_[static_cast<std::size_t>(command.touch.feature)];
      }
      return command;
    }

   private:
    std::span<const std::int32_t> triangles_;
  };

  struct SharedSetting {
    std::vector<LiveSetting> settings;  // of all parts
  };
  static void set_all(SharedSetting& shared, double value) noexcept {
    for (const LiveSetting& setting : shared.settings) setting.set(setting.stage, value);
  }

  std::vector<Part> parts_;
  std::shared_ptr<const ContactMesh> mesh_;
  std::vector<std::unique_ptr<NumberedSolid>> numbered_;
  std::vector<WorldSolid*> solids_;
  std::unique_ptr<ContactWorld> world_;
  std::vector<std::unique_ptr<SharedSetting>> shared_;
};

}  // namespace thimble::render
