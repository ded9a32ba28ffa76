#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::view {

/// The kinds of files that the start window opens.
enum class FileKind { kScene, kMesh, kRecording };

/// A file that the user dropped, typed or chose.
struct OpenedFile {
  std::filesystem::path file;  ///< Absolute path.
  FileKind kind = FileKind::kScene;
};

/// Returns the path in a text that was dropped, typed or pasted: without blanks and quotes around
/// it, with ~ and file:// replaced. A relative path is relative to the working folder.
std::filesystem::path path_in(const std::string& text);

/// Returns the file of a text and its kind, by its extension. The name of a shipped scene is
/// accepted too. The error says what to do: the text is empty, there is no such file, it is a
/// folder, or its kind is unknown. Real-time: never from the servo thread.
driver::Result<OpenedFile> open_text(const std::string& text);

}  // namespace thimble::view
