#include "mesh/file/file_unit.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace thimble::render {
namespace {

// The words of 3MF (core specification 3.4) and of AMF (ISO/ASTM 52915), and two common
// misspellings.
constexpr std::array<std::pair<std::string_view, double>, 9> kUnits{{{"micron", 1e-6},
                                                                     {"millimeter", 1e-3},
                                                                     {"millimeters", 1e-3},
                                                                     {"centimeter", 1e-2},
                                                                     {"inch", 0.0254},
                                                                     {"foot", 0.3048},
                                                                     {"feet", 0.3048},
                                                                     {"meter", 1.0},
                                                                     {"meters", 1.0}}};

}  // namespace

std::optional<double> unit_of_word(std::string_view unit) {
  std::string word(unit);
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [known, metres] : kUnits) {
    if (word == known) return metres;
  }
  return std::nullopt;
}

std::optional<double> unit_of_model(std::string_view text, std::string_view element) {
  constexpr double kMillimetre = 1e-3;
  const std::size_t begin = text.find('<' + std::string(element));
  if (begin == std::string_view::npos) return kMillimetre;
  const std::string_view head = text.substr(begin, text.find('>', begin) - begin);
  std::size_t name = head.find("unit");
  while (name != std::string_view::npos && head[name - 1] > ' ') name = head.find("unit", name + 1);
  if (name == std::string_view::npos) return kMillimetre;
  const std::size_t open = head.find_first_of("\"'", name);
  if (open == std::string_view::npos) return kMillimetre;
  const std::size_t close = head.find(head[open], open + 1);
  if (close == std::string_view::npos) return kMillimetre;
  return unit_of_word(head.substr(open + 1, close - open - 1));
}

char up_axis_of_dae(std::string_view text) {
  const std::size_t begin = text.find("<up_axis>");
  if (begin == std::string_view::npos) return 'y';
  const std::string_view word = text.substr(begin + 9, text.find('<', begin + 9) - begin - 9);
  if (word.find('X') != std::string_view::npos) return 'x';
  return word.find('Z') != std::string_view::npos ? 'z' : 'y';
}

}  // namespace thimble::render
