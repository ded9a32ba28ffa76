#include "log/log_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "log/console.h"
#include "output/output_file.h"
#include "system/printable_text.h"

namespace thimble::scene {
namespace {

constexpr const char* kLine = "%Y-%m-%dT%H:%M:%S.%e%z %-8l %P %n: %v";

/// Fails if a file of another kind has this name.
driver::Result<void> check(const std::filesystem::path& path) {
  const auto place = output::resolve_output(path);
  if (!place) return place.error();
  struct stat about {};
  if (place->stream && ::stat(path.c_str(), &about) == 0 && S_ISFIFO(about.st_mode)) {
    return output::cannot_write(path, "it is a pipe. Name a file.");
  }
  return output::check_replaceable(path, *place, output::kLogFile, false);
}

/// Creates the file with access for its owner only, before the logging library opens it.
void make_owned(const spdlog::filename_t& path) {
  const int made = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOCTTY, 0600);
  if (made >= 0) ::close(made);
}

/// Removes the access of other users to an existing file, and closes it in child processes.
void keep_owned(const spdlog::filename_t&, std::FILE* stream) {
  const int descriptor = fileno(stream);
  struct stat about {};
  if (::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode)) ::fchmod(descriptor, 0600);
  ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

}  // namespace

LogFile::LogFile(std::filesystem::path path, Growth growth, std::string heading)
    : path_(std::move(path)), growth_(growth), heading_(std::move(heading)) {}

void LogFile::open_it() {
  // The folder of a file that the user names must exist.
  if (growth_ == Growth::kRotates) std::filesystem::create_directories(path_.parent_path());
  // The log is not locked: several processes may append to it, and each line has its process
  // number.
  if (auto may = check(path_); !may) throw std::runtime_error(may.error().message);
  spdlog::file_event_handlers handlers;
  handlers.before_open = make_owned;
  handlers.after_open = keep_owned;
  if (growth_ == Growth::kRotates) {
    file_ = std::make_shared<spdlog::sinks::rotating_file_sink_st>(path_.string(), kBytesMax,
                                                                   kFilesMax - 1, false, handlers);
  } else {
    file_ = std::make_shared<spdlog::sinks::basic_file_sink_st>(path_.string(), false, handlers);
  }
  file_->set_pattern(kLine);
  file_->log({"thimble", spdlog::level::info, driver::printable(heading_)});
  file_->flush();
}

driver::Result<void> LogFile::open() {
  const std::lock_guard lock(mutex_);
  try {
    if (!file_) open_it();
    return {};
  } catch (const std::exception& trouble) {
    file_.reset();
    ended_ = true;
    return driver::Error{
        fmt::format("{}: cannot write the log there ({}).", path_.string(), trouble.what())};
  }
}

void LogFile::sink_it_(const spdlog::details::log_msg& message) {
  if (ended_) return;
  try {
    if (!file_) open_it();
    spdlog::details::log_msg shown = message;
    const std::string text = driver::printable({message.payload.data(), message.payload.size()});
    shown.payload = text;
    // Name of a run: that of its scene, or of --name.
    const std::string name =
        driver::printable_name({message.logger_name.data(), message.logger_name.size()});
    shown.logger_name = name;
    file_->log(shown);
    file_->flush();
  } catch (const std::exception& trouble) {
    end(trouble.what());
  }
}

void LogFile::end(const std::string& why) {
  ended_ = true;
  file_.reset();
  console().write(
      fmt::format("thimble: Logging has stopped, because {} cannot be written ({}). "
                  "Repair the folder or the disk, or name another file with --log.",
                  path_.string(), why));
}

}  // namespace thimble::scene
