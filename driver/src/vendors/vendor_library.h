#pragma once

#include <span>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::driver {

/// A vendor's library, opened while the program runs and never closed: what such libraries leave
/// behind (threads, handlers) does not survive it. Real-time: never from the servo thread.
class VendorLibrary {
 public:
  /// Opens the first of these files that there is. The error says which were looked for, and what
  /// the linker says where one is there and cannot be opened, such as another library that it
  /// needs.
  static Result<VendorLibrary> open(std::span<const std::string> files);

  /// Returns the file that was opened.
  const std::string& file() const { return file_; }

  /// Finds a function by its name; false, and its name in `missing`, where the library has none.
  template <class Function>
  bool find(const char* name, Function*& function, std::string& missing) const {
    function = reinterpret_cast<Function*>(address_of(name));
    if (function != nullptr) return true;
    missing = name;
    return false;
  }

 private:
  VendorLibrary(void* handle, std::string file) : handle_(handle), file_(std::move(file)) {}
  void* address_of(const char* name) const;

  void* handle_;
  std::string file_;
};

}  // namespace thimble::driver
