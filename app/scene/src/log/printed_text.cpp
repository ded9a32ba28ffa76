#include "log/printed_text.h"

#include <unistd.h>

#include <algorithm>
#include <cstdarg>
#include <cstdlib>
#include <string>

#include "log/console.h"
#include "system/printable_text.h"

namespace thimble::scene {
namespace {

bool text_to_stderr = false;

}  // namespace

void print_text_to_stderr() noexcept {
  text_to_stderr = true;
}

std::FILE* text_stream() noexcept {
  return text_to_stderr ? stderr : stdout;
}

void write_text(std::FILE* stream, std::string_view text) {
  console().print(stream, driver::printable(text));
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
  write_text(text_stream(), text);
}

void print_toned(Tone tone, std::string_view text) {
  const char* const none = std::getenv("NO_COLOR");
  const bool coloured =
      tone != Tone::kPlain && isatty(fileno(text_stream())) == 1 && (none == nullptr || *none == 0);
  // Green, yellow and red in the colours that the user chose for the terminal.
  const char* const colour = tone == Tone::kGood     ? "\x1b[32m"
                             : tone == Tone::kAdvice ? "\x1b[33m"
                                                     : "\x1b[31m";
  std::string shown = driver::printable(text);
  if (coloured) {
    const bool whole = shown.ends_with('\n');
    if (whole) shown.pop_back();
    shown = colour + shown + "\x1b[0m" + (whole ? "\n" : "");
  }
  console().print(text_stream(), shown);
}

}  // namespace thimble::scene
