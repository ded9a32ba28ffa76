#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "view/input/hand_input.h"
#include "view/start/card_grid.h"
#include "view/start/mesh_scene.h"
#include "view/start/start_entries.h"
#include "view/text_style.h"

namespace thimble::view {

/// What the user asked of the start window.
enum class StartRequest {
  kNone,
  kRun,        ///< Runs or plays the selected card.
  kCancel,     ///< Ends the run that is starting.
  kOpen,       ///< Opens the path in the field.
  kBrowse,     ///< Opens the dialog to choose a file.
  kMakeScene,  ///< The values of the selected mesh have changed.
  kSave,       ///< Saves the scene of the selected mesh.
};

/// The content of the page, as plain data: cards, selection, fields and messages.
struct StartModel {
  std::vector<StartGroup> groups;
  CardPlace selected;
  std::string path;                ///< Text of the path's field.
  std::optional<HandSource> hand;  ///< Input that moves the hand; empty: the path of the scene.
  MeshTouch touch;                 ///< Of the selected mesh.
  std::string save_name;           ///< Name under which its scene is saved.
  std::vector<std::string> notes;  ///< Notes of the selected mesh.
  std::string message;             ///< An error, or what was done; empty: none.
  bool message_is_error = true;
  bool starting = false;  ///< A run is started.
  bool reading = false;   ///< A mesh is read.
  bool can_browse = false;
  bool dark = false;

  /// Returns the selected card; null if there is none.
  const StartEntry* entry() const;
  /// Replaces the cards, and keeps the selected file selected if it is still there.
  void set_groups(std::vector<StartGroup> next);
  /// Selects the first card of a file; returns whether there is one.
  bool select(const std::filesystem::path& file);
};

/// Returns the input that moves the hand in a scene: that of the user, or the scene's path if the
/// scene has several arms.
std::optional<HandSource> hand_for(const StartModel& model, const StartEntry& entry);

/// The page of the start window. Real-time: never from the servo thread.
class StartPage {
 public:
  /// Returns the texture of a card; 0: none yet.
  using PictureOf = std::function<unsigned(const StartEntry&)>;

  /// Draws the page into `part`, changes the model as the user does, and returns the last request.
  /// `keys`: keys pressed since the last picture (GLFW_KEY_...). Call between ImGui's NewFrame and
  /// Render.
  StartRequest draw(const ScreenPart& part, float scale, const std::vector<int>& keys,
                    const PictureOf& picture_of, StartModel& model);

 private:
  void draw_head(StartModel& model);
  void draw_cards(const PictureOf& picture_of, StartModel& model);
  void draw_card(const StartEntry& entry, const CardGrid& grid, const CardPlace& place,
                 const PictureOf& picture_of, StartModel& model);
  void draw_choice(const PictureOf& picture_of, StartModel& model);
  void draw_main(const StartEntry* entry, const StartModel& model);
  void draw_hand(const StartEntry& entry, StartModel& model);
  void draw_mesh(StartModel& model);
  void take_keys(const std::vector<int>& keys, StartModel& model);

  StartRequest request_ = StartRequest::kNone;
  bool scroll_ = false;  // The selected card is scrolled into view.
  std::size_t columns_ = 1;
};

}  // namespace thimble::view
