#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/effect/live_settings.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

class SurfaceMap;

/// A height over a surface by a picture on its texture coordinates, for drawing.
struct HeightOfStage {
  std::shared_ptr<const SurfaceMap> map;  ///< Null: the stage has no such height.
  double height = 0;                      ///< Height at black below that at white, m.
};

/// Type-erased surface stage, for stages selected by a scene.
class THIMBLE_EXPORT AnyStage {
 public:
  AnyStage() = default;
  AnyStage(const AnyStage&) = delete;
  AnyStage& operator=(const AnyStage&) = delete;
  virtual ~AnyStage() = default;

  /// See SurfaceStage. Real-time: safe.
  virtual void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept = 0;
  virtual void leave() noexcept = 0;
  /// Returns whether the stage is a ClosestPointStage, which must be run by `touch_at`.
  virtual bool needs_closest_point() const noexcept;
  /// Former name of `needs_closest_point`, which calls it: programs may still override it.
  [[deprecated("renamed to needs_closest_point")]] virtual bool needs_foot() const noexcept {
    return false;
  }
  /// Returns the stiffness of the surface's spring, N/m; 0 for other stages. Real-time: safe.
  virtual double spring_stiffness() const noexcept { return 0; }
  /// See ClosestPointStage; other stages run `touch`. Real-time: safe.
  virtual void touch_at(const ClosestSurfacePoint&, const driver::DeviceState& state,
                        SurfaceResponse& response) noexcept {
    touch(state, response);
  }
  /// See LiveSettings. Real-time: never from the servo thread.
  virtual void list_settings(LiveSettings& settings) = 0;
  /// Returns the height that the stage makes felt, if it is a map. Real-time: never from the servo
  /// thread.
  virtual HeightOfStage drawn_height() const { return {}; }
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
inline bool AnyStage::needs_closest_point() const noexcept {
  return needs_foot();
}
#pragma GCC diagnostic pop

/// AnyStage that wraps a surface stage.
template <SurfaceStage Stage>
class AnyStageOf final : public AnyStage {
 public:
  explicit AnyStageOf(Stage stage) : stage_(std::move(stage)) {}

  void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept override {
    stage_.touch(state, response);
  }
  void leave() noexcept override { stage_.leave(); }
  bool needs_closest_point() const noexcept override { return ClosestPointStage<Stage>; }
  bool needs_foot() const noexcept override { return ClosestPointStage<Stage>; }  // deprecated
  double spring_stiffness() const noexcept override {
    if constexpr (requires { stage_.spring_stiffness(); }) return stage_.spring_stiffness();
    return 0;
  }
  void touch_at(const ClosestSurfacePoint& closest, const driver::DeviceState& state,
                SurfaceResponse& response) noexcept override {
    if constexpr (ClosestPointStage<Stage>) {
      stage_.touch_at(closest, state, response);
    } else {
      stage_.touch(state, response);
    }
  }
  void list_settings(LiveSettings& settings) override {
    if constexpr (requires { Stage::kGroup; }) settings.set_group(Stage::kGroup);
    list_settings_of(stage_, settings);
    settings.set_group({});
  }

  HeightOfStage drawn_height() const override {
    if constexpr (requires { HeightOfStage{stage_.map(), stage_.height()}; }) {
      return {stage_.map(), stage_.height()};
    }
    return {};
  }

  const Stage& stage() const noexcept { return stage_; }

 private:
  Stage stage_;
};

/// Surface stage that runs the stages of a scene in order, with one indirect call each.
class StageList {
 public:
  explicit StageList(std::vector<std::unique_ptr<AnyStage>> stages) : stages_(std::move(stages)) {}

  void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept {
    for (const auto& stage : stages_) stage->touch(state, response);
  }
  void leave() noexcept {
    for (const auto& stage : stages_) stage->leave();
  }
  void list_settings(LiveSettings& settings) {
    for (const auto& stage : stages_) stage->list_settings(settings);
  }

  /// Returns the stiffness of the surface's spring, N/m. Real-time: safe.
  double spring_stiffness() const noexcept {
    double stiffness = 0;
    for (const auto& stage : stages_) stiffness += stage->spring_stiffness();
    return stiffness;
  }

  /// Returns whether any stage is a ClosestPointStage; if so, use a ClosestPointStageList.
  bool needs_closest_point() const noexcept {
    return std::any_of(stages_.begin(), stages_.end(),
                       [](const auto& stage) { return stage->needs_closest_point(); });
  }
  /// Former name of `needs_closest_point`.
  [[deprecated("renamed to needs_closest_point")]] bool needs_foot() const noexcept {
    return needs_closest_point();
  }

 protected:
  std::vector<std::unique_ptr<AnyStage>> stages_;  ///< Stages in the order of execution.
};

/// StageList with textures: a ClosestPointStage whose closest point never jumps.
class ClosestPointStageList : public StageList {
 public:
  explicit ClosestPointStageList(StageList stages) : StageList(std::move(stages)) {}

  /// Runs the stages at the given closest point, or behind it if it jumped. Real-time: safe.
  void touch_at(const ClosestSurfacePoint& found, const driver::DeviceState& state,
                SurfaceResponse& response) noexcept {
    const ClosestSurfacePoint closest = place_.follow(state.p_WT, response.contact.depth, found);
    for (const auto& stage : stages_) stage->touch_at(closest, state, response);
  }
  void leave() noexcept {
    place_.leave();
    StageList::leave();
  }

 private:
  ClosestPointFollower place_;
};

/// Former name of ClosestPointStageList.
using FootStageList [[deprecated("renamed to ClosestPointStageList")]] = ClosestPointStageList;

}  // namespace thimble::render
