#pragma once

#include <array>
#include <string>

#include "share/shared_reader.h"
#include "view/scene_menu.h"

namespace thimble::view {

/// One key of the window that controls the run, and its effect.
struct RunKey {
  const char* key;
  const char* does;
};
/// Listed in the help.
inline constexpr std::array kRunKeys = {RunKey{"B", "restart from the first tick"},
                                        RunKey{"N", "paused: next tick; shift: 10, ctrl: 100"},
                                        RunKey{"L", "restart when the run ends"},
                                        RunKey{"O", "another scene"},
                                        RunKey{"K", "save the knobs as a scene"}};

/// The buttons that control the run: restart, single ticks, another scene, saving the scene with
/// its knobs. Pause and speed are in the time line. A button that the run refuses (for example,
/// with a real arm) is grey and shows the reason.
class RunButtons {
 public:
  /// Draws the buttons. Call between ImGui's NewFrame and Render.
  void draw(session::SharedReader& reader);
  /// Handles a key (a GLFW_KEY_...), if it is one of these. As above: `shift` and `ctrl` are held
  /// down.
  void take_key(int key, bool shift, bool ctrl, session::SharedReader& reader);
  /// Sets whether an ended run can be started again by the window that shows it. Never applies to a
  /// run with a real arm.
  void set_can_run_again(bool can) { can_run_again_ = can; }
  /// Returns whether the run has ended and can be started again.
  bool offers_run_again(const session::SharedReader& reader) const;
  /// Returns, once, whether the user asked to start the ended run again.
  bool take_run_again();
  /// Returns the message about the last action, once; empty: none.
  std::string take_message();

 private:
  void restart(session::SharedReader& reader);
  void step(session::SharedReader& reader, bool shift, bool ctrl);
  void save(const session::SharedReader& reader);
  void keep_error(const driver::Result<void>& asked);

  SceneMenu scenes_;
  std::string message_;
  bool can_run_again_ = false;
  bool run_again_ = false;
};

/// Returns the reason why Restart is disabled; empty if it is not, apart from the end of the run.
std::string why_no_restart_now(const session::SharedReader& reader);

/// Returns the counters of the run as a line. Ticks that passed in a pause are listed separately
/// and do not count as missed.
std::string counted(const session::SharedReader::Counters& counters);

/// Shows a tooltip with the effect and the key of the last button while the mouse is over it. `why`
/// is added if the button is disabled; empty: it is enabled.
void explain(const char* what, const std::string& why = {});

}  // namespace thimble::view
