#include "report/pictures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "report/picture_style.h"

namespace thimble::report {

std::string quote(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'')
      quoted += "''";
    else
      quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "'";
}

std::string number(double value) {
  return fmt::format("{:.9g}", value);
}

std::string quiet_style() {
  return std::string("set border 3 lw 1 lc rgb '") + kFaintInk +
         "'\nset tics nomirror out scale 0.6 textcolor rgb '" + kInk +
         "'\nset grid xtics ytics lt 1 lw 1 lc rgb '" + kGridInk + "'\nset title textcolor rgb '" +
         kInk + "'\n";
}

double tic_step(double range, int count) {
  const double rough = range / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (rough <= factor * power * 1.0001) return factor * power;
  }
  return 10 * power;
}

NamedTics named_tics(double low, double high, double sign, int count) {
  const double step = tic_step(high - low, count);
  NamedTics tics{"(", 0};
  for (double k = std::ceil(low / step); k * step <= high; ++k) {
    const std::string words = number(k == 0 ? 0 : sign * k * step);  // avoids -0
    tics.list += (tics.list.size() > 1 ? ", '" : "'") + words + "' " + number(k * step);
    tics.width = std::max(tics.width, text_width(words));
  }
  tics.list += ")";
  return tics;
}

double text_width(const std::string& text, double points) {
  // DejaVu Sans: digits are 0.64 em wide, words 0.6 on average; 72 points are 96 pixels [measured].
  constexpr double kCharacter = 0.64 * 96 / 72;
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;  // the first byte of a character
  });
  return kCharacter * points * static_cast<double>(characters);
}

std::string fitted(const std::string& text, double pixels, double points) {
  std::string cut = text;
  while (!cut.empty() && text_width(cut + (cut.size() < text.size() ? "…" : ""), points) > pixels) {
    cut.pop_back();  // only a character's first byte has a width, so remove whole characters
  }
  return cut.size() < text.size() ? cut + "…" : text;
}

double length_of(const std::array<double, 3>& v) {
  return std::hypot(v[0], v[1], v[2]);
}

double time_of(const driver::TickRecord& row, const driver::TickRecord& first) {
  return 1e-9 * static_cast<double>(row.time_ns - first.time_ns);
}

std::vector<std::pair<double, double>> contact_intervals(std::span<const driver::TickRecord> rows,
                                                         double gap) {
  std::vector<std::pair<double, double>> intervals;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].in_contact) continue;
    const double begin = time_of(rows[i], rows.front());
    const double end = time_of(rows[std::min(i + 1, rows.size() - 1)], rows.front());
    if (!intervals.empty() && begin - intervals.back().second <= gap) {
      intervals.back().second = end;
    } else {
      intervals.emplace_back(begin, end);
    }
  }
  return intervals;
}

driver::Result<void> make_picture_folder(const std::filesystem::path& folder) {
  std::error_code status;
  std::filesystem::create_directories(folder / "data", status);
  if (status) {
    return driver::Error{"Cannot create the folder " + (folder / "data").string() + ": " +
                         status.message() + "."};
  }
  return {};
}

driver::Result<void> draw_pictures(std::span<const driver::TickRecord> rows,
                                   const render::TriangleMesh& mesh_W, const PictureInfo& info,
                                   const std::filesystem::path& folder) {
  if (auto done = make_picture_folder(folder); !done) return done;
  if (rows.size() > 1) {
    if (auto done = draw_force_and_depth(rows, info, folder); !done) return done;
    if (!mesh_W.vertices.empty()) {
      if (auto done = draw_path_on_mesh(rows, mesh_W, info, folder); !done) return done;
    }
  }
  if (info.virtual_time) return {};  // virtual time: exact periods, no computing times
  PictureInfo complete = info;
  session::Histogram period;
  session::Histogram work;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0) period.add(rows[i].time_ns - rows[i - 1].time_ns);
    work.add(rows[i].work_ns);
  }
  if (complete.period_times == nullptr) complete.period_times = &period;
  if (complete.work_times == nullptr) complete.work_times = &work;
  if (complete.period_times->count() == 0) return {};
  return draw_period_histogram(complete, folder);
}

}  // namespace thimble::report
