#include "printed.h"

#include <cstdarg>
#include <cstdio>

namespace thimble::scene {

std::string printed(const char* format, ...) {
  char buffer[600];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

}  // namespace thimble::scene
