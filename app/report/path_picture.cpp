#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "output/output_file.h"
#include "report/fault_marks.h"
#include "report/figure_output.h"
#include "report/gnuplot.h"
#include "report/mesh_view.h"
#include "report/picture_style.h"
#include "text_file.h"

namespace thimble::report {
namespace {

using Eigen::Vector3d;

constexpr int kPixels = 760;  // of a view's side; a panel is about 500 wide in the PNG
constexpr std::size_t kPointsMax = 4000;
constexpr double kHiddenBy = 0.01;  // of the extent: the tip is in the surface, not behind it
// Deformable bodies are drawn undeformed: a dent in a face towards the eye hides nothing.
constexpr double kDentHiddenBy = 0.1;  // of the extent
constexpr double kTurnedToEye = 0.3;   // cosine between the force on the hand and the line of sight
constexpr double kMarkHiddenBy = 0.004;  // of the extent: marks are in the surface to rounding

// The picture's layout, pixels. The panels get the space left by the labels.
constexpr double kWidth = 1800;
constexpr double kEdge = 18;        // margin
constexpr double kNameHeight = 30;  // height of an axis name
constexpr double kTicGap = 18;      // between a panel and its numbers
constexpr double kBelow = 97;       // for numbers and the axis name below a panel
constexpr double kColours = 22;     // width of the colour scale, and its distance from the panel
constexpr double kRow = 44;         // height of a line of text

// Viridis by van der Walt and Smith (CC0), at nine even steps; without its light end, because
// yellow is invisible on light grey.
constexpr const char* kPalette =
    "set palette defined (0 '#440154', 0.125 '#472d7b', 0.25 '#3b528b', 0.375 '#2c728e', "
    "0.5 '#21918c', 0.625 '#28ae80', 0.75 '#5ec962', 0.875 '#addc30', 1 '#dce319')\n";

constexpr const char* kHiddenInk = "#7d5a8a";  // of a path behind the mesh

struct Window {
  Vector3d center{0, 0, 0};
  double extent = 1;
};

Vector3d to_vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

// Returns a window with the whole mesh and the near part of the path: with a far start the mesh
// would be tiny. The margin is larger for an object that moves with the tip.
Window window_of(const render::TriangleMesh& mesh, std::span<const driver::TickRecord> rows) {
  const Eigen::AlignedBox3d mesh_box = box_of(mesh);
  const double side = std::max(mesh_box.sizes().maxCoeff(), 1e-9);
  Eigen::AlignedBox3d box = mesh_box;
  for (const driver::TickRecord& row : rows) {
    const Vector3d beyond = Vector3d::Constant((row.in_contact ? 2 : 0.2) * side);
    const Vector3d p_WT =
        to_vector(row.p_WT).cwiseMax(mesh_box.min() - beyond).cwiseMin(mesh_box.max() + beyond);
    if (p_WT.squaredNorm() < HUGE_VAL) box.extend(p_WT);
  }
  return {box.center(), 1.08 * box.sizes().maxCoeff()};
}

struct PanelText {
  std::string title;
  std::string unit;
  double unit_scale = 1;
  double force_max = 0;                          // N; 0: no path, no colours
  const render::MeshFindings* faults = nullptr;  // null: no marks
};

/// Position of one panel, pixels from the lower left corner, and its range.
struct Panel {
  const ViewDirection* direction = nullptr;
  Eigen::Vector2d low{0, 0}, high{0, 0};  // in the unit of the axes
  double left = 0;                        // pixels
  std::string u_tics, v_tics;
  double room = 0;  // width of the numbers on its left, pixels
};

// Returns the path in one view as text: u, v, force; blank lines end a stretch. Three blocks: free
// air, hidden by the mesh, visible.
std::string path_table(std::span<const driver::TickRecord> rows, const MeshView& view,
                       const Panel& panel, double extent, double scale) {
  enum PathPart { kFree, kHidden, kSeen };
  std::array<std::ostringstream, 3> block;
  const std::size_t stride = (rows.size() + kPointsMax - 1) / kPointsMax;
  int last_kind = -1;
  for (std::size_t i = 0; i < rows.size(); i += stride) {
    const driver::TickRecord& row = rows[i];
    const Vector3d p_W = to_vector(row.in_contact ? row.p_WP : row.p_WT);
    const Vector3d f_W = to_vector(row.f_sent_W);
    const bool turned_to_eye =
        row.in_contact && f_W.dot(panel.direction->w_W) > kTurnedToEye * f_W.norm();
    const double tolerance = (turned_to_eye ? kDentHiddenBy : kHiddenBy) * extent;
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

/// Positions of everything, pixels.
struct Layout {
  double height = 0;
  double side = 0;  // side of a panel
  std::array<Panel, 3> panels;
  NamedTics force;

  double x(double pixels) const { return pixels / kWidth; }
  double y(double pixels) const { return pixels / height; }
  double top() const { return kBelow + side; }
};

/// Places numbers and names first, so that they never overlap; the panels get the remaining space.
Layout lay_out(const Window& window, const PanelText& texts, bool with_faults) {
  Layout layout;
  const bool with_path = texts.force_max > 0;
  const double half = 0.5 * texts.unit_scale * window.extent;
  double free = kWidth - kEdge;
  if (with_path) {
    layout.force = named_tics(0, texts.force_max, 1, 5);
    free -= 2 * kColours + kTicGap + layout.force.width + kNameHeight;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    Panel& panel = layout.panels[i];
    panel.direction = &view_directions()[i];
    const Eigen::Vector2d middle =
        texts.unit_scale * Eigen::Vector2d(panel.direction->u_W.dot(window.center),
                                           panel.direction->v_W.dot(window.center));
    panel.low = middle - Eigen::Vector2d::Constant(half);
    panel.high = middle + Eigen::Vector2d::Constant(half);
    const NamedTics v = named_tics(panel.low.y(), panel.high.y(), panel.direction->v_sign, 6);
    panel.v_tics = v.list;
    panel.room = kEdge + kNameHeight + v.width + kTicGap;
    free -= panel.room;
  }
  layout.side = std::floor(free / 3);
  double left = 0;
  for (Panel& panel : layout.panels) {
    panel.left = left + panel.room;
    left = panel.left + layout.side;
    // Numbers in a row need room for the widest.
    int count = 6;
    NamedTics u = named_tics(panel.low.x(), panel.high.x(), 1, count);
    while (count > 1 && u.width + kTicGap > layout.side / (count + 1)) {
      u = named_tics(panel.low.x(), panel.high.x(), 1, --count);
    }
    panel.u_tics = u.list;
  }
  layout.height = std::round(layout.top() + (with_faults ? 3 : 2) * kRow + 2 * kEdge);
  return layout;
}

/// Returns commands for the title and the key of the lines at its right.
std::string headings(const Layout& layout, const PanelText& texts, bool with_faults) {
  const double y = layout.y(layout.height - kEdge - kRow / 2);
  double right = kWidth - kEdge;
  std::ostringstream c;
  int id = 2;
  const auto words = [&](const std::string& text, const char* ink) {
    c << "set label " << id << ' ' << quote(text) << " at screen " << number(layout.x(right))
      << ", screen " << number(y) << " right textcolor rgb '" << ink << "'\n";
    right -= text_width(text) + 14;
    ++id;
  };
  const auto line = [&](const std::string& style) {
    c << "set arrow " << id << " from screen " << number(layout.x(right - 54)) << ", screen "
      << number(y) << " to screen " << number(layout.x(right)) << ", screen " << number(y)
      << " nohead " << style << "\n";
    right -= 54 + 40;
  };
  if (texts.force_max > 0) {
    words("in air", kInk);
    line(std::string("lw 1.5 lc rgb '") + kFaintInk + "'");
    words("behind the mesh", kInk);
    line(std::string("lw 2 dt '.' lc rgb '") + kHiddenInk + "'");
  }
  if (with_faults) words("thin and pale: behind the mesh", kFaintInk);
  const double left = layout.panels[0].left;
  c << "set label 1 " << quote(fitted(texts.title, right - 20 - left, 22)) << " at screen "
    << number(layout.x(left)) << ", screen " << number(y)
    << " font ',22' noenhanced textcolor rgb '" << kInk << "'\n";
  if (with_faults) {
    c << fault_legend(*texts.faults, layout.x(left), layout.y(layout.height - kEdge - 1.5 * kRow));
  }
  return c.str();
}

/// Returns commands for the frame of a panel: position, numbers and names.
std::string frame(const Panel& panel, const Layout& layout, const std::string& unit) {
  std::ostringstream c;
  c << "set lmargin at screen " << number(layout.x(panel.left)) << "\nset rmargin at screen "
    << number(layout.x(panel.left + layout.side)) << "\nset bmargin at screen "
    << number(layout.y(kBelow)) << "\nset tmargin at screen " << number(layout.y(layout.top()))
    << "\nset xrange [" << number(panel.low.x()) << ":" << number(panel.high.x())
    << "]\nset yrange [" << number(panel.low.y()) << ":" << number(panel.high.y())
    << "]\nset xtics " << panel.u_tics << "\nset ytics " << panel.v_tics << "\nset xlabel "
    << quote(std::string(panel.direction->u_label) + " [" + unit + "]")
    << " noenhanced textcolor rgb '" << kInk << "'\nset label 50 "
    << quote(std::string(panel.direction->v_label) + " [" + unit + "]") << " at screen "
    << number(layout.x(panel.left - panel.room + kEdge + kNameHeight / 2)) << ", screen "
    << number(layout.y(kBelow + layout.side / 2))
    << " center rotate by 90 noenhanced textcolor rgb '" << kInk << "'\nset title '"
    << panel.direction->name << "' offset 0,-0.5\n";
  return c.str();
}

/// Returns commands for the colour scale of the forces, right of all panels.
std::string colour_scale(const Layout& layout) {
  const double left = layout.panels[2].left + layout.side + kColours;
  std::ostringstream c;
  c << "set colorbox user origin screen " << number(layout.x(left)) << ", screen "
    << number(layout.y(kBelow)) << " size screen " << number(layout.x(kColours)) << ", screen "
    << number(layout.y(layout.side)) << "\nset cbtics " << layout.force.list
    << "\nset label 51 'force on the hand [N]' at screen "
    << number(layout.x(left + kColours + kTicGap + layout.force.width + kNameHeight / 2))
    << ", screen " << number(layout.y(kBelow + layout.side / 2))
    << " center rotate by 90 textcolor rgb '" << kInk << "'\n";
  return c.str();
}

driver::Result<void> draw_views(std::span<const driver::TickRecord> rows,
                                const render::TriangleMesh& mesh, const PanelText& texts,
                                const std::string& name, const std::filesystem::path& folder) {
  const Window window = window_of(mesh, rows);
  const bool with_path = texts.force_max > 0;
  const bool with_faults = texts.faults != nullptr && has_marks(*texts.faults);
  const Layout layout = lay_out(window, texts, with_faults);
  std::ostringstream c;
  c << quiet_style() << "set border 15 lw 1 lc rgb '" << kFaintInk << "'\nunset key\nunset grid\n"
    << "set multiplot\n"
    << headings(layout, texts, with_faults);
  if (with_path) c << kPalette << "set cbrange [0:" << number(texts.force_max) << "]\n";
  int index = 0;
  for (const Panel& panel : layout.panels) {
    const MeshView view(mesh, *panel.direction, window.center, window.extent, kPixels);
    const std::string stem = "data/" + name + "_" + std::to_string(index + 1);
    const std::string image(view.rgb().begin(), view.rgb().end());
    if (auto done = write_text(image, folder / (stem + ".rgb")); !done) return done;
    const double pitch = (panel.high.x() - panel.low.x()) / kPixels;
    c << frame(panel, layout, texts.unit)
      << (with_path && index == 2 ? colour_scale(layout) : "unset colorbox\n") << "plot '" << stem
      << ".rgb' binary array=(" << kPixels << "," << kPixels << ") format='%uchar' origin=("
      << number(panel.low.x() + pitch / 2) << "," << number(panel.low.y() + pitch / 2)
      << ") dx=" << number(pitch) << " dy=" << number(pitch) << " with rgbimage notitle";
    if (with_path) {
      const std::string path = path_table(rows, view, panel, window.extent, texts.unit_scale);
      if (auto done = write_text(path, folder / (stem + ".dat")); !done) return done;
      const std::string data = ", '" + stem + ".dat' index ";
      c << data << "0 using 1:2 with lines lw 1.2 lc rgb '" << kFaintInk << "'" << data
        << "1 using 1:2 with lines lw 1.6 dt '.' lc rgb '" << kHiddenInk << "'" << data
        << "2 using 1:2 with lines lw 6 lc rgb '#ffffff'" << data
        << "2 using 1:2:3 with lines lw 3.2 lc palette";
    }
    if (with_faults) {
      const std::string marks =
          fault_table(*texts.faults, mesh, view, kMarkHiddenBy * window.extent);
      if (auto done = write_text(marks, folder / (stem + ".dat")); !done) return done;
      c << fault_clauses(*texts.faults, stem + ".dat");
    }
    // Only the first panel draws the headings.
    c << "\nunset label 1\nunset label 2\nunset label 3\nunset arrow\n";
    if (with_faults) c << end_of_legend(*texts.faults);
    ++index;
  }
  c << "unset multiplot\n";
  return draw_plot({name, static_cast<int>(kWidth), static_cast<int>(layout.height), c.str()},
                   folder);
}

}  // namespace

driver::Result<void> draw_path_on_mesh(std::span<const driver::TickRecord> rows,
                                       const render::TriangleMesh& mesh_W, const PictureInfo& info,
                                       const std::filesystem::path& folder) {
  double force_max = 0.1;
  for (const driver::TickRecord& row : rows) {
    force_max = std::max(force_max, length_of(row.f_sent_W));
  }
  return draw_views(rows, mesh_W, {"Path of the tip: " + info.title, "mm", 1000, force_max},
                    "path_on_mesh", folder);
}

driver::Result<void> draw_mesh(const render::TriangleMesh& mesh,
                               const std::filesystem::path& picture, const std::string& title,
                               const std::string& unit, const render::MeshFindings* faults) {
  if (mesh.vertices.empty()) return driver::Error{"A mesh without vertices cannot be drawn."};
  const std::string ending = picture.extension().string();
  if (ending != ".png" && ending != ".svg") {
    return driver::Error{picture.string() + ": the name of a picture must end in .png or .svg."};
  }
  // Data and script go to a temporary folder, so that only the picture remains.
  std::string pattern = (std::filesystem::temp_directory_path() / "thimble-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    return driver::Error{"Cannot create a temporary folder like " + pattern + "."};
  }
  const std::filesystem::path folder = pattern;
  driver::Result<void> done = make_picture_folder(folder);
  if (done) done = draw_views({}, mesh, {title, unit, 1, 0, faults}, "mesh", folder);
  std::error_code status;
  if (done) {
    done = output::write_file(picture, output::kind_of_name(picture),
                              scene::text_of(folder / ("mesh" + ending)));
  }
  std::filesystem::remove_all(folder, status);
  return done;
}

}  // namespace thimble::report
