#pragma once

#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::driver {

/// A function of a vendor's library, and the pointer that receives its address.
class VendorFunction {
 public:
  template <class Function>
  VendorFunction(const char* name, Function*& function)
      : name_(name),
        put_([&function](void* found) { function = reinterpret_cast<Function*>(found); }) {}

  const char* name() const { return name_; }
  void put(void* found) const { put_(found); }

 private:
  const char* name_;
  std::function<void(void*)> put_;
};

/// Opens the first of these files that exists, looks up the functions, and returns the file. The
/// library is never closed: threads and handlers that such libraries leave behind would not survive
/// it. If there is none, the error lists the files that were tried. If one cannot be opened, for
/// example because another library is missing, it is the linker's message. If a function is
/// missing, it names the function and ends with `otherwise`: what the library is not, and what to
/// install. Real-time: never from the servo thread.
Result<std::string> open_vendor_library(std::span<const std::string> files,
                                        std::initializer_list<VendorFunction> functions,
                                        const std::string& otherwise);

/// Returns only the file that the environment variable `name` names; `files` if it is not set.
std::vector<std::string> vendor_files(const char* name, std::vector<std::string> files);

}  // namespace thimble::driver
