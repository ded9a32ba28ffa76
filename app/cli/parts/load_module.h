#pragma once

#include <string>

#include "thimble/driver/result.h"

namespace thimble::cli {

/// A part of the program in a separate module, loaded when it is needed.
struct ModulePart {
  const char* file;     ///< Name of the module's file.
  const char* symbol;   ///< Name of a variable in it that begins with the version of Thimble.
  const char* package;  ///< Package that installs it.
};

/// Returns the variable of a module, which is loaded if it is not yet and never unloaded. `absent`
/// is the error if it is not installed. Any thread. Real-time: never from the servo thread.
driver::Result<const void*> load_module(const ModulePart& part, const std::string& absent);

}  // namespace thimble::cli
