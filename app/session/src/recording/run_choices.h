#pragma once

#include <optional>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::session {

/// Options of a run, in addition to scene, arm and seed, that change its result:
/// RecordingInfo::options.
struct RunChoices {
  std::string quality = "normal";     ///< Quality, one of scene::kQualityNames.
  std::optional<double> budget = {};  ///< Time per tick for "auto", ns.
  double rate_factor = 1;             ///< Factor on the loop rate of the scene.
  bool adjusted = false;              ///< True if a program changed the scene after it was read.
};

/// Returns the options as lines "key: value"; empty if all have their defaults.
std::string text_of(const RunChoices& choices);

/// Parses the options. The error names an unknown line.
driver::Result<RunChoices> run_choices(const std::string& text);

}  // namespace thimble::session
