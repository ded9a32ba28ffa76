#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "studies/ring_pages.h"

// A tip that slides over a ring, for the measurements of meshes on disk.

namespace thimble::bench {

using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

inline constexpr studies::BumpyRing kRing;
inline constexpr double kPressed = 0.5e-3;  // m below the surface
inline constexpr double kTick = 1e-3;       // s
inline constexpr double kSpeed = 0.5;       // m/s

inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Winds around the ring in steps of equal length. The heading turns slowly, so that the tip visits
/// every place.
class Way {
 public:
  /// Moves on by one tick at `speed`, m/s, and returns the place `kPressed` below the surface.
  Vector3d next(double speed) {
    constexpr double kStep = 1e-6;
    const Vector3d along_u = (kRing.at(u_ + kStep, v_) - kRing.at(u_ - kStep, v_)) / (2 * kStep);
    const Vector3d along_v = (kRing.at(u_, v_ + kStep) - kRing.at(u_, v_ - kStep)) / (2 * kStep);
    const Vector3d heading =
        std::cos(turn_) * along_u / along_u.norm() + std::sin(turn_) * along_v / along_v.norm();
    const double step = speed * kTick / heading.norm();
    u_ += step * std::cos(turn_) / along_u.norm();
    v_ += step * std::sin(turn_) / along_v.norm();
    turn_ += 7e-4;
    return at(-kPressed);
  }
  Vector3d at(double height) const { return kRing.at(u_, v_) + height * kRing.normal(u_, v_); }

 private:
  double u_ = 0.3, v_ = 0.2, turn_ = 0.4;
};

/// Times of ticks, and what was felt in them.
struct Ticks {
  std::vector<double> ns;
  double error = 0;
  std::size_t touching = 0;

  double mean() const {
    double sum = 0;
    for (const double v : ns) sum += v;
    return sum / static_cast<double>(ns.size());
  }
  double percentile(double share) {
    std::sort(ns.begin(), ns.end());
    return ns[static_cast<std::size_t>(share * static_cast<double>(ns.size() - 1))];
  }
};

/// Asks the kernel to drop its cache of a file; it may refuse.
inline void forget(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fdatasync(descriptor);
  posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED);
  close(descriptor);
}

}  // namespace thimble::bench
