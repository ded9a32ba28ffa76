#include "recording/run_choices.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>

#include "thimble/scene/quality.h"

namespace thimble::session {
namespace {

/// Parses a number > 0.
std::optional<double> positive_number(const std::string& text) {
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good =
      status == std::errc() && end == text.data() + text.size() && value > 0 && value <= 1e12;
  return good ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string text_of(const RunChoices& choices) {
  const RunChoices none;
  std::string text;
  if (choices.quality != none.quality) text += "quality: " + choices.quality + "\n";
  // The shortest form that is read back bit-identically.
  if (choices.budget) text += fmt::format("budget: {}\n", *choices.budget);
  if (choices.rate_factor != 1) text += fmt::format("rate_factor: {}\n", choices.rate_factor);
  if (choices.adjusted) text += "adjusted: yes\n";
  return text;
}

driver::Result<RunChoices> run_choices(const std::string& text) {
  RunChoices choices;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    const std::string key = line.substr(0, colon);
    const std::string value = colon == std::string::npos ? "" : line.substr(colon + 2);
    const auto number = positive_number(value);
    if (key == "quality" && scene::quality_named(value)) {
      choices.quality = value;
    } else if (key == "budget" && number) {
      choices.budget = number;
    } else if (key == "rate_factor" && number) {
      choices.rate_factor = *number;
    } else if (key == "adjusted" && value == "yes") {
      choices.adjusted = true;
    } else {
      return driver::Error{"the recording has the unknown option \"" + line +
                           "\"; use the version of thimble that made the recording."};
    }
  }
  return choices;
}

}  // namespace thimble::session
