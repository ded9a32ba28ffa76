#include "studies/integrators/poked_body.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "body/spring/modal_motion.h"

namespace thimble::studies {
namespace {

// Reads the touched node so that the compiler cannot remove the read.
template <int kDof>
void keep(const render::SpringMotion<kDof>& motion, std::int32_t node) {
  volatile double seen = motion.u()[static_cast<std::size_t>(node)][0];
  static_cast<void>(seen);
}
template <int kDof>
void keep(const render::ModalMotion<kDof>& motion, std::int32_t node) {
  volatile double seen = motion.u(node)[0];
  static_cast<void>(seen);
}

// Other load of the machine adds even to the CPU time of this thread, so the minimum of several
// runs is taken; slow methods run once.
constexpr int kRuns = 9;
constexpr double kRunsBudget = 0.2;  // s

// Returns the CPU time of this thread, s: other load does not count.
double worked() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Advances by a frame and reads the touched node, like a tick of touch.
template <class Motion, class Vector>
void frame_of(Motion& motion, std::int32_t poked, const Vector& force, bool poke) {
  if (poke) motion.push(poked, force);
  motion.step();
  keep(motion, poked);
}

// Computes the largest error against the truth.
template <int kDof>
class Compared {
 public:
  explicit Compared(const PokedBody<kDof>& body) : body_(body) {}

  template <class At>
  void look(int frame, At&& at) {
    const auto& truth = body_.truth[static_cast<std::size_t>(frame)];
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double off = (at(i) - truth[i]).norm();
      // NaN counts as diverged.
      if (!(off < kFar)) diverged_ = true;
      error_ = std::max(error_, off);
      size_ = std::max(size_, truth[i].norm());
    }
  }
  void set_errors(WorkPoint& point) const {
    point.error = error_ / size_;
    point.diverged = diverged_ || !(point.error < 10);
  }

 private:
  static constexpr double kFar = 1e3;  // m
  const PokedBody<kDof>& body_;
  double error_ = 0;
  double size_ = std::numeric_limits<double>::min();
  bool diverged_ = false;
};

// Runs a copy of `rest` with `look` as observer, then others for the minimum time per frame.
template <class Motion, class Vector, class Look>
double min_frame_us(const Motion& rest, std::int32_t poked, const Vector& force, int poke_frames,
                    int frames, Look&& look) {
  Motion seen = rest;
  double min = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const double begin = worked();
    frame_of(seen, poked, force, frame < poke_frames);
    min += worked() - begin;
    look(seen, frame);
  }
  double spent = min;
  for (int i = 1; i < kRuns && spent < kRunsBudget; ++i) {
    Motion unseen = rest;
    const double begin = worked();
    for (int frame = 0; frame < frames; ++frame) {
      frame_of(unseen, poked, force, frame < poke_frames);
    }
    const double seconds = worked() - begin;
    spent += seconds;
    min = std::min(min, seconds);
  }
  return min * 1e6 / frames;
}

}  // namespace

template <int kDof>
driver::Result<render::SpringMotion<kDof>> motion_of(const PokedBody<kDof>& body,
                                                     render::SpringScheme scheme, int substeps) {
  render::SpringMotionOptions options;
  options.scheme = scheme;
  options.step = kFrame;
  options.substeps = substeps;
  options.substeps_max = substeps;
  options.beyond = render::SpringMotionOptions::Beyond::kAllow;
  return render::SpringMotion<kDof>::build(body.network, options);
}

template <int kDof>
driver::Result<WorkPoint> measure(const PokedBody<kDof>& body, render::SpringScheme scheme,
                                  int substeps) {
  const auto built = motion_of(body, scheme, substeps);
  if (!built) return built.error();
  WorkPoint point{std::string(render::name_of(scheme)), substeps};
  Compared<kDof> compared(body);
  point.frame_us =
      min_frame_us(*built, body.poked, body.force, body.poke_frames,
                   static_cast<int>(body.truth.size()), [&](const auto& motion, int frame) {
                     compared.look(frame, [&](std::size_t i) { return motion.u()[i]; });
                   });
  compared.set_errors(point);
  return point;
}

template <int kDof>
driver::Result<WorkPoint> measure_modal(const PokedBody<kDof>& body) {
  const auto built = render::ModalMotion<kDof>::build(body.network, kFrame);
  if (!built) return built.error();
  WorkPoint point{std::string(render::name_of(render::SpringScheme::kModal)), 1};
  Compared<kDof> compared(body);
  point.frame_us = min_frame_us(
      *built, body.poked, body.force, body.poke_frames, static_cast<int>(body.truth.size()),
      [&](const auto& motion, int frame) {
        compared.look(frame, [&](std::size_t i) { return motion.u(static_cast<std::int32_t>(i)); });
      });
  compared.set_errors(point);
  return point;
}

template driver::Result<render::SpringMotion<1>> motion_of<1>(const PokedBody<1>&,
                                                              render::SpringScheme, int);
template driver::Result<render::SpringMotion<3>> motion_of<3>(const PokedBody<3>&,
                                                              render::SpringScheme, int);
template driver::Result<WorkPoint> measure<1>(const PokedBody<1>&, render::SpringScheme, int);
template driver::Result<WorkPoint> measure<3>(const PokedBody<3>&, render::SpringScheme, int);
template driver::Result<WorkPoint> measure_modal<1>(const PokedBody<1>&);
template driver::Result<WorkPoint> measure_modal<3>(const PokedBody<3>&);

}  // namespace thimble::studies
