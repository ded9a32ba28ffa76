#pragma once

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

// Shared parts of the pictures of this study.

// Colours that colour-blind people can distinguish, in addition to those of picture_parts.h [M
// Okabe and Ito].
inline constexpr const char* kGreenInk = "#009e73";
inline constexpr const char* kPurpleInk = "#8a3d6b";
inline constexpr const char* kGoldInk = "#b8860b";

/// Returns commands for the position of a panel, in fractions of the picture.
inline std::string panel(double left, double right, double bottom, double top) {
  std::ostringstream c;
  c << "set lmargin at screen " << left << "\nset rmargin at screen " << right
    << "\nset bmargin at screen " << bottom << "\nset tmargin at screen " << top << "\n";
  return c.str();
}

/// Returns commands for title and subtitle of a picture.
inline std::string heading(const std::string& title, const std::string& below) {
  std::ostringstream c;
  c << "set label 101 " << report::quote(report::fitted(title, 1400, 22))
    << " at screen 0.06, screen 0.955 font ',22' noenhanced "
    << "textcolor rgb '" << report::kInk << "'\nset label 102 "
    << report::quote(report::fitted(below, 1700, 15))
    << " at screen 0.06, screen 0.912 font ',15' noenhanced textcolor rgb '" << report::kFaintInk
    << "'\n";
  return c.str();
}

/// Returns commands for the title above a panel, from its left edge, a line's height above the
/// frame.
inline std::string panel_title(const std::string& title) {
  return "set label 103 " + report::quote(title) +
         " at graph 0, graph 1 offset 0,0.9 noenhanced textcolor rgb '" + report::kInk + "'\n";
}

/// Returns commands for the labels of both axes.
inline std::string axis_labels(const std::string& x, const std::string& y) {
  return "set xlabel " + report::quote(x) + " noenhanced textcolor rgb '" + report::kInk +
         "'\nset ylabel " + report::quote(y) + " noenhanced textcolor rgb '" + report::kInk + "'\n";
}

/// Writes columns of numbers for gnuplot; NaN leaves a gap.
inline driver::Result<void> write_data(const std::vector<std::vector<double>>& rows,
                                       const std::filesystem::path& file) {
  std::string text;
  for (const auto& row : rows) {
    for (const double value : row) {
      text += std::isfinite(value) ? fmt::format("{:.9g} ", value) : "? ";
    }
    text += "\n";
  }
  return report::write_text(text, file);
}

}  // namespace thimble::studies
