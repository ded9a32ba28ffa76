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

/// Many runs of one scene side by side, in virtual time and on the caller's thread. Each has an
/// arm, a hand and a touch of its own and is, to the bit, the session of its seed alone; the scene
/// is read once, and its meshes are there once.
class THIMBLE_EXPORT SessionBatch {
 public:
  /// Opens `count` runs (> 0) of a scene, a file or a name. The first has the seed of `options`, or
  /// else the scene's; each that follows has one more. Refuses what one run alone can have: real
  /// arms, a clock of its own, real time, viewers, a recording. The error is that of Session::open,
  /// or says what is refused. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SessionBatch>> open(const std::filesystem::path& scene,
                                                            std::size_t count,
                                                            const SessionOptions& options = {
                                                                .keep = Keep::kNewest});

  /// Returns how many runs there are. Real-time: safe.
  std::size_t size() const noexcept { return runs_.size(); }
  /// Returns one of them, until it is begun anew. Real-time: safe.
  Session& run(std::size_t i) noexcept { return *runs_[i]; }
  const Session& run(std::size_t i) const noexcept { return *runs_[i]; }  ///< As above.

  /// Runs `ticks` ticks of each run that is not over, one run after the other: the more at once,
  /// the more of a run stays in the cache. Real-time: safe.
  void step(std::uint32_t ticks) noexcept;
  /// Runs `ticks[i]` ticks of run i, as far as it goes. Before the first of them its hand is led to
  /// `p_WH[i]` (W, m; Session::lead_hand) if there are any; `reached[i]`, if there are any, tells 1
  /// where the arm reaches that point, and 0 where the hand stays as it was. A run of 0 ticks is
  /// left alone, its hand too, and tells 1. Precondition: each list has `size` entries, or, but for
  /// `ticks`, none; each scene has one arm. Real-time: safe.
  void step(std::span<const std::uint32_t> ticks, std::span<const Eigen::Vector3d> p_WH = {},
            std::span<std::uint8_t> reached = {}) noexcept;

  /// Returns the newest tick of each run; as they begin (`TickRecord{}`) before the first.
  /// Real-time: safe.
  std::span<const driver::TickRecord> newest() const noexcept { return newest_; }

  /// Begins one run anew, with the scene as it was read, by this seed. The error is that of
  /// Session::open_like; the run goes on then. Real-time: never from the servo thread.
  driver::Result<void> restart(std::size_t i, std::uint64_t seed);

 private:
  SessionBatch() = default;
  void step_one(std::size_t i, std::uint32_t ticks) noexcept;

  std::unique_ptr<Session> like_;  // what the others are like; it never runs
  std::vector<std::unique_ptr<Session>> runs_;
  std::vector<driver::TickRecord> newest_;
};

}  // namespace thimble::session
