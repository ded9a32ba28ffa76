#pragma once

#include <spdlog/logger.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "share/shared_run.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// Logs the viewers of a run and their changes, outside of the servo loop. Real-time: never from
/// the servo thread.
class THIMBLE_EXPORT ViewerWatch {
 public:
  /// Number of steps for which a knob must be unchanged to count as set: half a second at the rate
  /// of ViewerRequestHandler. [chosen: a user who moves a slider is not done before]
  static constexpr int kSettled = 5;

  /// Constructs a watch of `shared`, which must outlive it, that writes to `log`.
  ViewerWatch(const SharedRun& shared, std::shared_ptr<spdlog::logger> log);

  /// Marks the end of a pause as already logged.
  void forget_pause() noexcept { paused_ = false; }

  /// Checks once; `now` is the start of each line (at_tick).
  void step(const std::string& now);

 private:
  struct Knob {
    double logged = 0;  // Last logged value.
    double newest = 0;  // Last value seen.
    int still = 0;      // Steps since it changed.
  };

  void watch_viewers(const std::string& now);
  void watch_knobs(const std::string& now);

  const SharedRun& shared_;
  std::shared_ptr<spdlog::logger> log_;
  std::vector<std::uint64_t> viewers_;
  std::vector<Knob> knobs_;
  bool paused_ = false;
};

}  // namespace thimble::session
