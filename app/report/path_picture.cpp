#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "report/fault_marks.h"
#include "report/figure.h"
#include "report/gnuplot.h"
#include "report/mesh_view.h"
#include "report/picture_parts.h"

namespace thimble::app {
namespace {

using Eigen::Vector3d;

constexpr int kPixels = 760;  // of a view's side; a panel is about 500 wide in the PNG
constexpr std::size_t kPointsMax = 4000;
constexpr double kHiddenBy = 0.01;  // of the extent: the tip lies in the surface, not behind it
constexpr double kMarkHiddenBy = 0.004;  // of the extent: marks lie in the surface to rounding
constexpr int kWidth = 1800;
constexpr double kPanel = 0.25;       // side of a panel in widths of the picture
constexpr double kWidePanel = 0.268;  // where no colours need a scale

// Viridis by van der Walt and Smith (CC0), at nine even steps; its light end is left out, for
// yellow is lost on light grey.
constexpr const char* kPalette =
    "set palette defined (0 '#440154', 0.125 '#472d7b', 0.25 '#3b528b', 0.375 '#2c728e', "
    "0.5 '#21918c', 0.625 '#28ae80', 0.75 '#5ec962', 0.875 '#addc30', 1 '#dce319')\n";

struct Window {
  Vector3d center{0, 0, 0};
  double extent = 1;
};

Vector3d to_vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

// Shows the whole mesh and what of the path is near it: a far start would make the mesh tiny.
Window window_of(const render::TriangleMesh& mesh, std::span<const driver::TickRecord> rows) {
  const Eigen::AlignedBox3d mesh_box = box_of(mesh);
  const double side = std::max(mesh_box.sizes().maxCoeff(), 1e-9);
  Eigen::AlignedBox3d most = mesh_box;
  most.extend(mesh_box.min() - Vector3d::Constant(0.2 * side));
  most.extend(mesh_box.max() + Vector3d::Constant(0.2 * side));
  Eigen::AlignedBox3d box = mesh_box;
  for (const driver::TickRecord& row : rows) {
    const Vector3d p_WT = to_vector(row.p_WT).cwiseMax(most.min()).cwiseMin(most.max());
    if (p_WT.squaredNorm() < HUGE_VAL) box.extend(p_WT);
  }
  return {box.center(), 1.08 * box.sizes().maxCoeff()};
}

// Writes the path as seen from one side: u, v, force; blank lines end a stretch. Three blocks:
// free air, hidden by the mesh, and in sight.
std::string way_table(std::span<const driver::TickRecord> rows, const MeshView& view,
                      double tolerance, double scale) {
  enum PathPart { kFree, kHidden, kSeen };
  std::array<std::ostringstream, 3> block;
  const std::size_t stride = (rows.size() + kPointsMax - 1) / kPointsMax;
  int last_kind = -1;
  for (std::size_t i = 0; i < rows.size(); i += stride) {
    const driver::TickRecord& row = rows[i];
    const Vector3d p_W = to_vector(row.in_contact ? row.p_WP : row.p_WT);
    const PathPart kind = view.hides(p_W, tolerance) ? kHidden : row.in_contact ? kSeen : kFree;
    const Eigen::Vector2d uv = scale * view.project(p_W);
    std::ostringstream line;
    line << uv.x() << ' ' << uv.y() << ' ' << length_of(row.f_sent_W) << '\n';
    if (last_kind >= 0 && last_kind != kind) {
      block[static_cast<std::size_t>(last_kind)] << line.str() << '\n';
    }
    block[kind] << line.str();
    last_kind = kind;
  }
  std::string text = "# u, v, force N; blocks: free, hidden, in sight\n";
  for (std::ostringstream& one : block) text += "nan nan 0\n\n" + one.str() + "\n\n";
  return text;
}

std::string tics(double low, double high, double sign) {
  const double step = tic_step(high - low, 6);
  std::string text = "(";
  for (double k = std::ceil(low / step); k * step <= high; ++k) {
    const double value = k == 0 ? 0 : k * step;
    text += (text.size() > 1 ? ", '" : "'") + number(value == 0 ? 0 : sign * value) + "' " +
            number(value);
  }
  return text + ")";
}

struct PanelText {
  std::string title;
  std::string unit;
  double unit_scale = 1;
  double force_max = 0;                          // N; 0: no way, no colours
  const render::MeshFindings* faults = nullptr;  // null: none to mark
};

driver::Result<void> draw_views(std::span<const driver::TickRecord> rows,
                                const render::TriangleMesh& mesh, const PanelText& say,
                                const std::string& name, const std::filesystem::path& folder) {
  const Window window = window_of(mesh, rows);
  const bool with_way = say.force_max > 0;
  const bool with_faults = say.faults != nullptr && has_marks(*say.faults);
  // A square panel must be as many pixels high as it is wide.
  const int height = with_faults ? 780 : with_way ? 690 : 740;
  const double panel = with_way ? kPanel : kWidePanel;
  const double margin = with_way ? 0.052 : 0.058;
  const double panel_height = panel * kWidth / height;
  std::ostringstream c;
  c << quiet_style() << "set border 15 lw 1 lc rgb '" << kFaintInk << "'\nunset key\nunset grid\n"
    << "set multiplot\nset label 1 " << quote(say.title) << " at screen " << number(margin)
    << ", screen 0.94 font ',22' noenhanced textcolor rgb '" << kInk << "'\n";
  if (with_way) {
    c << kPalette << "set cbrange [0:" << number(say.force_max) << "]\n"
      << "set label 2 'in air' at screen 0.86, screen 0.94 textcolor rgb '" << kInk << "'\n"
      << "set label 3 'behind the mesh' at screen 0.79, screen 0.94 right textcolor rgb '" << kInk
      << "'\nset arrow 1 from screen 0.82, screen 0.94 to screen 0.85, screen 0.94 nohead lw 1.5 "
         "lc rgb '"
      << kFaintInk
      << "'\nset arrow 2 from screen 0.65, screen 0.94 to screen 0.68, screen 0.94 nohead lw 2 dt "
         "'.' lc rgb '#7d5a8a'\n";
  }
  if (with_faults) {
    c << fault_legend(*say.faults, margin, 0.875)
      << "set label 2 'thin and pale: behind the mesh' at screen 0.984, screen 0.94 right "
         "textcolor "
         "rgb '"
      << kFaintInk << "'\n";
  }
  int index = 0;
  for (const ViewDirection& direction : view_directions()) {
    const MeshView view(mesh, direction, window.center, window.extent, kPixels);
    const std::string stem = "data/" + name + "_" + std::to_string(index + 1);
    const std::string image(view.rgb().begin(), view.rgb().end());
    if (auto done = write_text(image, folder / (stem + ".rgb")); !done) return done;
    const Eigen::Vector2d middle = say.unit_scale * view.project(window.center);
    const double half = 0.5 * say.unit_scale * window.extent;
    const Eigen::Vector2d low = middle - Eigen::Vector2d::Constant(half);
    const Eigen::Vector2d high = middle + Eigen::Vector2d::Constant(half);
    const double pitch = 2 * half / kPixels;
    const double left = margin + index * (panel + (with_way ? 0.058 : 0.062));
    c << "set lmargin at screen " << number(left) << "\nset rmargin at screen "
      << number(left + panel) << "\nset bmargin at screen 0.14\nset tmargin at screen "
      << number(0.14 + panel_height) << "\n"
      << "set xrange [" << number(low.x()) << ":" << number(high.x()) << "]\nset yrange ["
      << number(low.y()) << ":" << number(high.y()) << "]\n"
      << "set xtics " << tics(low.x(), high.x(), 1) << "\nset ytics "
      << tics(low.y(), high.y(), direction.v_sign) << "\n"
      << "set xlabel '" << direction.u_label << " [" << say.unit << "]' textcolor rgb '" << kInk
      << "'\nset ylabel '" << direction.v_label << " [" << say.unit
      << "]' offset 1.3,0 textcolor rgb '" << kInk << "'\nset title '" << direction.name
      << "' offset 0,-0.5\n";
    if (with_way && index == 2) {
      c << "set colorbox user origin screen " << number(left + panel + 0.014)
        << ", screen 0.14 size screen 0.011, screen " << number(panel_height)
        << "\nset cblabel 'force on the hand [N]' offset 0.5,0 textcolor rgb '" << kInk
        << "'\nset cbtics " << number(tic_step(say.force_max, 5)) << "\n";
    } else {
      c << "unset colorbox\n";
    }
    c << "plot '" << stem << ".rgb' binary array=(" << kPixels << "," << kPixels
      << ") format='%uchar' origin=(" << number(low.x() + pitch / 2) << ","
      << number(low.y() + pitch / 2) << ") dx=" << number(pitch) << " dy=" << number(pitch)
      << " with rgbimage notitle";
    if (with_way) {
      const std::string way = way_table(rows, view, kHiddenBy * window.extent, say.unit_scale);
      if (auto done = write_text(way, folder / (stem + ".dat")); !done) return done;
      const std::string data = ", '" + stem + ".dat' index ";
      c << data << "0 using 1:2 with lines lw 1.2 lc rgb '" << kFaintInk << "'" << data
        << "1 using 1:2 with lines lw 1.6 dt '.' lc rgb '#7d5a8a'" << data
        << "2 using 1:2 with lines lw 6 lc rgb '#ffffff'" << data
        << "2 using 1:2:3 with lines lw 3.2 lc palette";
    }
    if (with_faults) {
      const std::string marks = fault_table(*say.faults, mesh, view, kMarkHiddenBy * window.extent);
      if (auto done = write_text(marks, folder / (stem + ".dat")); !done) return done;
      c << fault_clauses(*say.faults, stem + ".dat");
    }
    c << "\nunset label 1\nunset label 2\nunset label 3\nunset arrow\n";
    if (with_faults) c << end_of_legend(*say.faults);
    ++index;
  }
  c << "unset multiplot\n";
  return draw_plot({name, kWidth, height, c.str()}, folder);
}

}  // namespace

driver::Result<void> draw_path_on_mesh(std::span<const driver::TickRecord> rows,
                                       const render::TriangleMesh& mesh_W, const PictureInfo& info,
                                       const std::filesystem::path& folder) {
  double force_max = 0.1;
  for (const driver::TickRecord& row : rows) {
    force_max = std::max(force_max, length_of(row.f_sent_W));
  }
  return draw_views(rows, mesh_W, {"Way of the tip: " + info.title, "mm", 1000, force_max},
                    "path_on_mesh", folder);
}

driver::Result<void> draw_mesh(const render::TriangleMesh& mesh,
                               const std::filesystem::path& picture, const std::string& title,
                               const std::string& unit, const render::MeshFindings* faults) {
  if (mesh.vertices.empty()) return driver::Error{"A mesh without vertices cannot be drawn."};
  const std::string ending = picture.extension().string();
  if (ending != ".png" && ending != ".svg") {
    return driver::Error{picture.string() + ": a picture's name must end in .png or .svg."};
  }
  // Data and script go to a folder of their own, so that only the picture is left behind.
  std::string pattern = (std::filesystem::temp_directory_path() / "thimble-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    return driver::Error{"Cannot make a temporary folder like " + pattern + "."};
  }
  const std::filesystem::path folder = pattern;
  driver::Result<void> done = make_picture_folder(folder);
  if (done) done = draw_views({}, mesh, {title, unit, 1, 0, faults}, "mesh", folder);
  std::error_code status;
  if (done) {
    std::filesystem::copy_file(folder / ("mesh" + ending), picture,
                               std::filesystem::copy_options::overwrite_existing, status);
    if (status) {
      done = driver::Error{"Cannot write " + picture.string() + ": " + status.message() + "."};
    }
  }
  std::filesystem::remove_all(folder, status);
  return done;
}

}  // namespace thimble::app
