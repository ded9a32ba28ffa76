#pragma once

#include <array>
#include <string>

#include "share/shared_reader.h"
#include "view/scene_menu.h"

namespace thimble::view {

/// One key of the window that concerns the run's course, and what it does.
struct RunKey {
  const char* key;
  const char* does;
};
/// For the help.
inline constexpr std::array kRunKeys = {RunKey{"B", "begin anew, from the first tick"},
                                        RunKey{"N", "paused: next tick; shift: 10, ctrl: 100"},
                                        RunKey{"L", "begin anew whenever the run ends"},
                                        RunKey{", .", "slower, faster"},
                                        RunKey{"O", "another scene"},
                                        RunKey{"K", "save the knobs as a scene"}};

/// The buttons by which a person chooses the run's course: to begin anew, by single ticks, its
/// speed, another scene, and the scene with its knobs as they are. What a run refuses (one with a
/// physical arm, say) is grey, and says why.
class RunButtons {
 public:
  /// Draws them in two lines. To be called between ImGui's NewFrame and Render.
  void draw(session::SharedReader& reader);
  /// Does what a key asks for (a GLFW_KEY_...), if it is one of these. As above: `shift` and `ctrl`
  /// are held down.
  void take_key(int key, bool shift, bool ctrl, session::SharedReader& reader);
  /// Returns what a person must be told of what was just done, once; empty: nothing.
  std::string take_told();

 private:
  void step(session::SharedReader& reader, bool shift, bool ctrl);
  void save(const session::SharedReader& reader);
  void tell(const driver::Result<void>& asked);

  SceneMenu scenes_;
  std::string told_;
};

/// Returns what the run counts, in a line: ticks that passed in a pause are told apart, and are not
/// missed.
std::string counted(const session::SharedReader::Counters& counters);

/// Says in a small box what the last button does, and its key, while the mouse rests on it. `why`
/// it does nothing now stands below; empty: it does.
void explain(const char* what, const std::string& why = {});

}  // namespace thimble::view
