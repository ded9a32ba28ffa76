#include "usb/program_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "usb/board_checks.h"

namespace thimble::usb_test {
namespace {

using Numbers = std::array<double, 3>;

constexpr double kSame = 1e-9;     // N: precision of the text files
constexpr std::size_t kFew = 100;  // ticks with force; with fewer the comparison proves nothing

struct RecordedTick {
  int fresh = 0;
  Numbers counts{}, f_wanted{}, f_sent{};
};

bool same(const Numbers& a, const Numbers& b) {
  return std::abs(a[0] - b[0]) <= kSame && std::abs(a[1] - b[1]) <= kSame &&
         std::abs(a[2] - b[2]) <= kSame;
}

double length(const Numbers& f) {
  return std::hypot(f[0], f[1], f[2]);
}

std::vector<Numbers> read_log(const std::string& file, const std::string& axes) {
  std::vector<Numbers> forces;
  std::ifstream in(file);
  for (Numbers own{}; in >> own[0] >> own[1] >> own[2];) {
    Numbers f_W{};
    for (std::size_t i = 0; i < 3; ++i) f_W[i] = own[static_cast<std::size_t>(axes[i] - 'x')];
    forces.push_back(f_W);
  }
  return forces;
}

std::vector<RecordedTick> read_recording(const std::string& file) {
  std::ifstream in(file);
  std::map<std::string, std::size_t> columns;
  std::string line, field;
  std::getline(in, line);
  std::istringstream heading(line);
  for (std::size_t i = 0; std::getline(heading, field, ','); ++i) {
    columns[field.substr(0, field.find(' '))] = i;
  }
  std::vector<RecordedTick> ticks;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::vector<double> values;
    while (std::getline(fields, field, ',')) values.push_back(std::strtod(field.c_str(), nullptr));
    const auto value = [&](const std::string& name) {
      const auto column = columns.find(name);
      const bool there = column != columns.end() && column->second < values.size();
      return there ? values[column->second] : std::nan("");
    };
    RecordedTick tick;
    tick.fresh = static_cast<int>(value("fresh"));
    for (std::size_t i = 0; i < 3; ++i) {
      tick.counts[i] = value("counts." + std::to_string(i + 1));
      tick.f_wanted[i] = value("f_wanted_W." + std::string(1, "xyz"[i]));
      tick.f_sent[i] = value("f_sent_W." + std::string(1, "xyz"[i]));
    }
    ticks.push_back(tick);
  }
  return ticks;
}

}  // namespace

int trace_of_program(const VirtualArm& arm, const std::string& log, const std::string& axes,
                     const std::string& recording, const std::string& trace) {
  const bool good_axes = axes.size() == 3 && axes.find_first_not_of("xyz") == std::string::npos;
  const std::vector<Numbers> asked = good_axes ? read_log(log, axes) : std::vector<Numbers>{};
  const std::vector<RecordedTick> ticks = read_recording(recording);
  if (asked.empty() || ticks.empty()) {
    return verdict(false, arm.name + " program", "no log or no recording");
  }
  std::FILE* out = std::fopen(trace.c_str(), "we");
  if (out == nullptr) return verdict(false, arm.name + " program", "no trace can be written");
  std::fprintf(out, "0\n");
  std::size_t at = 0, felt = 0, unknown = 0, gate_limited = 0, opening = 0;
  double most = 0;
  bool open = false;  // the gate is open, and a program has switched on the force
  for (const RecordedTick& tick : ticks) {
    std::size_t k = at;
    while (k < asked.size() && !same(asked[k], tick.f_wanted)) ++k;
    const bool pushes = length(tick.f_wanted) > 0;
    const bool known = k < asked.size();
    if (known) at = k;
    open = open || (known && pushes && same(tick.f_wanted, tick.f_sent));
    if (pushes) {
      opening += open ? 0U : 1U;
      unknown += open && !known ? 1U : 0U;
      gate_limited += open && known && !same(tick.f_wanted, tick.f_sent) ? 1U : 0U;
    }
    const bool own = open && known && same(tick.f_wanted, tick.f_sent);
    felt += own && pushes ? 1U : 0U;
    const Numbers& f = own ? asked[k] : tick.f_sent;
    most = std::max(most, own ? length(f) : 0.0);
    std::fprintf(out, "%d %.0f %.0f %.0f %.9f %.9f %.9f\n", tick.fresh, tick.counts[0],
                 tick.counts[1], tick.counts[2], f[0], f[1], f[2]);
  }
  std::fclose(out);
  return verdict(felt >= kFew && unknown == 0 && gate_limited <= felt / 4 && most > 0.3,
                 arm.name + " program",
                 std::to_string(asked.size()) + " forces requested, " + std::to_string(felt) +
                     " ticks with one of them, " + std::to_string(most) + " N at most; " +
                     std::to_string(unknown) + " with another, " + std::to_string(gate_limited) +
                     " limited by the gate, " + std::to_string(opening) + " before it opened");
}

}  // namespace thimble::usb_test
