#include "studies/world/world_pictures.h"

#include <fmt/core.h>

#include <cmath>
#include <sstream>
#include <string>

#include "report/gnuplot.h"
#include "report/picture_style.h"

namespace thimble::studies {
namespace {

constexpr int kWidth = 1200, kHeight = 560;  // pixels; the guide shows half of it [chosen]
constexpr const char* kTipInk = report::kDepthInk;
constexpr const char* kProxyInk = report::kForceInk;
constexpr const char* kSolidFill = "#e3e7ec";

std::string ink(const char* colour) {
  return std::string(" textcolor rgb '") + colour + "'";
}

/// The two halves of a picture.
struct Half {
  double left, right;  // fractions of the picture
};
constexpr Half kLeft{0.07, 0.48}, kRight{0.57, 0.98};
constexpr double kLow = 0.16, kHigh = 0.79;  // of the axes, in fractions of the picture

/// Returns commands for the axes of a section, with the same scale along both. Heights in mm.
std::string section_axes(double low, double high) {
  const double half =
      (high - low) / 2 * kWidth * (kLeft.right - kLeft.left) / (kHeight * (kHigh - kLow));
  return fmt::format(
      "set tmargin at screen {}\nset bmargin at screen {}\nset xrange [{}:{}]\nset yrange "
      "[{}:{}]\nset xtics 4\nset ytics 4\nunset grid\nset xlabel 'x [mm]'{}\nset ylabel 'z [mm]' "
      "offset 1.5,0{}\n",
      kHigh, kLow, -half, half, low, high, ink(report::kInk), ink(report::kInk));
}

/// Returns commands for one half with its title above the axes.
std::string half(const Half& which, const std::string& title) {
  return "set lmargin at screen " + report::number(which.left) + "\nset rmargin at screen " +
         report::number(which.right) + "\nset label 2 " + report::quote(title) + " at screen " +
         report::number(which.left) + ", screen 0.84 font ',18' noenhanced" + ink(report::kInk) +
         "\n";
}

std::string head(const std::string& title) {
  return report::quiet_style() + "set datafile separator ','\nset multiplot\nset label 1 " +
         report::quote(title) + " at screen 0.07, screen 0.945 font ',22' noenhanced" +
         ink(report::kInk) + "\n";
}

std::string seam_commands() {
  const std::string from = report::number(-1e3 * kSeamHalfWay);
  const std::string to = report::number(1e3 * kSeamHalfWay);
  std::ostringstream c;
  c << head("A tip slides 0.8 mm deep over the seam of two flush boxes")
    << "set tmargin at screen 0.78\nset bmargin at screen 0.16\nset xrange [" << from << ':' << to
    << "]\nset yrange [-3.6:1.2]\nset xtics 2\nset ytics 1\nset xlabel 'position of the tip [mm]'"
    << ink(report::kInk) << "\nset ylabel 'force on the hand [N]' offset 1,0" << ink(report::kInk)
    << "\nset arrow 1 from 0, graph 0 to 0, graph 1 nohead dt 2 lc rgb '" << report::kFaintInk
    << "'\nset label 3 'seam' at 0.15, -3.25" << ink(report::kFaintInk) << "\n";
  const auto plot = [&c](int first) {
    const std::string tip = std::to_string(first);
    c << "plot 'seam.csv' using " << tip << ':' << first + 5 << " with lines lw 3 lc rgb '"
      << report::kForceInk << "' notitle, '' using " << tip << ':' << first + 4
      << " with lines lw 3 lc rgb '" << report::kDepthInk << "' notitle\n";
  };
  c << half(kLeft, "before: one proxy for each box") << "set label 4 'upwards' at -3.8, 0.88"
    << ink(report::kForceInk) << "\nset label 5 'against the motion' at -3.8, -0.3"
    << ink(report::kDepthInk) << "\n";
  plot(1);
  c << "unset label 1\n" << half(kRight, "now: one proxy for both boxes");
  plot(7);
  c << "unset multiplot\n";
  return c.str();
}

std::string place(const Eigen::Vector3d& p_W) {
  return report::number(1e3 * p_W.x()) + "," + report::number(1e3 * p_W.z());
}

/// Returns commands that draw tip, proxy and the spring between them, as objects 11 to 13.
std::string marks_of(const WorldTick& tick) {
  const auto disc = [](int number, const Eigen::Vector3d& p_W, const char* colour) {
    return "set object " + std::to_string(number) + " circle at " + place(p_W) +
           " size screen 0.008 fc rgb '" + colour + "' fs solid border lc rgb '" + colour +
           "' front\n";
  };
  return "set arrow 13 from " + place(tick.p_WT) + " to " + place(tick.p_WP) +
         " nohead dt 3 lw 2 lc rgb '" + report::kInk + "'\n" + disc(11, tick.p_WP, kProxyInk) +
         disc(12, tick.p_WT, kTipInk);
}

std::string block_commands(const ComparedTouch& block) {
  const std::string height = report::number(1e3 * kBlockHeight);
  std::ostringstream c;
  c << head("A hand presses a table and pulls to the right, against a block") << section_axes(-4, 9)
    << "set object 1 rectangle from graph 0, graph 0 to graph 1, first 0 fc rgb '" << kSolidFill
    << "' fs solid noborder behind\nset object 2 rectangle from 0,0 to graph 1, first " << height
    << " fc rgb '" << report::kContactFill << "' fs solid border lc rgb '" << report::kFaintInk
    << "' behind\nset label 3 'block' at 8.6, 5.2 right" << ink(report::kFaintInk)
    << "\nset label 4 'table' at -8.6, -3.3" << ink(report::kFaintInk)
    << "\nset label 5 'tip' at -7.4, 2.2" << ink(kTipInk) << "\nset label 6 'proxy' at -4.2, 0.7"
    << ink(kProxyInk) << "\n";
  const auto plot = [&c](int first, const WorldTick& last) {
    c << marks_of(last) << "set label 7 "
      << report::quote(fmt::format("{:.2f} N sideways", std::abs(last.f_T_W.x())))
      << " at 8.6, -3.3 right" << ink(report::kInk) << "\nplot 'block.csv' using " << first + 2
      << ':' << first + 3 << " with lines lw 3 lc rgb '" << kProxyInk << "' notitle, '' using "
      << first << ':' << first + 1 << " with lines lw 3 lc rgb '" << kTipInk << "' notitle\n";
  };
  c << half(kLeft, "before: one proxy for each object");
  plot(1, block.alone.back());
  c << "unset label 1\n" << half(kRight, "now: one proxy for both objects");
  plot(7, block.together.back());
  c << "unset multiplot\n";
  return c.str();
}

std::string groove_commands(const WorldTick& point, const WorldTick& ball) {
  const double rim = 1e3 * kGrooveDepth * std::tan(kGrooveHalfAngle);
  const std::string depth = report::number(1e3 * kGrooveDepth);
  const std::string radius = report::number(1e3 * kGrooveRadius);
  const std::string left = report::number(-rim) + "," + depth;
  const std::string right = report::number(rim) + "," + depth;
  std::ostringstream walls;
  walls << "set object 1 polygon from graph 0, graph 0 to graph 0, first " << depth << " to "
        << left << " to 0,0 to " << right << " to graph 1, first " << depth
        << " to graph 1, graph 0 to graph 0, graph 0 fc rgb '" << kSolidFill
        << "' fs solid noborder behind\nset arrow 1 from 0,0 to " << left
        << " nohead lw 1.5 lc rgb '" << report::kFaintInk << "'\nset arrow 2 from 0,0 to " << right
        << " nohead lw 1.5 lc rgb '" << report::kFaintInk << "'\n";
  std::ostringstream c;
  c << head("A tip pressed 2 mm into a groove of half angle a = 30°") << section_axes(-3, 14)
    << walls.str();
  const std::string height = report::number(1e3 * ball.p_WP.z());
  const char* const nothing = "plot NaN notitle\n";
  c << half(kLeft, "a point rests on the bottom") << marks_of(point)
    << "set label 3 'proxy' at 1.2, 0.8" << ink(kProxyInk) << "\nset label 4 'tip' at 1.6, -2"
    << ink(kTipInk) << "\n"
    << nothing << "unset label 1\n";
  c << half(kRight, "a ball (R = 4 mm) touches both sides") << marks_of(ball)
    << "set label 3 'proxy' at 0, 9.5 center" << ink(kProxyInk)
    << "\nset label 4 'tip' at 0, 5.6 right" << ink(kTipInk) << "\nset object 3 circle at "
    << place(ball.p_WP) << " size first " << radius << " fc rgb '" << kProxyInk
    << "' fs transparent solid 0.1 border lc rgb '" << kProxyInk
    << "' lw 2\nset arrow 3 from 9.4,0 to 9.4," << height
    << " heads size 0.5,20 filled lw 1.5 lc rgb '" << report::kInk
    << "'\nset arrow 4 from 0.4,0 to 10.1,0 nohead dt 2 lc rgb '" << report::kInk
    << "'\nset arrow 5 from 0.4," << height << " to 10.1," << height << " nohead dt 2 lc rgb '"
    << report::kInk << "'\nset label 5 " << report::quote("R / sin a")
    << " at 9, 4.8 right noenhanced" << ink(report::kInk) << "\nset label 6 "
    << report::quote(fmt::format("= {:.2f} mm", 1e3 * ball.p_WP.z()))
    << " at 9, 3.4 right noenhanced" << ink(report::kInk) << "\n"
    << nothing << "unset multiplot\n";
  return c.str();
}

}  // namespace

driver::Result<void> draw_world(const WorldTouches& touches, const std::filesystem::path& folder) {
  for (const report::Plot& plot :
       {report::Plot{"seam", kWidth, kHeight, seam_commands()},
        report::Plot{"block", kWidth, kHeight, block_commands(touches.block)},
        report::Plot{"groove", kWidth, kHeight,
                     groove_commands(touches.point.back(), touches.ball.back())}}) {
    if (auto drawn = report::draw_plot(plot, folder); !drawn) return drawn;
  }
  return {};
}

}  // namespace thimble::studies
