#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "report/pictures.h"

namespace thimble::report {

// Shared parts of the pictures: colours, quoting, contact intervals; and one function per picture.

/// Colour of text and lines. Force is blue and depth orange, which colour-blind people can
/// distinguish [M Okabe and Ito].
inline constexpr const char* kInk = "#30343b";
inline constexpr const char* kFaintInk = "#8a919c";
inline constexpr const char* kGridInk = "#e4e7eb";
inline constexpr const char* kForceInk = "#0072b2";
inline constexpr const char* kDepthInk = "#d55e00";
inline constexpr const char* kContactFill = "#eef3f8";

/// Quotes a text for gnuplot, without interpretation.
std::string quote(const std::string& text);

/// Returns a number in gnuplot's syntax.
std::string number(double value);

/// Returns commands for borders, tics and grid in the common style.
std::string quiet_style();

/// Returns a tic distance (1, 2 or 5 times a power of ten) that divides `range` (> 0) into about
/// `count` parts.
double tic_step(double range, int count);

/// Tics with their labels.
struct NamedTics {
  std::string list;  ///< Argument of gnuplot's `set xtics`.
  double width = 0;  ///< Width of the widest label, pixels.
};

/// Returns the multiples of a tic distance from `low` to `high` (> low), about `count` of them,
/// each labelled with its value times `sign`.
NamedTics named_tics(double low, double high, double sign, int count);

/// Returns an approximate upper bound of the width of a text (UTF-8) in the pictures' font of this
/// size, pixels.
double text_width(const std::string& text, double points = 17);

/// Returns the text, truncated with an ellipsis (…) if it is wider than `pixels` in a font of
/// `points`.
std::string fitted(const std::string& text, double pixels, double points);

/// Returns the intervals of contact, s from the first row; gaps shorter than `gap` (s) are closed.
std::vector<std::pair<double, double>> contact_intervals(std::span<const driver::TickRecord> rows,
                                                         double gap);

/// Returns the length of a vector.
double length_of(const std::array<double, 3>& vector);

/// Returns the time of a row in s from the first row's.
double time_of(const driver::TickRecord& row, const driver::TickRecord& first);

/// Draws force and depth over time.
driver::Result<void> draw_force_and_depth(std::span<const driver::TickRecord> rows,
                                          const PictureInfo& info,
                                          const std::filesystem::path& folder);

/// Draws the path of the tip over the mesh.
driver::Result<void> draw_path_on_mesh(std::span<const driver::TickRecord> rows,
                                       const render::TriangleMesh& mesh_W, const PictureInfo& info,
                                       const std::filesystem::path& folder);

/// Draws histograms of the loop's periods.
driver::Result<void> draw_period_histogram(const PictureInfo& info,
                                           const std::filesystem::path& folder);

/// Makes the folder and its data/.
driver::Result<void> make_picture_folder(const std::filesystem::path& folder);

}  // namespace thimble::report
