#include "recording/trajectory_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "system/regular_file.h"

namespace thimble::session {
namespace {

constexpr std::array<std::string_view, 7> kNames{"t", "x", "y", "z", "fx", "fy", "fz"};
// A larger force means that the file uses other units.
constexpr double kStrongest = 1e4;  // N

/// Returns the index in kNames of each column; -1: ignored.
driver::Result<std::vector<int>> read_columns(const std::string& text) {
  std::vector<int> columns;
  std::array<int, kNames.size()> count{};
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto found = std::find(kNames.begin(), kNames.end(), word);
    if (found == kNames.end() && word != "-") {
      return driver::Error{"--columns: expected t, x, y, z, fx, fy, fz or -, found \"" + word +
                           "\"."};
    }
    columns.push_back(word == "-" ? -1 : static_cast<int>(found - kNames.begin()));
    if (columns.back() >= 0) ++count[static_cast<std::size_t>(columns.back())];
  }
  const bool places = count[0] == 1 && count[1] == 1 && count[2] == 1 && count[3] == 1;
  const bool forces = count[4] == count[5] && count[5] == count[6] && count[4] <= 1;
  if (!places || !forces) {
    return driver::Error{
        "--columns: expected t, x, y and z once each, and fx, fy and fz once each or not at all."};
  }
  return columns;
}

/// Parses the numbers of a line; empty if it contains anything else.
std::optional<std::vector<double>> numbers_of(std::string line) {
  for (char& c : line) {
    if (c == ',' || c == ';' || c == '\t' || c == '\r') c = ' ';
  }
  std::vector<double> numbers;
  const char* at = line.c_str();
  for (;;) {
    while (*at == ' ') ++at;
    if (*at == 0) return numbers;
    char* end = nullptr;
    const double number = std::strtod(at, &end);
    if (end == at) return {};
    numbers.push_back(number);
    at = end;
  }
}

}  // namespace

driver::Result<std::vector<TrajectoryPoint>> read_trajectory(const std::filesystem::path& file,
                                                             const TrajectoryForm& form) {
  const auto columns = read_columns(form.columns);
  if (!columns) return columns.error();
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;  // hours at 1 kHz
  auto text = driver::read_file(file, kMaxBytes);
  if (!text) return driver::Error{file.string() + ": " + text.error().message};
  std::istringstream stream(std::move(text).value());
  std::vector<TrajectoryPoint> trajectory;
  std::size_t number = 0;
  const auto wrong = [&](const std::string& what) {
    return driver::Error{file.string() + ", line " + std::to_string(number) + ": " + what};
  };
  bool any_line = false;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '#' || line[begin] == '%') continue;
    const auto numbers = numbers_of(line);
    const bool header = !numbers && !any_line;
    any_line = true;
    if (header) continue;
    if (!numbers) return wrong("expected only numbers.");
    if (numbers->size() < columns->size()) {
      return wrong("expected " + std::to_string(columns->size()) + " columns (" + form.columns +
                   "), found " + std::to_string(numbers->size()) +
                   "; set the columns with --columns.");
    }
    std::array<double, kNames.size()> values{};
    for (std::size_t i = 0; i < columns->size(); ++i) {
      if ((*columns)[i] >= 0) values[static_cast<std::size_t>((*columns)[i])] = (*numbers)[i];
    }
    const TrajectoryPoint point{.time = form.seconds * values[0],
                                .p = form.metres * Eigen::Vector3d(values[1], values[2], values[3]),
                                .f = {values[4], values[5], values[6]}};
    if (!std::isfinite(point.time)) return wrong("the time is not a finite number.");
    if (!point.p.allFinite() || !point.f.allFinite()) {
      return wrong("a position or force is not a finite number.");
    }
    if (!((point.p.array().abs() < form.farthest).all() && point.f.norm() < kStrongest)) {
      return wrong(
          "is too far away (10 m) or too strong (10 kN); set the unit of length with --length.");
    }
    if (!trajectory.empty() && point.time < trajectory.back().time) {
      return wrong("the time decreases.");
    }
    if (trajectory.empty() || point.time > trajectory.back().time) trajectory.push_back(point);
  }
  if (trajectory.size() < 2) return driver::Error{file.string() + ": has fewer than two points."};
  return trajectory;
}

TrajectoryPoint trajectory_at(const std::vector<TrajectoryPoint>& trajectory, double time,
                              std::size_t& hint) {
  if (!(time > trajectory.front().time)) return trajectory.front();
  if (time >= trajectory.back().time) return trajectory.back();
  if (hint + 1 >= trajectory.size() || trajectory[hint].time > time) hint = 0;
  while (trajectory[hint + 1].time <= time) ++hint;
  const TrajectoryPoint& from = trajectory[hint];
  const TrajectoryPoint& to = trajectory[hint + 1];
  const double share = (time - from.time) / (to.time - from.time);
  return {
      .time = time, .p = from.p + share * (to.p - from.p), .f = from.f + share * (to.f - from.f)};
}

}  // namespace thimble::session
