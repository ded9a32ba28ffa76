#include "share/program_knobs.h"

#include "share/turn_knob.h"

namespace thimble::session {

ProgramKnobs::ProgramKnobs(const scene::Scene& scene, render::SceneTouch& touch)
    : knobs_(scene, touch), described_(knobs_.described()), states_(described_.size()) {
  for (std::size_t i = 0; i < described_.size(); ++i) {
    states_[i].wanted.store(described_[i].initial);
    states_[i].now.store(described_[i].initial);
  }
}

std::vector<Knob> ProgramKnobs::list() const {
  std::vector<Knob> list;
  for (std::size_t i = 0; i < described_.size(); ++i) {
    const SharedScene::Knob& knob = described_[i];
    list.push_back(
        {knob.name, knob.unit, knob.min, knob.max, states_[i].now.load(std::memory_order_relaxed)});
  }
  return list;
}

driver::Result<void> ProgramKnobs::turn(const std::string& name, double value) {
  const auto knob = find_knob(described_, name, value);
  if (!knob) return knob.error();
  states_[*knob].wanted.store(value, std::memory_order_relaxed);
  asked_.store(true, std::memory_order_release);
  return {};
}

std::optional<double> ProgramKnobs::knob_wanted(std::size_t knob) const noexcept {
  return states_[knob].wanted.load(std::memory_order_relaxed);
}

void ProgramKnobs::move_knobs(double dt) noexcept {
  turning_ = knobs_.step(*this, last_, dt);
  change_ = knobs_.change();
}

}  // namespace thimble::session
