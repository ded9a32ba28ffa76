#include "log/console.h"

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
  if (!progress_.empty()) put(kEraseLine);
  put(driver::printable(line));
  if (!line.ends_with('\n')) put("\n");
  put(progress_);
  std::fflush(stderr);
}

void Console::show(std::string progress) {
  const std::lock_guard lock(mutex_);
  if (!progress_.empty() || !progress.empty()) put(kEraseLine);
  progress_ = driver::printable_name(progress);
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
