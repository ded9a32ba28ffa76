// Replaces the writer and the reader of recordings in a build without HDF5.
#include <utility>

#include "recording/recording_layout.h"

namespace thimble::session {
namespace {

driver::Error absent(const std::filesystem::path& path) {
  return {path.string() + ": built without recordings; configure with -D THIMBLE_RECORDINGS=ON."};
}

}  // namespace

const output::OutputKind kRecordingOutput{
    .name = "a recording",
    .matches = [](const std::filesystem::path&) { return false; },
    .existing = output::Existing::kReplaceForced,
    .owner_only = true,
    .needs_file = true};

driver::Result<RecordingLayout> RecordingLayout::create(output::OutputFile file,
                                                        const RecordingInfo& /*info*/,
                                                        std::uint64_t /*room*/) {
  return file.named(absent(file.part()));
}

driver::Result<void> RecordingLayout::write_ticks(std::span<const driver::TickRecord> /*ticks*/,
                                                  std::uint64_t /*row*/) {
  return absent(file_.part());
}

driver::Result<void> RecordingLayout::copy_rows(const RecordingLayout& /*from*/,
                                                std::uint64_t /*begin*/, std::uint64_t /*end*/) {
  return absent(file_.part());
}

driver::Result<void> RecordingLayout::set_rows(std::uint64_t /*rows*/) {
  return absent(file_.part());
}

driver::Result<void> RecordingLayout::set_complete() {
  return absent(file_.part());
}

driver::Result<Recording> read_recording(const std::filesystem::path& path) {
  return absent(path);
}

}  // namespace thimble::session
