#include "log/console.h"

#include <unistd.h>

#include <cstdio>
#include <string>

#include "system/printable_text.h"

namespace thimble::scene {
namespace {

// The only control characters that this program writes; all other output is filtered
// (driver::printable).
constexpr std::string_view kEraseLine = "\r\033[K";

void put(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace

void Console::write(std::string_view line) {
  const std::lock_guard lock(mutex_);
  if (!progress_.empty() && !partial_) put(kEraseLine);
  put(driver::printable(line));
  if (!line.ends_with('\n')) put("\n");
  partial_ = false;
  put(progress_);
  std::fflush(stderr);
}

void Console::print(std::FILE* stream, std::string_view text) {
  const std::lock_guard lock(mutex_);
  const bool whole = text.empty() ? !partial_ : text.ends_with('\n');
  const bool above = (!progress_.empty() || partial_ || !whole) && isatty(fileno(stream)) == 1;
  if (above && !progress_.empty() && !partial_) {
    put(kEraseLine);
    std::fflush(stderr);
  }
  std::fwrite(text.data(), 1, text.size(), stream);
  if (!above) return;
  partial_ = !whole;
  if (progress_.empty() || partial_) return;
  std::fflush(stream);
  put(progress_);
  std::fflush(stderr);
}

void Console::show(std::string progress) {
  const std::lock_guard lock(mutex_);
  const bool drawn = !progress_.empty();
  progress_ = driver::printable_name(progress);
  if (partial_) return;
  // Earlier lines must appear above the progress.
  if (!progress_.empty() && isatty(STDOUT_FILENO) == 1) std::fflush(stdout);
  if (drawn || !progress_.empty()) put(kEraseLine);
  put(progress_);
  std::fflush(stderr);
}

Console& console() {
  static Console* const only = new Console;  // never destroyed: threads may still write at exit
  return *only;
}

void ConsoleSink::sink_it_(const spdlog::details::log_msg& message) {
  spdlog::memory_buf_t line;
  formatter_->format(message, line);
  console().write({line.data(), line.size()});
}

}  // namespace thimble::scene
