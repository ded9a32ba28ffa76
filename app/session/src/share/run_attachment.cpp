#include "share/run_attachment.h"

#include <algorithm>

namespace thimble::session {
namespace {

constexpr std::chrono::milliseconds kCheckInterval{250};

}  // namespace

bool RunAttachment::step() {
  if (reader_ && reader_->state() != RunState::kEnded) return false;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_check_) return false;
  next_check_ = now + kCheckInterval;
  const auto runs = running_runs();
  const auto found = std::find_if(runs.begin(), runs.end(), [this](const RunningRun& run) {
    return name_.empty() || run.name == name_;
  });
  if (found == runs.end()) {
    // A run that was killed is shown in its last state until the next run removes its memory.
    if (reader_ || name_.empty()) return false;
    auto left = SharedReader::attach(name_);
    if (left) reader_ = std::move(left).value();
    return reader_ != nullptr;
  }
  if (reader_ && reader_->scene().began_ns == found->began_ns)
    return false;  // the run that has ended
  auto reader = SharedReader::attach(found->name);
  error_ = reader ? "" : reader.error().message;
  if (!reader) return false;
  reader_ = std::move(reader).value();
  name_ = found->name;
  return true;
}

bool RunAttachment::over() const {
  if (!reader_ || reader_->state() != RunState::kEnded) return false;
  // While its name exists, the next run may still take it over.
  return reader_->died() || !run_name_taken(name_);
}

std::string RunAttachment::notice() const {
  if (!error_.empty()) return error_;
  if (!reader_) {
    return name_.empty() ? "Waiting for a run: thimble run SCENE --view"
                         : "Waiting for a run named " + name_ + ".";
  }
  if (reader_->state() != RunState::kEnded) return {};
  const std::string next = " The next one named " + name_ + " is shown when it starts.";
  if (reader_->died()) return "The run's process has died." + next;
  return "The run has ended." + next;
}

}  // namespace thimble::session
