#include "studies/sweep/sweep_journal.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "output/output_file.h"
#include "text_file.h"
#include "text_hash.h"

namespace thimble::studies {
namespace {

std::string hex(std::uint64_t value) {
  return fmt::format("{:016x}", value);
}

std::string heading_of(const std::string& key, std::size_t cells) {
  return "thimble-sweep 1 " + std::to_string(cells) + " " + hex(scene::text_hash(key)) + "\n";
}

/// Writes a cell as `CELL COUNT NUMBERS... CHECK`, each number as its bit pattern.
std::string line_of(std::size_t cell, std::span<const double> numbers) {
  std::string line = std::to_string(cell) + " " + std::to_string(numbers.size());
  for (const double number : numbers) {
    line.append(" ").append(hex(std::bit_cast<std::uint64_t>(number)));
  }
  const std::string check = hex(scene::text_hash(line));
  return line.append(" ").append(check).append("\n");
}

/// Returns the next word of a line; empty at its end.
std::string_view next_word(std::string_view& rest) {
  const std::size_t end = rest.find(' ');
  const std::string_view word = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return word;
}

std::optional<std::uint64_t> whole_number(std::string_view word, int base) {
  std::uint64_t value = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value, base);
  if (status != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// Parses one line without its end; false if it is incomplete or damaged.
bool read_line(std::string_view line, CellNumbers& numbers) {
  const std::size_t last = line.rfind(' ');
  if (last == std::string_view::npos) return false;
  const auto check = whole_number(line.substr(last + 1), 16);
  std::string_view rest = line.substr(0, last);
  if (!check || *check != scene::text_hash(rest)) return false;
  const auto cell = whole_number(next_word(rest), 10);
  const auto count = whole_number(next_word(rest), 10);
  if (!cell || !count || *cell >= numbers.size()) return false;
  std::vector<double> found;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto bits = whole_number(next_word(rest), 16);
    if (!bits) return false;
    found.push_back(std::bit_cast<double>(*bits));
  }
  numbers[*cell] = std::move(found);
  return true;
}

/// Parses all complete lines after the heading; returns where the valid part ends.
std::size_t read_lines(std::string_view text, std::size_t begin, CellNumbers& numbers) {
  while (true) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos || !read_line(text.substr(begin, end - begin), numbers)) {
      return begin;
    }
    begin = end + 1;
  }
}

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

driver::Error unwritable(const std::filesystem::path& file) {
  return {"Cannot write " + file.string() +
          ". Check that the folder exists, is writable and has room."};
}

}  // namespace

driver::Result<std::unique_ptr<SweepJournal>> SweepJournal::open(const std::filesystem::path& file,
                                                                 const std::string& key,
                                                                 std::size_t cells, bool resume,
                                                                 CellNumbers& numbers) {
  numbers.assign(cells, {});
  auto lock = output::FolderLock::take(file.parent_path());
  if (!lock) return lock.error();
  const std::string heading = heading_of(key, cells);
  std::error_code status;
  const bool there = std::filesystem::exists(file, status);
  std::size_t good = 0;
  if (there && resume) {
    const std::string text = scene::text_of(file);
    const bool begun = text.size() >= heading.size();
    if (begun && text.compare(0, heading.size(), heading) != 0) {
      return driver::Error{
          file.string() +
          " was written by another build or with other options. Use the same build and "
          "options, or remove --resume to start again."};
    }
    good = begun ? read_lines(text, heading.size(), numbers) : 0;
  } else if (there) {
    std::filesystem::rename(file, file.string() + ".old", status);
  }
  // O_NONBLOCK: a pipe of that name is an error, without waiting for it.
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, 0644);
  if (descriptor < 0) return unwritable(file);
  std::unique_ptr<SweepJournal> journal(
      new SweepJournal(std::move(lock).value(), file, heading, descriptor));
  if (::ftruncate(descriptor, static_cast<off_t>(good)) != 0) return unwritable(file);
  if (good == 0 && !write_all(descriptor, heading)) return unwritable(file);
  return journal;
}

SweepJournal::~SweepJournal() {
  ::close(descriptor_);
}

bool SweepJournal::add(std::size_t cell, std::span<const double> numbers) {
  return write_all(descriptor_, line_of(cell, numbers));
}

driver::Result<void> SweepJournal::finish(const CellNumbers& numbers) {
  std::string text = heading_;
  for (std::size_t cell = 0; cell < numbers.size(); ++cell) text += line_of(cell, numbers[cell]);
  return output::write_file(file_, output::kPlainText, text);
}

}  // namespace thimble::studies
