#include "log/printed_text.h"

#include <unistd.h>

#include <algorithm>
#include <cstdarg>
#include <string>

#include "log/console.h"
#include "system/printable_text.h"

namespace thimble::scene {

void write_text(std::FILE* stream, std::string_view text) {
  const std::string shown = driver::printable(text);
  std::fwrite(shown.data(), 1, shown.size(), stream);
}

void print_format(const char* format, ...) {
  std::va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  const int size = std::vsnprintf(nullptr, 0, format, values);
  va_end(values);
  std::string text(static_cast<std::size_t>(std::max(size, 0)) + 1, '\0');
  std::vsnprintf(text.data(), text.size(), format, again);
  va_end(again);
  text.pop_back();
  write_text(stdout, text);
}

void show_progress(std::string_view text) {
  if (isatty(STDERR_FILENO) != 1) return;
  std::fflush(stdout);  // earlier lines must appear above the progress
  console().show(std::string(text));
}

}  // namespace thimble::scene
