#include "log/logger.h"

#include <utility>

#include "log/console.h"
#include "log/log_file.h"
#include "user_folders.h"

namespace thimble::scene {
namespace {

using spdlog::level::level_enum;

std::shared_ptr<spdlog::sinks::sink> console_sink(const char* pattern, level_enum level) {
  auto sink = std::make_shared<ConsoleSink>();
  sink->set_pattern(pattern);
  sink->set_level(level);
  return sink;
}

constexpr const char* kMessagePattern = "thimble: %v";

/// Loggers of this process, and their destinations.
struct Log {
  Log(Verbosity requested_verbosity, std::shared_ptr<LogFile> to)
      : file(std::move(to)), verbosity(requested_verbosity) {
    const bool more = verbosity == Verbosity::kDebug || verbosity == Verbosity::kTrace;
    const level_enum level = verbosity == Verbosity::kTrace    ? spdlog::level::trace
                             : verbosity == Verbosity::kDebug  ? spdlog::level::debug
                             : verbosity == Verbosity::kNormal ? spdlog::level::warn
                                                               : spdlog::level::err;
    if (file)
      file->set_level(verbosity == Verbosity::kTrace ? spdlog::level::trace : spdlog::level::debug);
    runs = console_sink(kMessagePattern, more ? level : spdlog::level::off);
    main_logger = make("thimble", console_sink(kMessagePattern, level));
    terminal_logger = make("terminal", console_sink("%v", spdlog::level::info));
  }

  std::shared_ptr<spdlog::logger> make(const std::string& name,
                                       std::shared_ptr<spdlog::sinks::sink> sink) const {
    auto made = std::make_shared<spdlog::logger>(name, std::move(sink));
    if (file) made->sinks().push_back(file);
    made->set_level(spdlog::level::trace);
    return made;
  }

  std::shared_ptr<LogFile> file;
  Verbosity verbosity;
  std::shared_ptr<spdlog::sinks::sink> runs;
  std::shared_ptr<spdlog::logger> main_logger, terminal_logger;
};

std::unique_ptr<Log>& log() {
  // Never destroyed: threads may still write at exit.
  static auto* const only = new std::unique_ptr<Log>(new Log(Verbosity::kNormal, nullptr));
  return *only;
}

}  // namespace

spdlog::logger& logger() {
  return *log()->main_logger;
}

spdlog::logger& terminal() {
  return *log()->terminal_logger;
}

Verbosity verbosity() {
  return log()->verbosity;
}

std::shared_ptr<spdlog::logger> run_logger(const std::string& run) {
  return log()->make(run, log()->runs);
}

driver::Result<void> begin_log(const LogChoice& choice) {
  const bool named = !choice.file.empty();
  auto file = std::make_shared<LogFile>(
      named ? choice.file : default_log_file(),
      named ? LogFile::Growth::kEndless : LogFile::Growth::kRotates, choice.heading);
  if (named) {
    if (auto opened = file->open(); !opened) return opened;
  }
  log() = std::make_unique<Log>(choice.verbosity, std::move(file));
  return {};
}

std::filesystem::path default_log_file() {
  return state_folder() / "log" / "thimble.log";
}

}  // namespace thimble::scene
