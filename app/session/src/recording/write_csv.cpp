#include "thimble/session/recording.h"

#include <array>
#include <charconv>
#include <cstring>
#include <string>

#include "log/progress.h"
#include "output/output_file.h"

namespace thimble::session {
namespace {

template <class T>
void add_number(std::string& line, const unsigned char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  std::array<char, 40> text;  // the shortest form of a double has at most 24 characters
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  line.append(text.data(), end);
}

void add_number(std::string& line, RecordingColumn::Type type, const unsigned char* from) {
  switch (type) {
    case RecordingColumn::Type::kU8:
      return add_number<std::uint8_t>(line, from);
    case RecordingColumn::Type::kU16:
      return add_number<std::uint16_t>(line, from);
    case RecordingColumn::Type::kI16:
      return add_number<std::int16_t>(line, from);
    case RecordingColumn::Type::kI32:
      return add_number<std::int32_t>(line, from);
    case RecordingColumn::Type::kI64:
      return add_number<std::int64_t>(line, from);
    case RecordingColumn::Type::kU64:
      return add_number<std::uint64_t>(line, from);
    case RecordingColumn::Type::kF32:
      return add_number<float>(line, from);
    case RecordingColumn::Type::kF64:
      return add_number<double>(line, from);
  }
}

std::string heading() {
  std::string line;
  for (const RecordingColumn& column : recording_columns()) {
    for (std::size_t k = 0; k < column.width; ++k) {
      if (!line.empty()) line += ',';
      line += column.name;
      // Values of the arm's axes are numbered 1, 2, 3; vectors have x, y, z.
      if (column.width == 3) line += std::string(".") + (column.by_axis() ? "123" : "xyz")[k];
      if (column.width == 4) line += std::string(".") + "wxyz"[k];
      if (std::strcmp(column.unit, "1") != 0) line += std::string(" [") + column.unit + "]";
    }
  }
  return line;
}

}  // namespace

driver::Result<void> write_csv(const Recording& recording, const std::filesystem::path& path) {
  auto file = output::OutputFile::open(path, output::kTable);
  if (!file) return file.error();
  constexpr std::size_t kPiece = std::size_t{1} << 16;
  std::string text = heading() + '\n';
  std::string line;
  scene::Progress progress("table");
  std::size_t done = 0;
  for (const driver::TickRecord& tick : recording.ticks) {
    progress.set_share(++done, recording.ticks.size());
    line.clear();
    for (const RecordingColumn& column : recording_columns()) {
      const auto* from = reinterpret_cast<const unsigned char*>(&tick) + column.offset;
      for (std::size_t k = 0; k < column.width; ++k) {
        if (!line.empty()) line += ',';
        add_number(line, column.type, from + k * column.element());
      }
    }
    text += line;
    text += '\n';
    if (text.size() < kPiece) continue;
    if (auto written = file->write(text); !written) return written;
    text.clear();
  }
  if (auto written = file->write(text); !written) return written;
  return file->commit();
}

}  // namespace thimble::session
