#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "view/gl/gl_objects.h"
#include "view/start/child_process.h"
#include "view/start/start_entries.h"

namespace thimble::view {

/// Returns the file of the picture that is drawn for a card, in the user's cache. Its name depends
/// on the path and the text of the scene, and on the time of a mesh that was opened; empty if the
/// scene cannot be read. Real-time: never from the servo thread.
std::filesystem::path drawn_picture(const StartEntry& entry);

/// The pictures of the cards as textures. A scene without a stored picture is drawn by `thimble
/// shot` in a process beside the window, one after the other. Real-time: never from the servo
/// thread.
class Thumbnails {
 public:
  /// Precondition: a context of OpenGL is current, and outlives this.
  Thumbnails() = default;

  /// Returns the texture of a card; 0 if there is no picture yet.
  GLuint texture(const StartEntry& entry);
  /// Draws the next missing picture; call once per picture of the window.
  void step();
  /// Returns whether a picture is being drawn.
  bool drawing() const { return process_ != nullptr; }

 private:
  /// The picture of a scene, as long as its file does not change.
  struct Known {
    std::filesystem::file_time_type time;
    std::filesystem::path picture;
  };
  const std::filesystem::path& known_picture(const StartEntry& entry);

  std::map<std::filesystem::path, Known> known_;
  std::map<std::filesystem::path, GlTexture> textures_;
  std::set<std::filesystem::path> unreadable_;  // Pictures that cannot be read or drawn.
  std::vector<std::pair<std::filesystem::path, std::filesystem::path>> missing_;  // Scene, picture.
  std::filesystem::path drawn_;  // The picture that is being drawn.
  std::unique_ptr<ChildProcess> process_;
};

}  // namespace thimble::view
