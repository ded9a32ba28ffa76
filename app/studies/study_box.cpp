#include "studies/study_box.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "field/entry_face_contact.h"
#include "field/primitive_contact.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

constexpr double kStiffness = 1000;  // N/m, as in PHYSICS 3
constexpr double kHalf = 0.015;      // m, of the square
// Arrows per row and column: with different numbers none is where two wedges meet.
constexpr int kColumns = 8, kRows = 7;
constexpr double kForceMax = 8.5;  // N, of a PHANTOM [PHYSICS 0]

driver::DeviceState at(const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return state;
}

/// Returns the force at a position reached in a straight line from another.
template <class Contact>
Vector3d force_after(const Contact& contact, const Vector3d& from, const Vector3d& to) {
  render::ContactForceLaw touch{contact, render::SpringDamper{kStiffness, 0}};
  touch(at(from));
  return touch(at(to)).f_T_W;
}

/// Presses a tip through a plate. Returns the largest force before it passes to the back, or 0 if
/// it does not up to kForceMax.
template <class Contact>
double pops_at(const Contact& contact, double half_thickness) {
  render::ContactForceLaw touch{contact, render::SpringDamper{kStiffness, 0}};
  double largest = 0;
  for (double z = 2 * half_thickness; kStiffness * (half_thickness - z) < kForceMax; z -= 1e-6) {
    const double push = touch(at({0, 0, z})).f_T_W.z();
    if (push < 0) return largest;
    largest = std::max(largest, push);
  }
  return 0;
}

std::string table() {
  const render::Box cube{.half_sides = Vector3d::Constant(kHalf)};
  std::ostringstream text;
  text << "# x mm, z mm, force N along x and z: entered from the top; from the right; in "
          "wedges\n";
  for (int i = 0; i < kColumns; ++i) {
    for (int k = 0; k < kRows; ++k) {
      const double x = kHalf * (2.0 * (i + 0.5) / kColumns - 1);
      const double z = kHalf * (2.0 * (k + 0.5) / kRows - 1);
      const Vector3d p(x, 0, z);
      const Vector3d top = force_after(render::EntryFaceContact(cube), {x, 0, 0.05}, p);
      const Vector3d right = force_after(render::EntryFaceContact(cube), {0.05, 0, z}, p);
      const Vector3d wedge =
          force_after(render::PrimitiveContact(render::WedgeBox{cube}), {x, 0, 0.05}, p);
      text << 1e3 * x << ' ' << 1e3 * z;
      for (const Vector3d& f : {top, right, wedge}) text << ' ' << f.x() << ' ' << f.z();
      text << '\n';
    }
  }
  return text.str();
}

driver::Result<void> draw(const std::filesystem::path& folder) {
  // mm per N, so that the longest arrow does not reach beyond the next row.
  const std::string scale = "0.125";
  std::ostringstream c;
  const auto panel = [&](double left, const std::string& title, const std::string& plots) {
    c << "set lmargin at screen " << report::number(left) << "\nset rmargin at screen "
      << report::number(left + 0.4) << "\nset title " << report::quote(title)
      << " noenhanced font ',18'\nplot " << plots << "\n";
  };
  const auto arrows = [&](int column, const char* ink, const char* legend) {
    return "'box.csv' using 1:2:($" + std::to_string(column) + "*" + scale + "):($" +
           std::to_string(column + 1) + "*" + scale +
           ") with vectors head size 0.5,22 filled lw 2 lc rgb '" + ink + "' title '" + legend +
           "'";
  };
  c << report::quiet_style()
    << "set multiplot\nset label 1 'Force over a square' at screen 0.075, screen "
       "0.95 font ',22' textcolor rgb '"
    << report::kInk
    << "'\nset label 2 'surface of 1 N/mm; the longest arrow is 28 N' at screen 0.965, screen "
       "0.95 right textcolor rgb '"
    << report::kInk << "'\nset tmargin at screen 0.81\nset bmargin at screen 0.11\nunset grid\n"
    << "set xrange [-18:18]\nset yrange [-18:18]\nset xlabel 'x [mm]'\nset ylabel 'z [mm]' offset "
       "1,0\nset object 1 rectangle from -15,-15 to 15,15 fc rgb '"
    << report::kContactFill << "' fs solid border lc rgb '" << report::kFaintInk
    << "' behind\nset key at graph 0.5, 1.0 center bottom horizontal textcolor rgb '"
    << report::kInk << "'\nset title offset 0,1.6\n";
  panel(0.075, "entry_face: depends on the path (Fig. 2a)",
        arrows(3, report::kForceInk, "entered from above") + ", " +
            arrows(5, report::kDepthInk, "entered from the right"));
  c << "unset label 1\nunset label 2\nset arrow 1 from -15,-15 to 15,15 nohead dt 2 lc rgb '"
    << report::kFaintInk << "'\nset arrow 2 from -15,15 to 15,-15 nohead dt 2 lc rgb '"
    << report::kFaintInk << "'\n";
  panel(0.565, "wedges: the nearest face pushes (Fig. 2b)",
        arrows(7, report::kForceInk, "independent of the path"));
  c << "unset multiplot\n";
  return report::draw_plot({"box", 1600, 900, c.str()}, folder);
}

}  // namespace

driver::Result<std::vector<session::Figure>> study_box(const std::filesystem::path& folder) {
  if (auto written = report::write_text(table(), folder / "box.csv"); !written)
    return written.error();
  if (report::has_gnuplot()) {
    if (auto made = report::make_picture_folder(folder); !made) return made.error();
    if (auto drawn = draw(folder); !drawn) return drawn.error();
  }
  // A plate of 2 mm: stiffness * thickness / 2 = 1 N [PHYSICS 3].
  const render::Box plate{.half_sides = {0.05, 0.05, 0.001}};
  return std::vector<session::Figure>{
      {"plate_2mm_pops_at_in_wedges",
       pops_at(render::PrimitiveContact(render::WedgeBox{plate}), 0.001), "N", "<= 1.001"},
      {"plate_2mm_pops_at_by_entry_face", pops_at(render::EntryFaceContact(plate), 0.001), "N",
       "== 0"}};
}

}  // namespace thimble::studies
