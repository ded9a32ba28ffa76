#include "view/start/start_flow.h"

#include <fmt/format.h>

#include <sstream>
#include <string_view>

namespace thimble::view {

StartFlow StartFlow::waiting() {
  StartFlow flow;
  flow.stage_ = StartStage::kWaiting;
  return flow;
}

void StartFlow::other_run_over(bool over) {
  if (!running_) ended_ = over && stage_ == StartStage::kShown;
}

void StartFlow::run_started() {
  running_ = true;
  ended_ = false;
  message_.clear();
  if (stage_ == StartStage::kChoosing) stage_ = StartStage::kStarting;
}

void StartFlow::shown() {
  stage_ = StartStage::kShown;
  message_.clear();
}

void StartFlow::run_ended(int code, const std::string& errors) {
  if (!running_) return;
  running_ = false;
  ended_ = stage_ == StartStage::kShown;
  const std::string line = last_line(errors);
  message_.clear();
  if (code != 0 || !ended_) {
    message_ = !line.empty()
                   ? line
                   : fmt::format("The run ended before it was shown (exit code {}).", code);
  }
  if (stage_ == StartStage::kStarting) stage_ = StartStage::kChoosing;
}

bool StartFlow::back() {
  const bool runs = running_;
  stage_ = StartStage::kChoosing;
  running_ = ended_ = false;
  message_.clear();
  return runs;
}

bool StartFlow::run_again() {
  return stage_ == StartStage::kShown && ended_;
}

std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::string last;
  while (std::getline(lines, line)) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  constexpr std::string_view kProgram = "thimble: ";
  if (last.starts_with(kProgram)) last.erase(0, kProgram.size());
  return last;
}

}  // namespace thimble::view
