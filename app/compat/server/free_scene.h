#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::compat {

/// A scene in which there is nothing to touch, as a file that lives as long as this: what a program
/// gets that draws its own world. Real-time: never from the servo thread.
class FreeScene {
 public:
  /// Writes it for an arm (name or path; empty: the vintage PHANTOM); the hand rests at the world's
  /// origin. The error says what to do.
  static driver::Result<std::unique_ptr<FreeScene>> make(const std::string& arm);
  ~FreeScene();
  FreeScene(const FreeScene&) = delete;
  FreeScene& operator=(const FreeScene&) = delete;

  /// Returns the file.
  const std::filesystem::path& file() const noexcept { return file_; }

 private:
  explicit FreeScene(std::filesystem::path file) : file_(std::move(file)) {}
  std::filesystem::path file_;
};

}  // namespace thimble::compat
