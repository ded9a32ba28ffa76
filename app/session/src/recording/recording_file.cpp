#include "recording/recording_file.h"

#include <algorithm>
#include <string>
#include <utility>

#include "output/output_file.h"

namespace thimble::session {

RecordingFile::RecordingFile(std::filesystem::path path, RecordingInfo info, std::uint64_t rows_max,
                             RecordingLayout layout)
    : path_(std::move(path)),
      info_(std::move(info)),
      rows_max_(rows_max),
      layout_(std::move(layout)) {}

driver::Result<RecordingFile> RecordingFile::create(const std::filesystem::path& path,
                                                    const RecordingInfo& info,
                                                    const RecordingSize& size, bool replace) {
  auto file = output::OutputFile::open(path, kRecordingOutput, replace);
  if (!file) return file.error();
  const std::uint64_t rows_max = std::max<std::uint64_t>(size.rows_max, 1);
  auto layout = RecordingLayout::create(std::move(file).value(), info,
                                        std::min(rows_max, std::max<std::uint64_t>(size.room, 1)));
  if (!layout) return layout.error();
  if (auto named = layout->file().publish(); !named) return named.error();
  return RecordingFile(path, info, rows_max, std::move(layout).value());
}

driver::Error RecordingFile::ends(const driver::Error& why) const {
  std::string text = path_.string() + ": the recording ends after " + std::to_string(rows_) +
                     " ticks: " + why.message;
  if (!text.ends_with('.')) text += '.';
  return driver::Error{text};
}

driver::Result<void> RecordingFile::append(std::span<const driver::TickRecord> ticks) {
  const std::size_t taken = std::min<std::uint64_t>(ticks.size(), rows_max_ - rows_);
  left_out_ += ticks.size() - taken;
  ticks = ticks.first(taken);
  while (!ticks.empty()) {
    if (rows_ == layout_.room()) {
      if (auto grown = grow(); !grown) return ends(grown.error());
    }
    const auto now = ticks.first(std::min<std::uint64_t>(ticks.size(), layout_.room() - rows_));
    if (auto written = layout_.write_ticks(now, rows_); !written) return ends(written.error());
    // The ticks become valid only here.
    if (auto written = layout_.set_rows(rows_ + now.size()); !written) return ends(written.error());
    rows_ += now.size();
    ticks = ticks.subspan(now.size());
    prepare_to_grow(now.size());
  }
  return {};
}

// Prepares a larger file in advance, so that growing takes little time. A separate thread creates
// it, because some file systems fill it with zeros. Its rows are then copied in small portions.
void RecordingFile::prepare_to_grow(std::uint64_t new_rows) {
  // Rows copied per new row. All rows are then copied when the file is two thirds full.
  constexpr std::uint64_t kRowsEach = 4;
  if (layout_.room() == rows_max_ || rows_ < layout_.room() / 2) return;
  if (!larger_ && !making_.valid()) {
    auto part = layout_.file().open_again(kRecordingOutput);
    if (!part) return;  // grow() tries again and reports the error
    const std::uint64_t room = std::min(rows_max_, 2 * layout_.room());
    making_ = std::async(std::launch::async,
                         [file = std::move(part).value(), info = info_, room]() mutable {
                           return RecordingLayout::create(std::move(file), info, room);
                         });
    return;
  }
  if (making_.valid()) {
    if (making_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    auto made = making_.get();
    if (!made) return;
    larger_.emplace(std::move(made).value());
  }
  const std::uint64_t end = std::min(rows_, copied_ + kRowsEach * new_rows);
  if (larger_->copy_rows(layout_, copied_, end)) copied_ = end;
}

driver::Result<void> RecordingFile::grow() {
  if (making_.valid()) {
    auto made = making_.get();
    if (!made) return made.error();
    larger_.emplace(std::move(made).value());
  }
  if (!larger_) {
    auto part = layout_.file().open_again(kRecordingOutput);
    if (!part) return part.error();
    auto made = RecordingLayout::create(std::move(part).value(), info_,
                                        std::min(rows_max_, 2 * layout_.room()));
    if (!made) return made.error();
    larger_.emplace(std::move(made).value());
    copied_ = 0;
  }
  if (auto copied = larger_->copy_rows(layout_, copied_, rows_); !copied) return copied;
  if (auto counted = larger_->set_rows(rows_); !counted) return counted;
  if (auto named = larger_->file().publish(); !named) return named;
  layout_ = std::move(*larger_);
  larger_.reset();
  copied_ = 0;
  return {};
}

driver::Result<void> RecordingFile::finish(bool complete) {
  if (making_.valid()) (void)making_.get();  // this removes its file
  larger_.reset();
  complete = complete && left_out_ == 0;
  if (rows_ == layout_.room() || !shorten(complete)) {
    // If there was no space for a shorter file, the longer one contains all ticks.
    if (complete) {
      if (auto marked = layout_.set_complete(); !marked) return ends(marked.error());
    }
  }
  return layout_.file().commit();
}

// A contiguous data set cannot shrink, so a shorter file replaces this one.
bool RecordingFile::shorten(bool complete) {
  auto part = layout_.file().open_again(kRecordingOutput);
  if (!part) return false;
  auto shorter =
      RecordingLayout::create(std::move(part).value(), info_, std::max<std::uint64_t>(rows_, 1));
  if (!shorter || !shorter->copy_rows(layout_, 0, rows_) || !shorter->set_rows(rows_)) return false;
  if (complete && !shorter->set_complete()) return false;
  if (!shorter->file().publish()) return false;
  layout_ = std::move(shorter).value();
  return true;
}

driver::Result<void> write_recording(const std::filesystem::path& path, const RecordingInfo& info,
                                     std::span<const driver::TickRecord> ticks, bool overwrite) {
  auto file = RecordingFile::create(path, info, {.rows_max = ticks.size(), .room = ticks.size()},
                                    overwrite);
  if (!file) return file.error();
  if (auto written = file->append(ticks); !written) return written;
  return file->finish(true);
}

std::filesystem::path file_of_arm(const std::filesystem::path& path,
                                  const std::string& arm_in_scene) {
  if (arm_in_scene.empty()) return path;
  return path.parent_path() /
         (path.stem().string() + "_" + arm_in_scene + path.extension().string());
}

}  // namespace thimble::session
