#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/stroked_ring.h"
#include "studies/cost/cost_subjects.h"

namespace thimble::studies {
namespace {

// The subjects are built in, so a rejected one is a programming error.
std::unique_ptr<render::ObjectTouch> built(const CostSubject& subject) {
  return subject.build().value();
}

// Returns the force that is missing without the effect, mN RMS over the ticks of contact.
double missing(const CostSubject& with, const CostSubject& bare) {
  const auto full = built(with);
  const auto plain = built(bare);
  double squares = 0;
  int ticks = 0;
  for (const auto& state : ring_states()) {
    const Eigen::Vector3d f = full->update(state).f_T_W;
    const Eigen::Vector3d g = plain->update(state).f_T_W;
    if (!(g.norm() > 0)) continue;
    squares += (f - g).squaredNorm();
    ++ticks;
  }
  return 1e3 * std::sqrt(squares / ticks);
}

Stroke stroke_of(const CostSubject& subject) {
  const std::shared_ptr<render::ObjectTouch> touch = built(subject);
  return [touch, states = ring_states()] {
    double sum = 0;
    for (const auto& state : states) sum += touch->update(state).f_T_W.x();
    return sum;
  };
}

}  // namespace

AccuracyAxis effects_axis() {
  AccuracyAxis axis;
  axis.name = "effects";
  axis.title = "Each effect on and off: its share of the force, and its cost per tick";
  axis.metric = "force missing without the effect, RMS";
  axis.unit = "mN";
  axis.truth = "The same stroke over the same ring with the effect.";
  axis.threshold = 20;
  axis.threshold_words = "the smallest noticeable force (20 mN)";
  axis.felt_words =
      "An effect whose force is below the dashed line could be left out of this "
      "stroke unnoticed. The others can be felt.";
  axis.over_knob = false;
  axis.cost_is_added = true;
  axis.default_words =
      "Off: a scene has only the effects that it names. The cost of an effect is the "
      "time of a tick with it, minus the time of the same tick on the bare ring.";
  axis.left_out =
      "The cost of several effects, which is the sum of their costs. The Pareto "
      "front has no meaning here, because effects are not alternatives.";
  auto subjects = std::make_shared<std::vector<CostSubject>>();
  const CostSubject* bare = nullptr;
  *subjects = cost_subjects();
  for (const CostSubject& subject : *subjects) {
    if (subject.name == kBareSubject) bare = &subject;
  }
  AccuracyLine line{.name = "effects", .title = "effects", .apart = true};
  for (const CostSubject& subject : *subjects) {
    if (subject.kind != CostSubject::Kind::kEffect) continue;
    std::string name = subject.name;
    for (char& c : name) c = c == ':' ? '.' : c;
    AccuracyPoint point{.name = name,
                        .knob = NAN,
                        .error = [subjects, &subject, bare] { return missing(subject, *bare); },
                        .prepare = [subjects, &subject] { return stroke_of(subject); },
                        .baseline = [subjects, bare] { return stroke_of(*bare); }};
    const auto dot = name.find('.');
    point.title = name.substr(0, dot) + ": " + name.substr(dot + 1);
    std::replace(point.title.begin(), point.title.end(), '_', ' ');
    point.ticks = kRingTicks;
    line.points.push_back(std::move(point));
  }
  axis.lines.push_back(std::move(line));
  return axis;
}

}  // namespace thimble::studies
