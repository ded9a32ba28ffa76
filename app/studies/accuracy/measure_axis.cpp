#include "studies/accuracy/measure_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <utility>

#include "studies/accuracy/probed_stroke.h"

namespace thimble::studies {
namespace {

// Returns the CPU time of this thread, s: other load does not count.
double worked() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Progress of a measurement, and whether to stop it.
class Course {
 public:
  explicit Course(const MeasureOptions& options) : options_(options) {}

  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }
  void advance(int steps) const {
    if (options_.advance) options_.advance(steps);
  }

 private:
  const MeasureOptions& options_;
};

constexpr int kCountSteps = 2;  // per point; counting takes longer than the rest [measured]

void measure_times(std::vector<MeasuredPoint*>& points, int rounds, const Course& course) {
  struct Timed {
    MeasuredPoint* point = nullptr;
    Stroke stroke;
    Stroke baseline = {};
    std::vector<double> ns = {};
  };
  std::vector<Timed> all;
  volatile double seen = 0;
  for (MeasuredPoint* point : points) {
    if (course.stopped()) return;
    all.push_back({point, point->point->prepare()});
    if (point->point->baseline) all.back().baseline = point->point->baseline();
    seen = seen + all.back().stroke();  // the first one fills the caches
    if (all.back().baseline) seen = seen + all.back().baseline();
  }
  for (int round = 0; round < rounds; ++round) {
    course.advance(1);
    for (Timed& timed : all) {
      if (course.stopped()) return;
      const double begin = worked();
      seen = seen + timed.stroke();
      double spent = worked() - begin;
      if (timed.baseline) {
        const double begin_baseline = worked();
        seen = seen + timed.baseline();
        spent -= worked() - begin_baseline;
      }
      timed.ns.push_back(1e9 * spent / timed.point->point->ticks);
    }
  }
  for (Timed& timed : all) {
    std::sort(timed.ns.begin(), timed.ns.end());
    const std::size_t n = timed.ns.size();
    timed.point->ns = timed.ns[n / 2];
    timed.point->ns_spread = (timed.ns[n * 3 / 4] - timed.ns[n / 4]) / 2;
  }
}

// Costs and errors within this fraction of each other count as equal.
constexpr double kAlike = 0.02;

void find_front(const std::vector<MeasuredPoint*>& points) {
  for (MeasuredPoint* point : points) {
    point->on_front = !point->diverged;
    for (const MeasuredPoint* other : points) {
      if (other == point || other->diverged || point->diverged) continue;
      const bool cheaper = other->cost() < (1 - kAlike) * point->cost();
      const bool better = other->error < (1 - kAlike) * point->error;
      const bool no_dearer = other->cost() <= point->cost();
      const bool no_worse = other->error <= point->error;
      if ((cheaper && no_worse) || (better && no_dearer)) point->on_front = false;
    }
  }
}

}  // namespace

const MeasuredPoint* MeasuredAxis::default_point() const {
  for (const MeasuredLine& line : lines) {
    for (const MeasuredPoint& point : line.points) {
      if (point.point->is_default) return &point;
    }
  }
  return nullptr;
}

const MeasuredLine* MeasuredAxis::line_of(const MeasuredPoint* point) const {
  for (const MeasuredLine& line : lines) {
    for (const MeasuredPoint& other : line.points) {
      if (&other == point) return &line;
    }
  }
  return nullptr;
}

const MeasuredPoint* MeasuredAxis::enough() const {
  const MeasuredPoint* found = nullptr;
  if (!axis.threshold) return nullptr;
  for (const MeasuredLine& line : lines) {
    for (const MeasuredPoint& point : line.points) {
      // NaN never counts as enough.
      if (point.diverged || !(point.error <= *axis.threshold)) continue;
      if (found == nullptr || point.cost() < found->cost()) found = &point;
    }
  }
  return found;
}

std::optional<double> slope_of(const std::vector<MeasuredPoint>& points) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const MeasuredPoint& point : points) {
    if (!point.point->fits || point.diverged) continue;
    if (!(point.error > 0) || !(point.point->knob > 0)) continue;
    const double x = std::log(point.point->knob);
    const double y = std::log(point.error);
    n += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  if (n < kSlopePointsMin) return std::nullopt;
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

namespace {

/// Returns an axis with its lines and points, without results.
MeasuredAxis unmeasured(AccuracyAxis axis) {
  MeasuredAxis measured;
  measured.axis = std::move(axis);
  for (const AccuracyLine& line : measured.axis.lines) {
    MeasuredLine found{.line = &line, .slope = {}, .points = {}};
    for (const AccuracyPoint& point : line.points) {
      found.points.emplace_back();
      found.points.back().point = &point;
    }
    measured.lines.push_back(std::move(found));
  }
  return measured;
}

std::vector<MeasuredPoint*> points_of(MeasuredAxis& measured) {
  std::vector<MeasuredPoint*> points;
  for (MeasuredLine& line : measured.lines) {
    for (MeasuredPoint& point : line.points) points.push_back(&point);
  }
  return points;
}

void set_error(MeasuredPoint& point, double error) {
  point.error = error;
  // NaN counts as diverged.
  point.diverged = !(std::abs(error) < 1e9);
}

void count_instructions(const std::string& axis, const std::vector<MeasuredPoint*>& points) {
  std::size_t strokes = 0;
  for (const MeasuredPoint* point : points) strokes += point->point->baseline ? 2 : 1;
  const auto counts = count_strokes(axis);
  if (!counts || counts->size() != strokes) return;
  std::size_t next = 0;
  for (MeasuredPoint* point : points) {
    double count = (*counts)[next++];
    if (point->point->baseline) count -= (*counts)[next++];
    point->instructions = count / point->point->ticks;
  }
}

/// Derives the results of the axis from the numbers of all points.
void conclude(MeasuredAxis& measured) {
  for (MeasuredLine& line : measured.lines) line.slope = slope_of(line.points);
  if (!measured.axis.given) find_front(points_of(measured));
}

}  // namespace

int steps_of(const AccuracyAxis& axis, const MeasureOptions& options) {
  int points = 0;
  for (const AccuracyLine& line : axis.lines) points += static_cast<int>(line.points.size());
  return points + options.rounds + (options.count ? kCountSteps * points : 0);
}

std::vector<double> numbers_of(const MeasuredAxis& measured) {
  std::vector<double> numbers;
  for (const MeasuredLine& line : measured.lines) {
    for (const MeasuredPoint& point : line.points) {
      numbers.insert(numbers.end(),
                     {point.error, point.ns, point.ns_spread,
                      point.instructions.value_or(std::numeric_limits<double>::quiet_NaN())});
    }
  }
  return numbers;
}

MeasuredAxis with_numbers(AccuracyAxis axis, std::span<const double> numbers) {
  MeasuredAxis measured = unmeasured(std::move(axis));
  const auto points = points_of(measured);
  measured.complete = numbers.size() == 4 * points.size();
  for (std::size_t i = 0; measured.complete && i < points.size(); ++i) {
    const auto of_point = numbers.subspan(4 * i, 4);
    set_error(*points[i], of_point[0]);
    points[i]->ns = of_point[1];
    points[i]->ns_spread = of_point[2];
    if (!std::isnan(of_point[3])) points[i]->instructions = of_point[3];
  }
  conclude(measured);
  return measured;
}

MeasuredAxis measure_axis(AccuracyAxis axis, const MeasureOptions& options) {
  MeasuredAxis measured = unmeasured(std::move(axis));
  const Course course(options);
  auto points = points_of(measured);
  for (MeasuredPoint* point : points) {
    if (course.stopped()) break;
    set_error(*point, point->point->error());
    course.advance(1);
  }
  if (options.rounds > 0 && !course.stopped()) measure_times(points, options.rounds, course);
  if (options.count && !course.stopped()) {
    count_instructions(measured.axis.name, points);
    course.advance(kCountSteps * static_cast<int>(points.size()));
  }
  measured.complete = !course.stopped();
  if (measured.complete) conclude(measured);
  return measured;
}

}  // namespace thimble::studies
