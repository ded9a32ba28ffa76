#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "studies/accuracy/axes/axes.h"
#include "surface/contact_transient.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::studies {
namespace {

constexpr double kTick = 1e-3;  // s
constexpr double kSpeed = 0.1;  // m/s, a tap with a finger [chosen]
constexpr int kTicks = 100;     // of a tap
constexpr int kOnset = 10;      // ticks in which hardness is judged, as the first 10 ms [chosen]
constexpr std::array kStiffnesses{100.0, 200.0, 400.0, 800.0, 1600.0};  // N/m
constexpr std::array kGains{5.0, 10.0, 20.0};                           // N s/m

/// A surface that is tapped at a constant speed.
struct TappedSurface {
  double stiffness = 0;  // N/m
  double gain = 0;       // N s/m; 0: without the effect

  /// Calls `take` with the force along the normal of each tick of a tap, N.
  template <class Take>
  void tap(Take take) const {
    render::SpringDamper spring{.stiffness = stiffness};
    render::ContactTransient transient({.gain = gain}, {.tick = kTick});
    driver::DeviceState state;
    state.dt = kTick;
    state.v_WT = {0, 0, -kSpeed};
    for (int tick = 0; tick < kTicks; ++tick) {
      render::SurfaceResponse response;
      response.contact = {.touching = true,
                          .triangle = 0,
                          .depth = kSpeed * kTick * (tick + 0.5),
                          .n_W = {0, 0, 1}};
      spring.touch(state, response);
      if (gain > 0) transient.touch(state, response);
      take(tick, response.f_T_W.z());
    }
  }

  /// Returns the felt compliance, mm/N: speed over the largest rate of the force in the onset, the
  /// inverse of the rate-hardness [Lawrence].
  double compliance() const {
    double rate = 0, before = 0;
    tap([&](int tick, double force) {
      if (tick < kOnset) rate = std::max(rate, (force - before) / kTick);
      before = force;
    });
    return 1e3 * kSpeed / rate;
  }
};

AccuracyPoint point_of(const TappedSurface& surface) {
  return {.name = fmt::format("{:g}Npm", surface.stiffness),
          .knob = surface.stiffness,
          .error = [surface] { return surface.compliance(); },
          .prepare = [surface]() -> Stroke {
            return [surface] {
              double sum = 0;
              surface.tap([&sum](int, double force) { sum += force; });
              return sum;
            };
          },
          .ticks = kTicks,
          .is_default = surface.gain == 0 && surface.stiffness == 800};
}

}  // namespace

AccuracyAxis hardness_axis() {
  AccuracyAxis axis;
  axis.name = "hardness";
  axis.title = "A tap at 0.1 m/s: stiffness of the spring, and a transient at the begin of contact";
  axis.knob = "stiffness of the surface";
  axis.knob_unit = "N/m";
  axis.metric = "felt compliance: speed over the largest rate of the force in 10 ms";
  axis.unit = "mm/N";
  axis.truth = "A rigid surface, whose force grows at once: the compliance is 0.";
  axis.threshold = kRigidCompliance;
  axis.threshold_words = kRigidWords;
  axis.default_words =
      "A scene has no transient unless it names one. A spring alone would need 24,000 N/m to feel "
      "rigid, which no arm with a 1 kHz loop renders stably.";
  axis.left_out =
      "The arm: its gate and its motors slow the rise of a force. Subjective hardness also depends "
      "on the frequency of the vibration.";
  AccuracyLine spring{.name = "spring", .title = "spring alone", .order = {}, .points = {}};
  for (const double stiffness : kStiffnesses) {
    spring.points.push_back(point_of({.stiffness = stiffness}));
  }
  axis.lines.push_back(std::move(spring));
  for (const double gain : kGains) {
    AccuracyLine line{.name = fmt::format("transient{:g}", gain),
                      .title = fmt::format("with a transient of {:g} N s/m", gain),
                      .order = {},
                      .points = {}};
    for (const double stiffness : kStiffnesses) {
      line.points.push_back(point_of({.stiffness = stiffness, .gain = gain}));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace thimble::studies
