#include "view/start/run_again.h"

#include <algorithm>

namespace thimble::view {

std::vector<std::string> run_again_command(std::vector<std::string> words,
                                           const std::filesystem::path& scene,
                                           const std::string& name) {
  // An absolute path does not look like an option.
  if (!scene.empty()) words[1] = std::filesystem::absolute(scene).lexically_normal().string();
  words.push_back("--name=" + name);
  return words;
}

std::vector<ChangedKnob> changed_knobs(const session::SharedReader& reader) {
  std::vector<ChangedKnob> changed;
  const auto& knobs = reader.scene().knobs;
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const double value = reader.knob_wanted(i);
    if (value != knobs[i].initial) changed.push_back({knobs[i].name, value});
  }
  return changed;
}

void turn_knobs(session::SharedReader& reader, const std::vector<ChangedKnob>& knobs) {
  const auto& there = reader.scene().knobs;
  for (const ChangedKnob& knob : knobs) {
    const auto found = std::find_if(there.begin(), there.end(), [&knob](const auto& candidate) {
      return candidate.name == knob.name;
    });
    if (found == there.end()) continue;
    reader.turn_knob(static_cast<std::size_t>(found - there.begin()), knob.value);
  }
}

}  // namespace thimble::view
