#pragma once

#include <spdlog/logger.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "share/shared_run.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// A watch over the viewers of a run at the side of the servo that logs who looks on and what they
/// change. Real-time: never from the servo thread.
class THIMBLE_EXPORT ViewerWatch {
 public:
  /// Steps for which a knob must stand still until it counts as set: half a second of `step` as
  /// often as ViewerRequestHandler does. [chosen: a person who draws at a slider is not done
  /// before]
  static constexpr int kSettled = 5;

  /// Watches what viewers do to `shared`, which must outlive it, and tells `log`.
  ViewerWatch(const SharedRun& shared, std::shared_ptr<spdlog::logger> log);

  /// Takes the end of a pause as known: it is logged already.
  void forget_pause() noexcept { paused_ = false; }

  /// Looks once; `now` is what a line begins with (at_tick).
  void step(const std::string& now);

 private:
  struct Knob {
    double told = 0;    // as the log knows it
    double newest = 0;  // as it was seen last
    int still = 0;      // steps since it changed
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
