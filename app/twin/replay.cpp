#include "twin/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thimble::twin {
namespace {

constexpr int kStartsMax = 12;        // fits of a start
constexpr double kNear = 3e-7;        // m; a start that changes by less is final
constexpr std::size_t kSlope = 10;    // ticks to either side for a first velocity
constexpr std::size_t kSeenMin = 16;  // min. reports per window

/// Factors of 1 and of `slope` whose sum is closest to `value`, by least squares over the ticks
/// with a report. If `slope` is the time in ticks, it is a straight line.
struct Line {
  double at_begin = 0, along = 0;

  template <class Slope, class Value>
  Line(const std::vector<bool>& seen, const Slope& slope, const Value& value) {
    double n = 0, t1 = 0, t2 = 0, y1 = 0, ty = 0;
    for (std::size_t j = 0; j < seen.size(); ++j) {
      if (!seen[j]) continue;
      const double t = slope(j), y = value(j);
      n += 1, t1 += t, t2 += t * t, y1 += y, ty += t * y;
    }
    const double det = n * t2 - t1 * t1;
    if (!(det > 1e-9 * n * t2)) {
      at_begin = n > 0 ? y1 / n : 0;  // an axis that its friction stops at once
      return;
    }
    at_begin = (t2 * y1 - t1 * ty) / det;
    along = (n * ty - t1 * y1) / det;
  }
};

}  // namespace

double ReplayError::rms() const {
  return count > 0 ? std::sqrt(square / (3 * static_cast<double>(count))) : 0;
}

driver::Result<Replay> Replay::make(const TwinMotion& motion, double length) {
  const auto ticks = static_cast<std::size_t>(std::lround(length / motion.dt)) + 1;
  if (!(length > 0) || ticks < 2 * kSlope) {
    return driver::Error{
        fmt::format("A window of {:g} s is shorter than {} ticks.", length, 2 * kSlope)};
  }
  Replay made(motion, ticks);
  const auto lead = static_cast<std::size_t>(std::ceil(TwinMotion::kLead / motion.dt)) + 2;
  double time = 0;
  for (std::size_t s = 0; s < motion.stretches.size(); ++s) {
    const std::size_t size = motion.stretches[s].size();
    for (std::size_t begin = lead; begin + ticks + kSlope <= size; begin += ticks - 1) {
      made.add_window(s, begin, time + static_cast<double>(begin) * motion.dt);
    }
    time += static_cast<double>(size) * motion.dt;
  }
  if (made.windows_.empty()) {
    return driver::Error{
        fmt::format("No part of the recording has a window of {:g} s under forces without missing "
                    "ticks. Use shorter windows (--window).",
                    length)};
  }
  const double first = made.windows_.front().time;
  for (TwinWindow& window : made.windows_) window.time -= first;
  return made;
}

void Replay::add_window(std::size_t stretch, std::size_t begin, double first) {
  const std::vector<TwinSample>& samples = motion_->stretches[stretch];
  TwinWindow window{.stretch = stretch, .begin = begin, .time = first};
  window.seen.resize(ticks_);
  for (std::size_t j = 0; j < ticks_; ++j) window.seen[j] = samples[begin + j].fresh;
  if (std::count(window.seen.begin(), window.seen.end(), true) <
      static_cast<std::ptrdiff_t>(kSeenMin)) {
    return;
  }
  window.motion_B.resize(3, static_cast<Eigen::Index>(ticks_));
  for (int axis = 0; axis < 3; ++axis) {
    const auto place = [&](std::size_t j) { return samples[begin + j].p_BT[axis]; };
    const auto time = [](std::size_t j) { return static_cast<double>(j); };
    const Line line(window.seen, time, place);
    for (std::size_t j = 0; j < ticks_; ++j) {
      window.motion_B(axis, static_cast<Eigen::Index>(j)) =
          place(j) - line.at_begin - time(j) * line.along;
    }
  }
  window.start.p_BT = samples[begin].p_BT;
  window.start.v_BT =
      (samples[begin + kSlope].p_BT - samples[begin - kSlope].p_BT) / (2 * kSlope * motion_->dt);
  windows_.push_back(std::move(window));
}

Eigen::Matrix3Xd Replay::replay(TwinMover& mover, TwinWindow& window,
                                Eigen::Vector3d& lowest_square) {
  const std::vector<TwinSample>& samples = motion_->stretches[window.stretch];
  const double length = static_cast<double>(ticks_) * motion_->dt;
  Eigen::Matrix3Xd best(3, static_cast<Eigen::Index>(ticks_));
  lowest_square.setConstant(HUGE_VAL);
  TwinStart start = window.start, to;
  Eigen::Vector3d share(1, 1, 1);  // of the step tried
  for (int fit = 0; fit < kStartsMax; ++fit) {
    mover.move(window.stretch, window.begin, start, seen_);
    bool nearer = true;
    for (int axis = 0; axis < 3; ++axis) {
      double sum = 0;
      for (std::size_t j = 0; j < ticks_; ++j) {
        seen_[j][axis] -= samples[window.begin + j].p_BT[axis];
        if (window.seen[j]) sum += seen_[j][axis] * seen_[j][axis];
      }
      // Written so that a motion that is not a number is never the best.
      if (!(sum < lowest_square[axis])) {
        share[axis] /= 3;
        nearer = false;
        continue;
      }
      lowest_square[axis] = sum;
      share[axis] = 1;
      window.start.p_BT[axis] = start.p_BT[axis];
      window.start.v_BT[axis] = start.v_BT[axis];
      for (std::size_t j = 0; j < ticks_; ++j) {
        best(axis, static_cast<Eigen::Index>(j)) = seen_[j][axis];
      }
      // A free tip keeps its initial motion.
      const auto time = [&](std::size_t j) { return static_cast<double>(j) * motion_->dt; };
      const Line line(window.seen, time, [&](std::size_t j) { return seen_[j][axis]; });
      to.p_BT[axis] = -line.at_begin;
      to.v_BT[axis] = -line.along;
    }
    if (!nearer) find_direction(mover, window, best, share, to);
    double moves = 0;  // m
    for (int axis = 0; axis < 3; ++axis) {
      start.p_BT[axis] = window.start.p_BT[axis] + share[axis] * to.p_BT[axis];
      start.v_BT[axis] = window.start.v_BT[axis] + share[axis] * to.v_BT[axis];
      moves += share[axis] * (std::abs(to.p_BT[axis]) + std::abs(to.v_BT[axis]) * length);
    }
    if (moves < kNear) break;
  }
  return best;
}

/// If friction holds an axis for a while, the effect of its first velocity is found by a
/// difference, once for each time that a straight line gave no improvement.
void Replay::find_direction(TwinMover& mover, const TwinWindow& window,
                            const Eigen::Matrix3Xd& best, Eigen::Vector3d& share, TwinStart& to) {
  constexpr double kFaster = 1e-4;  // m/s
  const std::vector<TwinSample>& samples = motion_->stretches[window.stretch];
  TwinStart faster = window.start;
  faster.v_BT.array() += kFaster;
  mover.move(window.stretch, window.begin, faster, seen_);
  for (int axis = 0; axis < 3; ++axis) {
    if (share[axis] > 0.9 || share[axis] < 0.3) continue;
    const auto error = [&](std::size_t j) { return best(axis, static_cast<Eigen::Index>(j)); };
    const auto slope = [&](std::size_t j) {
      return (seen_[j][axis] - samples[window.begin + j].p_BT[axis] - error(j)) / kFaster;
    };
    const Line line(window.seen, slope, error);
    to.p_BT[axis] = -line.at_begin;
    to.v_BT[axis] = -line.along;
  }
}

void Replay::settle(TwinMover& mover, TwinWindow& window) {
  Eigen::Vector3d lowest_square = Eigen::Vector3d::Constant(HUGE_VAL), square;
  const TwinStart first = window.start;
  TwinStart best = first;
  for (const double faster : {0.0, -5e-4, 5e-4, -2e-3, 2e-3}) {  // m/s
    window.start = first;
    window.start.v_BT.array() += faster;
    replay(mover, window, square);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(square[axis] < lowest_square[axis])) continue;
      lowest_square[axis] = square[axis];
      best.p_BT[axis] = window.start.p_BT[axis];
      best.v_BT[axis] = window.start.v_BT[axis];
    }
  }
  window.start = best;
}

driver::Result<ReplayError> Replay::operator()(const scene::ArmFile& file) {
  auto mover = make_twin_mover(*motion_, file);
  if (!mover) return mover.error();
  seen_.resize(ticks_);
  ReplayError replayed;
  const bool soft = (*mover)->stretches();
  if (soft) soft_.resize(windows_.size());
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    TwinWindow& window = windows_[w];
    if (!settled_ && !soft) settle(**mover, window);
    Eigen::Vector3d square;
    replayed.error_B.push_back(soft ? soft_[w](**mover, *motion_, window, square)
                                    : replay(**mover, window, square));
    replayed.square += square.sum();
    replayed.count +=
        static_cast<std::size_t>(std::count(window.seen.begin(), window.seen.end(), true));
  }
  settled_ = true;
  return replayed;
}

}  // namespace thimble::twin
