#include "log/log_file.h"

#include <fmt/core.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/rotating_file_sink.h>

#include <exception>
#include <string>
#include <system_error>
#include <utility>

#include "log/console.h"
#include "system/printable_text.h"

namespace thimble::scene {
namespace {

constexpr const char* kLine = "%Y-%m-%dT%H:%M:%S.%e%z %-8l %P %n: %v";

}  // namespace

LogFile::LogFile(std::filesystem::path path, Growth growth, std::string heading)
    : path_(std::move(path)), growth_(growth), heading_(std::move(heading)) {}

void LogFile::open_it() {
  const std::filesystem::path folder = path_.parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  if (growth_ == Growth::kRotates) {
    file_ = std::make_shared<spdlog::sinks::rotating_file_sink_st>(path_.string(), kBytesMost,
                                                                   kFilesMost - 1);
  } else {
    file_ = std::make_shared<spdlog::sinks::basic_file_sink_st>(path_.string());
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
        fmt::format("{}: the log cannot be written there ({}).", path_.string(), trouble.what())};
  }
}

void LogFile::sink_it_(const spdlog::details::log_msg& message) {
  if (ended_) return;
  try {
    if (!file_) open_it();
    spdlog::details::log_msg shown = message;
    const std::string text = driver::printable({message.payload.data(), message.payload.size()});
    shown.payload = text;
    file_->log(shown);
    file_->flush();
  } catch (const std::exception& trouble) {
    end(trouble.what());
  }
}

void LogFile::end(const std::string& why) {
  ended_ = true;
  file_.reset();
  console().write(fmt::format(
      "thimble: The log ends, for {} cannot be written ({}). All else goes on; mend the folder or "
      "the disk, or name another file by --log.",
      path_.string(), why));
}

}  // namespace thimble::scene
