#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Many runs of one scene, in virtual time and on the caller's thread. Each run has its own arm,
/// hand and contact state, and is bit-identical to a single session with its seed. The scene and
/// its meshes are loaded once.
class THIMBLE_EXPORT SessionBatch {
 public:
  /// Opens `count` runs (> 0) of a scene, given by file or name. The first run has the seed of
  /// `options`, or else that of the scene; each further seed is one larger. Fails as Session::open
  /// does. It also rejects options that only a single run supports: real arms, a custom clock, real
  /// time, viewers and a recording. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SessionBatch>> open(const std::filesystem::path& scene,
                                                            std::size_t count,
                                                            const SessionOptions& options = {
                                                                .keep = Keep::kNewest});

  /// Returns the number of runs. Real-time: safe.
  std::size_t size() const noexcept { return runs_.size(); }
  /// Returns run i; the reference is valid until the run is restarted. Real-time: safe.
  Session& run(std::size_t i) noexcept { return *runs_[i]; }
  const Session& run(std::size_t i) const noexcept { return *runs_[i]; }  ///< Const overload.

  /// Runs `ticks` ticks of each run that is not over, one run after the other. Larger values use
  /// the cache better. Real-time: safe.
  void step(std::uint32_t ticks) noexcept;
  /// Runs `ticks[i]` ticks of run i, or fewer if it ends. First moves its hand's target to
  /// `p_WH[i]` (W, m; Session::lead_hand) unless `p_WH` is empty. `reached[i]` becomes 1 if the arm
  /// reaches that point; otherwise it becomes 0 and the target is unchanged. A run with 0 ticks is
  /// not touched, its hand included, and reports 1. Precondition: each list has `size` entries, or,
  /// except for `ticks`, none; each scene has one arm. Real-time: safe.
  void step(std::span<const std::uint32_t> ticks, std::span<const Eigen::Vector3d> p_WH = {},
            std::span<std::uint8_t> reached = {}) noexcept;

  /// Returns the newest tick of each run; `TickRecord{}` before the first. Real-time: safe.
  std::span<const driver::TickRecord> newest() const noexcept { return newest_; }

  /// Restarts one run with the scene as read before and a new seed. If it fails with the error of
  /// Session::open_like, the existing run continues. Real-time: never from the servo thread.
  driver::Result<void> restart(std::size_t i, std::uint64_t seed);

 private:
  SessionBatch() = default;
  void step_one(std::size_t i, std::uint32_t ticks) noexcept;
  void list_memory(std::size_t i);

  // Cache lines that a tick of a run uses.
  struct Lines {
    const std::byte* first = nullptr;
    std::size_t count = 0;
  };
  enum class Half : std::uint8_t { kFirst, kSecond };
  void prefetch_next(std::size_t i, Half half) const noexcept;

  std::unique_ptr<Session> like_;  // Template for `open_like`; it never runs.
  std::vector<std::unique_ptr<Session>> runs_;
  std::vector<driver::TickRecord> newest_;
  // Of all runs in order, `parts_of_run_` for each.
  std::vector<Lines> lines_;
  std::size_t parts_of_run_ = 0;
};

}  // namespace thimble::session
