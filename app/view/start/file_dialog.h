#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "view/start/child_process.h"

namespace thimble::view {

/// The desktop's dialog to choose a file: zenity or kdialog, whichever is installed. It runs beside
/// the window. Real-time: never from the servo thread.
class FileDialog {
 public:
  /// Searches the folders of PATH for a program.
  FileDialog();

  /// Returns whether there is a program.
  bool available() const { return !program_.empty(); }
  bool open() const { return process_ != nullptr; }
  /// Opens the dialog; does nothing while it is open. The error says why it cannot be opened.
  driver::Result<void> ask();
  /// Returns the chosen path, once; empty while the user chooses, and if nothing was chosen.
  std::optional<std::string> take_path();

 private:
  std::filesystem::path program_;
  std::unique_ptr<ChildProcess> process_;
};

}  // namespace thimble::view
