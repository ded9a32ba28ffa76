#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "thimble/render/effect/live_settings.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Is a surface stage whose kind is known only when a scene has been read.
class AnyStage {
 public:
  AnyStage() = default;
  AnyStage(const AnyStage&) = delete;
  AnyStage& operator=(const AnyStage&) = delete;
  virtual ~AnyStage() = default;

  /// See SurfaceStage. Real-time: safe.
  virtual void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept = 0;
  virtual void leave() noexcept = 0;
  /// See LiveSettings. Real-time: never from the servo thread.
  virtual void list_settings(LiveSettings& settings) = 0;
};

/// Makes any surface stage an AnyStage.
template <SurfaceStage Stage>
class AnyStageOf final : public AnyStage {
 public:
  explicit AnyStageOf(Stage stage) : stage_(std::move(stage)) {}

  void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept override {
    stage_.touch(state, response);
  }
  void leave() noexcept override { stage_.leave(); }
  void list_settings(LiveSettings& settings) override {
    if constexpr (requires { Stage::kGroup; }) settings.set_group(Stage::kGroup);
    list_settings_of(stage_, settings);
    settings.set_group({});
  }

  const Stage& stage() const noexcept { return stage_; }

 private:
  Stage stage_;
};

/// Is a surface stage made of others, run in order: just those that a scene names, one indirect
/// call each.
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

 private:
  std::vector<std::unique_ptr<AnyStage>> stages_;
};

}  // namespace thimble::render
