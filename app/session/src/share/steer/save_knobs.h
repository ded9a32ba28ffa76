#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "share/shared_reader.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// File to which a scene with its current knobs is written.
struct KnobsFile {
  std::filesystem::path file;  ///< New file; empty: a name chosen next to the scene's file.
  /// True to overwrite the scene's own file, which must belong to the user.
  bool over = false;
};

/// Result of saving a scene.
struct THIMBLE_EXPORT SavedKnobs {
  std::filesystem::path file;
  std::vector<std::string> written;  ///< Changed values, such as "ball: stiffness = 300 N/m".
  std::vector<std::string> absent;   ///< Changed knobs without a key in the file.

  /// Returns a message for the user, in one or two lines.
  std::string text() const;
};

/// Writes a copy of a run's scene file with the current values of the knobs that viewers have
/// changed. Comments and all other text are kept. The copy is in the same folder under a new name;
/// that of a scene shipped with Thimble is in the user's scene folder. The file is read once for
/// validation before it gets its name. The error says what to do: no knob was changed, the file
/// exists, the scene is shipped with Thimble, or the values are invalid. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT driver::Result<SavedKnobs> save_knobs(const SharedReader& reader,
                                                     const KnobsFile& where = {});

}  // namespace thimble::session
