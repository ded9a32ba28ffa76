#include "studies/study_texture.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>

#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "surface/texture/height_map.h"
#include "surface/texture/sandpaper.h"
#include "surface/texture/sines.h"
#include "thimble/render/field/half_space.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;
using Force = std::function<Vector3d(const Vector3d&)>;  // N, at a position in W, m

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kStiffness = 800;    // N/m, the vintage arm's declared limit [DEVICES 3]
constexpr double kDepth = 0.002;      // m
constexpr double kSpeed = 0.05;       // m/s, a calm stroke [chosen]
constexpr double kRate = 1000;        // Hz
constexpr int kTicks = 4000;          // lines of 0.25 Hz, which include all expected frequencies
constexpr double kEncoder = 0.00003;  // m [PHYSICS 0]

/// One expected line of the force, from the settings.
struct Line {
  double frequency = 0;  // Hz
  double amplitude = 0;  // N
};

struct Subject {
  std::string name, says;
  Force force;
  std::vector<Line> asked;
  double band_end = 0;  // Hz; 0: lines only
};

/// Returns the force of a textured wall, for positions that are always in contact.
template <class Stage>
Force wall_with(const Stage& stage) {
  return [stage](const Vector3d& p_W) {
    driver::DeviceState state;
    state.p_WT = p_W;
    render::SurfaceResponse feel;
    feel.contact = {.touching = true,
                    .triangle = 0,
                    .depth = -p_W.z(),
                    .n_W = Vector3d::UnitZ(),
                    .p_WP = {p_W.x(), p_W.y(), 0}};
    render::SpringDamper spring{kStiffness, 0};
    stage.touch(state, feel);
    spring.touch(state, feel);
    return feel.f_T_W;
  };
}

render::Sines::Settings three_waves(render::TextureForm form) {
  render::Sines::Settings settings;
  settings.form = form;
  settings.waves = {
      {.amplitude = 0.0001, .wavelength = 0.004, .direction = {1, 0, 0}, .phase = 0.3},
      {.amplitude = 0.00003, .wavelength = 0.001, .direction = {1, 0, 0}, .phase = 1.1},
      // Oblique: along x its wavelength is longer by 1 / cos 60 degrees.
      {.amplitude = 0.00001,
       .wavelength = 0.00025,
       .direction = {1, std::numbers::sqrt3, 0},
       .phase = 2}};
  return settings;
}

/// Returns a picture of sine stripes, 16 pixels each.
render::HeightMap::Settings stripes(render::TextureForm form) {
  std::vector<float> values;
  values.reserve(16);
  for (int k = 0; k < 16; ++k) {
    values.push_back(static_cast<float>(0.5 + 0.5 * std::sin(kTurn * k / 16)));
  }
  render::HeightMap::Settings settings;
  settings.form = form;
  settings.image = std::make_shared<const render::HeightImage>(16, 1, std::move(values));
  settings.width = 0.002;
  settings.height = 0.0001;
  settings.along = render::HeightMap::Along::kZ;
  return settings;
}

std::vector<Subject> subjects(render::TextureForm form) {
  const render::EffectContext known;
  std::vector<Subject> all;
  const auto waves = three_waves(form);
  Subject sines{"sines",
                "waves of 4, 1 and 0.25 mm, the last at 60 degrees",
                wall_with(render::Sines(waves, known)),
                {}};
  for (const auto& wave : waves.waves) {
    const double along = std::abs(wave.direction.normalized().x()) / wave.wavelength;
    sines.asked.push_back({kSpeed * along, kStiffness * wave.amplitude});
  }
  all.push_back(std::move(sines));
  render::Sandpaper::Settings rough;
  rough.form = form;
  all.push_back({"sandpaper",
                 "wavelength 2 mm, roughness 0.03 mm",
                 wall_with(render::Sandpaper(rough, known)),
                 {},
                 kSpeed * std::numbers::sqrt2 / rough.wavelength});
  const auto map = stripes(form);
  // The spline attenuates a sine of 16 pixels by this factor.
  const double kept = (4 + 2 * std::cos(kTurn / 16)) / 6;
  all.push_back({"height_map",
                 "a picture of sine stripes 2 mm apart, 16 pixels each",
                 wall_with(render::HeightMap(map, known)),
                 {{kSpeed / map.width, kept * kStiffness * map.height / 2}}});
  return all;
}

/// Returns the amplitudes of the normal force (along z) while sliding along x, one per line of the
/// spectrum. For noise, which has no lines, Hann's window is used.
std::vector<double> spectrum_of(const Force& force, double step, bool noise) {
  std::vector<std::complex<double>> push;
  for (int k = 0; k < kTicks; ++k) {
    double x = kSpeed * k / kRate;
    if (step > 0) x = step * std::round(x / step);
    const double window = noise ? 1 - std::cos(kTurn * k / kTicks) : 1;
    push.emplace_back(window * force({x, 0, -kDepth}).z());
  }
  std::vector<std::complex<double>> turn;
  turn.reserve(kTicks);
  for (int k = 0; k < kTicks; ++k) turn.push_back(std::polar(1.0, -kTurn * k / kTicks));
  std::vector<double> amplitude;
  for (std::size_t line = 0; line < kTicks / 2; ++line) {
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < kTicks; ++k) sum += push[k] * turn[line * k % kTicks];
    amplitude.push_back(std::abs(sum) * (line == 0 ? 1 : 2) / kTicks);
  }
  return amplitude;
}

double at_frequency(const std::vector<double>& spectrum, double frequency) {
  return spectrum[static_cast<std::size_t>(std::lround(frequency * kTicks / kRate))];
}

/// Returns the work around a closed path below the surface, as a fraction of the work in and out.
double work_around(const Force& force) {
  constexpr int kSteps = 20000;
  double work = 0, gross = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = kTurn * i / kSteps;
    const Vector3d p(0.0006 * std::cos(s), 0.0004 * std::sin(s), -0.002 + 0.0007 * std::sin(s + 1));
    const Vector3d way(-0.0006 * std::sin(s), 0.0004 * std::cos(s), 0.0007 * std::cos(s + 1));
    const double power = force(p).dot(way);
    work += power;
    gross += std::abs(power);
  }
  return std::abs(work) / gross;
}

struct Measured {
  Subject subject;
  std::vector<double> ideal, encoder;  // N per line
};

std::string spectra_csv(const std::vector<Measured>& all) {
  std::ostringstream text;
  text << "frequency_Hz";
  for (const Measured& one : all) {
    text << ',' << one.subject.name << "_N," << one.subject.name << "_with_encoder_N";
  }
  text << '\n';
  for (std::size_t line = 0; line < kTicks / 2; ++line) {
    text << static_cast<double>(line) * kRate / kTicks;
    for (const Measured& one : all) text << ',' << one.ideal[line] << ',' << one.encoder[line];
    text << '\n';
  }
  return text.str();
}

std::string lines_csv(const std::vector<Measured>& all) {
  std::ostringstream text;
  text.precision(12);
  text << "texture,frequency_Hz,asked_N,measured_N,measured_with_encoder_N\n";
  for (const Measured& one : all) {
    for (const Line& line : one.subject.asked) {
      text << one.subject.name << ',' << line.frequency << ',' << line.amplitude << ','
           << at_frequency(one.ideal, line.frequency) << ','
           << at_frequency(one.encoder, line.frequency) << '\n';
    }
  }
  return text.str();
}

std::string panel(const Measured& one, std::size_t index, std::size_t count) {
  // A spectrum spans many decades; below a millinewton it cannot be felt.
  constexpr double kFloor = 1e-5;
  std::ostringstream data;
  data << "$asked" << index << " << EOD\n";
  for (const Line& line : one.subject.asked) {
    data << report::number(line.frequency) << ',' << report::number(line.amplitude) << '\n';
  }
  if (one.subject.asked.empty()) data << "nan,nan\n";
  data << "EOD\n";
  const double height = 0.86 / static_cast<double>(count);
  const double top = 0.94 - static_cast<double>(index) * height;
  const bool last = index + 1 == count;
  const std::size_t column = 2 + 2 * index;
  data << "set tmargin at screen " << report::number(top - 0.05) << "\nset bmargin at screen "
       << report::number(top - height + 0.045) << "\nset title "
       << report::quote(one.subject.name + ": " + one.subject.says)
       << " noenhanced offset 0,-0.4\nset xlabel " << (last ? "'frequency [Hz]'" : "''")
       << "\nset ylabel 'force [N]' offset 1,0\n";
  if (one.subject.band_end > 0) {
    data << "set arrow 9 from " << report::number(one.subject.band_end) << ", graph 0 to "
         << report::number(one.subject.band_end) << ", graph 1 nohead dt 2 lw 2 lc rgb '"
         << report::kDepthInk << "'\nset label 9 'end of its band' at "
         << report::number(one.subject.band_end) << ", graph 0.85 offset 1,0 textcolor rgb '"
         << report::kDepthInk << "'\n";
  }
  data << "plot 'spectra.csv' using 1:($" << column + 1 << "<" << kFloor << "?" << kFloor << ":$"
       << column + 1 << ") with lines lw 1 lc rgb '#b8bec7' title "
       << (index == 0 ? "'positions in steps of 0.03 mm'" : "''") << ", '' using 1:($" << column
       << "<" << kFloor << "?" << kFloor << ":$" << column << ") with lines lw 2 lc rgb '"
       << report::kForceInk << "' title " << (index == 0 ? "'ideal positions'" : "''") << ", $asked"
       << index << " using 1:2 with points pt 6 ps 2 lw 2 lc rgb '" << report::kDepthInk
       << "' title " << (index == 0 ? "'requested'" : "''") << "\nunset arrow 9\nunset label 9\n";
  return data.str();
}

driver::Result<void> draw(const std::vector<Measured>& all, const std::filesystem::path& folder) {
  std::ostringstream c;
  c << report::quiet_style() << "set datafile separator ','\nset multiplot\nset label 1 "
    << report::quote("Force of textures while sliding at 50 mm/s, 2 mm deep, 800 N/m")
    << " at screen 0.085, screen 0.96 font ',22' textcolor rgb '" << report::kInk
    << "'\nset lmargin at screen 0.085\nset rmargin at screen 0.975\nset xrange [0:250]\n"
    << "set logscale y\nset yrange [1e-5:0.3]\nset format y '10^{%T}'\n"
    << "set key inside right top vertical textcolor rgb '" << report::kInk
    << "'\nset datafile missing 'nan'\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    c << panel(all[i], i, all.size());
    if (i == 0) c << "unset label 1\n";
  }
  c << "unset multiplot\n";
  return report::draw_plot({"texture_spectra", 1600, 1100, c.str()}, folder);
}

}  // namespace

driver::Result<std::vector<session::Figure>> study_texture(const std::filesystem::path& folder) {
  std::vector<Measured> all;
  std::vector<session::Figure> figures;
  for (Subject& subject : subjects(render::TextureForm::kDepthOnly)) {
    const std::string name = subject.name;
    Measured one{std::move(subject), {}, {}};
    const bool noise = one.subject.band_end > 0;
    one.ideal = spectrum_of(one.subject.force, 0, noise);
    one.encoder = spectrum_of(one.subject.force, kEncoder, noise);
    double error = 0, encoder_error = 0;
    for (const Line& line : one.subject.asked) {
      error =
          std::max(error, std::abs(at_frequency(one.ideal, line.frequency) / line.amplitude - 1));
      encoder_error = std::max(
          encoder_error, std::abs(at_frequency(one.encoder, line.frequency) / line.amplitude - 1));
    }
    if (!one.subject.asked.empty()) {
      figures.push_back({name + "_line_error", 100 * error, "%", "<= 0.1"});
      figures.push_back({name + "_line_error_with_encoder", 100 * encoder_error, "%", ""});
    }
    if (one.subject.band_end > 0) {
      double within = 0, beyond = 0;
      for (std::size_t line = 4; line < one.ideal.size(); ++line) {
        const double frequency = static_cast<double>(line) * kRate / kTicks;
        (frequency <= one.subject.band_end ? within : beyond) += one.ideal[line] * one.ideal[line];
      }
      figures.push_back({name + "_power_beyond_band", 100 * beyond / within, "%", "<= 0.1"});
    }
    figures.push_back(
        {name + "_work_around_depth_only", 100 * work_around(one.subject.force), "%", ""});
    all.push_back(std::move(one));
  }
  for (const Subject& subject : subjects(render::TextureForm::kConservative)) {
    figures.push_back(
        {subject.name + "_work_around", 100 * work_around(subject.force), "%", "<= 1e-7"});
  }
  for (const auto& [name, text] :
       {std::pair{"spectra.csv", spectra_csv(all)}, {"lines.csv", lines_csv(all)}}) {
    if (auto written = report::write_text(text, folder / name); !written) return written.error();
  }
  if (report::has_gnuplot()) {
    if (auto made = report::make_picture_folder(folder); !made) return made.error();
    if (auto drawn = draw(all, folder); !drawn) return drawn.error();
  }
  return figures;
}

}  // namespace thimble::studies
