#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "share/shared_reader.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Where a scene with its knobs as they are is written.
struct KnobsFile {
  std::filesystem::path file;  ///< A new file; empty: the run chooses a name beside the scene's.
  bool over = false;           ///< Over the scene's own file, which is the user's.
};

/// A scene that was written.
struct THIMBLE_EXPORT SavedKnobs {
  std::filesystem::path file;
  std::vector<std::string> written;  ///< "ball: stiffness = 300 N/m"
  std::vector<std::string> absent;   ///< Knobs that were turned and have no key in the file.

  /// Returns what a person is told, in a line or two.
  std::string text() const;
};

/// Writes the file of a run's scene with the knobs that viewers have turned as they are now:
/// comments and all else stay. Beside the scene's file, under a new name; the copy of a scene that
/// came with Thimble goes to the user's own scenes. What is written is read once before it takes
/// its name. The error says what to do: no knob was turned, a file is there already, the scene came
/// with Thimble, or the values make no scene. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<SavedKnobs> save_knobs(const SharedReader& reader,
                                                     const KnobsFile& where = {});

}  // namespace thimble::session
