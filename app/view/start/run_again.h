#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "share/shared_reader.h"

namespace thimble::view {

/// Returns the arguments of `thimble` that start a run again: `run` with the scene that was shown
/// last, under the same name. `words` are those of the first run (`run`, scene, options).
/// Precondition: `words` has two elements or more.
std::vector<std::string> run_again_command(std::vector<std::string> words,
                                           const std::filesystem::path& scene,
                                           const std::string& name);

/// A knob that was changed in a viewer, and its requested value.
struct ChangedKnob {
  std::string name;
  double value = 0;
};

/// Returns the knobs of a run that differ from the scene. Real-time: never from the servo thread.
std::vector<ChangedKnob> changed_knobs(const session::SharedReader& reader);

/// Requests the values of another run; knobs that this run does not have are ignored. Real-time:
/// never from the servo thread.
void turn_knobs(session::SharedReader& reader, const std::vector<ChangedKnob>& knobs);

}  // namespace thimble::view
