#include "view/compare/signal_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "log/progress.h"
#include "system/regular_file.h"
#include "text/utf8.h"
#include "view/compare/text_lines.h"

namespace thimble::view {
namespace {

constexpr const char* kHeaderForm = "`time, name [unit], ...`";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  text = text.substr(first, text.find_last_not_of(kBlank) - first + 1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    text = text.substr(1, text.size() - 2);
  }
  return text;
}

/// Splits a line at its commas, into `max` cells at most.
void split(std::string_view line, std::size_t max, std::vector<std::string_view>& cells) {
  cells.clear();
  while (cells.size() < max) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

/// Returns the number that a whole cell is; none if it is none, or not finite.
std::optional<double> number_in(std::string_view cell) {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) return {};
  return value;
}

/// Returns a cell for a message: at most 24 characters of ASCII.
std::string shown_cell(std::string_view cell) {
  constexpr std::size_t kMax = 24;
  std::string text;
  for (const char letter : cell.substr(0, kMax)) {
    text += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  return '"' + text + (cell.size() > kMax ? "...\"" : "\"");
}

// As the longest run.
constexpr double kLatest = 86400;  // s
constexpr double kLargest = std::numeric_limits<float>::max();

/// Splits "name [unit]".
std::pair<std::string, std::string> name_and_unit(std::string_view cell) {
  const std::size_t open = cell.rfind('[');
  if (open == std::string_view::npos || cell.back() != ']') return {std::string(cell), ""};
  return {std::string(trimmed(cell.substr(0, open))),
          std::string(trimmed(cell.substr(open + 1, cell.size() - open - 2)))};
}

/// Reads one file.
class SignalReader {
 public:
  SignalReader(std::string name, TextLines lines, const SignalLimits& limits)
      : name_(std::move(name)), lines_(std::move(lines)), limits_(limits) {}

  driver::Result<OwnSignals> read() {
    signals_.file = name_;
    scene::Progress progress("signals");
    std::string_view line;
    for (;;) {
      const TextLines::Next next = lines_.next(line);
      if (next == TextLines::Next::kEnd) break;
      if (next == TextLines::Next::kUnreadable) {
        return driver::Error{name_ + ": the file cannot be read. Check the disk."};
      }
      if (next == TextLines::Next::kTooLong) {
        return at_line(
            fmt::format("the line has more than {} bytes, so this is no table of "
                        "numbers. Write a CSV file with the header {}.",
                        limits_.line, kHeaderForm));
      }
      if (lines_.number() == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
      if (auto taken = take(line); !taken) return taken.error();
      progress.set_share(lines_.read(), std::max<std::uint64_t>(lines_.size(), 1));
    }
    if (columns_ == 0) {
      return driver::Error{name_ + ": the file is empty. Begin it with the header " +
                           std::string(kHeaderForm) + "."};
    }
    if (time_.empty()) {
      return driver::Error{name_ +
                           ": there is no line below the header. Write a time and one "
                           "number per column in each line."};
    }
    signals_.time = std::make_shared<const std::vector<double>>(std::move(time_));
    return std::move(signals_);
  }

 private:
  driver::Error at_line(const std::string& problem) const {
    return {fmt::format("{}:{}: {}", name_, lines_.number(), problem)};
  }

  driver::Result<void> take(std::string_view line) {
    const auto is_control = [](char letter) {
      return (letter >= 0 && letter < ' ' && letter != '\t') || letter == 0x7F;
    };
    if (std::any_of(line.begin(), line.end(), is_control)) {
      return at_line("the line has bytes that are not text. Write a CSV file with the header " +
                     std::string(kHeaderForm) + ".");
    }
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') return {};
    split(line, limits_.columns + 2, cells_);
    return columns_ == 0 ? take_header(text) : take_numbers();
  }

  driver::Result<void> take_header(std::string_view line) {
    if (scene::as_utf8(line) != line) {
      return at_line("the header is not text in UTF-8. Save a CSV file in UTF-8, with the header " +
                     std::string(kHeaderForm) + ".");
    }
    if (cells_.size() == 1 && line.find_first_of(";\t") != std::string_view::npos) {
      return at_line(
          "the columns are not separated by commas. Replace semicolons or tabs by "
          "commas, and decimal commas by points.");
    }
    if (number_in(cells_.front())) {
      return at_line("the header is missing. Begin the file with " + std::string(kHeaderForm) +
                     ".");
    }
    const auto [time, unit] = name_and_unit(cells_.front());
    if (time != "time") {
      return at_line(
          fmt::format("the first column is {} instead of time. Begin the header with "
                      "time, as in {}.",
                      shown_cell(cells_.front()), kHeaderForm));
    }
    constexpr std::array<std::pair<std::string_view, double>, 5> kUnits = {
        {{"", 1}, {"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}};
    const auto* const found = std::find_if(kUnits.begin(), kUnits.end(),
                                           [&](const auto& known) { return known.first == unit; });
    if (found == kUnits.end()) {
      return at_line(
          fmt::format("the unit of the time is {}. Use s, ms, us or ns.", shown_cell(unit)));
    }
    per_unit_ = found->second;
    if (cells_.size() < 2) {
      return at_line("there is no column beside the time. Add one, as in " +
                     std::string(kHeaderForm) + ".");
    }
    if (cells_.size() > limits_.columns + 1) {
      return at_line(
          fmt::format("there are more than {} columns beside the time. Remove those "
                      "that you do not need.",
                      limits_.columns));
    }
    for (std::size_t k = 1; k < cells_.size(); ++k) {
      auto [name, of] = name_and_unit(cells_[k]);
      if (name.empty()) {
        return at_line(fmt::format("column {} has no name. Write one into the header.", k + 1));
      }
      for (const OwnSignal& other : signals_.signals) {
        if (other.name != name) continue;
        return at_line(
            fmt::format("two columns have the name {}. Give each its own name.", shown_cell(name)));
      }
      signals_.signals.push_back({std::move(name), std::move(of), {}});
    }
    columns_ = cells_.size();
    return {};
  }

  driver::Result<void> take_numbers() {
    if (cells_.size() != columns_) {
      return at_line(
          fmt::format("{} {} where the header has {}. Write a time and one number per "
                      "column, separated by commas.",
                      cells_.size(), cells_.size() == 1 ? "value" : "values", columns_));
    }
    if ((time_.size() + 1) * columns_ > limits_.numbers) {
      return at_line(
          fmt::format("the file has more than {} numbers. Remove columns, or "
                      "keep every second line.",
                      limits_.numbers));
    }
    const auto time = number_in(cells_.front());
    if (!time) return not_a_number(0);
    const double seconds = per_unit_ * *time;
    if (!(std::abs(seconds) <= kLatest)) {
      return at_line(
          fmt::format("the time {} is farther than {} s from the first tick. Subtract the time "
                      "of the first tick from all.",
                      shown_cell(cells_.front()), kLatest));
    }
    if (!time_.empty() && !(seconds >= time_.back())) {
      return at_line(
          fmt::format("the time {} is earlier than that of the line before. Sort the "
                      "lines by time.",
                      shown_cell(cells_.front())));
    }
    for (std::size_t k = 1; k < columns_; ++k) {
      const auto value = number_in(cells_[k]);
      if (!value) return not_a_number(k);
      if (!(std::abs(*value) <= kLargest)) {
        return at_line(fmt::format("{}: {} is larger than {:.2g}. Use a larger unit.",
                                   shown_cell(signals_.signals[k - 1].name), shown_cell(cells_[k]),
                                   kLargest));
      }
      signals_.signals[k - 1].values.push_back(static_cast<float>(*value));
    }
    time_.push_back(seconds);
    return {};
  }

  driver::Error not_a_number(std::size_t column) const {
    const std::string name = column == 0 ? "time" : signals_.signals[column - 1].name;
    return at_line(fmt::format("{}: {} is not a finite number. Correct it, or remove the line.",
                               shown_cell(name), shown_cell(cells_[column])));
  }

  std::string name_;
  TextLines lines_;
  SignalLimits limits_;
  std::vector<std::string_view> cells_;
  std::size_t columns_ = 0;  // the time included; 0: no header so far
  double per_unit_ = 1;      // s
  std::vector<double> time_;
  OwnSignals signals_;
};

}  // namespace

driver::Result<OwnSignals> read_signals(const std::filesystem::path& file,
                                        const SignalLimits& limits) {
  auto opened = driver::RegularFile::open(file);
  if (!opened) return driver::Error{file.string() + ": " + opened.error().message};
  if (opened->size() > limits.bytes) {
    return driver::Error{
        fmt::format("{}: the file is larger than {} MB. Remove columns, or keep "
                    "every second line.",
                    file.string(), limits.bytes / 1'000'000)};
  }
  return SignalReader(file.string(), TextLines(std::move(opened).value(), limits.line), limits)
      .read();
}

}  // namespace thimble::view
