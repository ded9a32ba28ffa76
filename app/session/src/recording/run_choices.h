#pragma once

#include <optional>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::session {

/// What a run was asked for beyond scene, arm and seed, as far as it changes what the scene
/// answers: RecordingInfo::options.
struct RunChoices {
  std::string quality = "normal";     ///< One of scene::kQualityNames.
  std::optional<double> budget = {};  ///< ns per tick, of "auto".
  double rate_factor = 1;             ///< Of the loop, over the scene's.
  bool adjusted = false;              ///< A program changed the scene after it was read.
};

/// Returns them as lines "key: value"; empty if all are as they begin.
std::string text_of(const RunChoices& choices);

/// Reads them back. The error names the line that this program does not know.
driver::Result<RunChoices> run_choices(const std::string& text);

}  // namespace thimble::session
