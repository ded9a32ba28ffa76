#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::compat {

/// A scene without objects, as a file with the lifetime of this object, for programs that compute
/// all forces themselves. Real-time: never from the servo thread.
class FreeScene {
 public:
  /// Writes the file for an arm (name or path; empty: the vintage PHANTOM). The hand rests at the
  /// world's origin. The error says what to do.
  static driver::Result<std::unique_ptr<FreeScene>> make(const std::string& arm);
  ~FreeScene();
  FreeScene(const FreeScene&) = delete;
  FreeScene& operator=(const FreeScene&) = delete;

  /// Returns the path of the file.
  const std::filesystem::path& file() const noexcept { return file_; }

 private:
  explicit FreeScene(std::filesystem::path file) : file_(std::move(file)) {}
  std::filesystem::path file_;
};

}  // namespace thimble::compat
