#include "recording/write_black_box.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <string>
#include <system_error>
#include <vector>

#include "recording/recording_file.h"
#include "user_folders.h"

namespace thimble::session {
namespace {

namespace fs = std::filesystem;

/// Returns the time as a name that sorts by time. It includes milliseconds, because faults may
/// follow each other quickly.
std::string time_as_name() {
  const auto now = std::chrono::system_clock::now();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  const auto ms =
      std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 40> text{};
  std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%S", &utc);
  std::string name = text.data();
  name += '.';
  const std::string digits = std::to_string(ms);
  name.append(3 - digits.size(), '0').append(digits).append("Z");
  return name;
}

/// Deletes the oldest black boxes, so that one more can be kept. Errors are ignored.
void make_room(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
  }
  if (files.size() < kBlackBoxesMax) return;
  std::sort(files.begin(), files.end());  // by time, with which the names start
  for (std::size_t i = 0; i + kBlackBoxesMax <= files.size(); ++i) fs::remove(files[i], ignored);
}

}  // namespace

driver::Result<fs::path> write_black_box(std::span<const driver::TickRecord> ticks,
                                         const RecordingInfo& info) {
  const fs::path folder = scene::state_folder() / "faults";
  std::error_code status;
  fs::create_directories(folder, status);
  make_room(folder);
  std::string cause = "fault";
  for (const driver::TickRecord& tick : ticks) {
    if (tick.fault == driver::Fault::kNone) continue;
    cause = std::string(name(tick.fault));
    break;
  }
  const std::string name = time_as_name() + "-" + scene::as_file_name(info.scene) + "-" + cause;
  fs::path path = folder / (name + ".h5");
  // Several arms may fail in the same millisecond.
  for (int number = 2; fs::exists(path, status); ++number) {
    path = folder / (name + "-" + std::to_string(number) + ".h5");
  }
  if (auto written = write_recording(path, info, ticks); !written) return written.error();
  return path;
}

}  // namespace thimble::session
