#include "bringup/identify/output/links_section.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bringup/identify/link_inertia/link_constants.h"

namespace thimble::bringup {
namespace {

/// The keys of a section with their values, each with its mark.
std::vector<std::pair<std::string, std::string>> entries_of(const LinkConstants& links,
                                                            const IdentifiedMark& mark) {
  const auto& inertia = links.inertia;
  std::vector<std::pair<std::string, std::string>> all{
      {"inertia",
       fmt::format("[{:.6g}, {:.6g}, {:.6g}]  # kg m^2 about A, B and C [I {}, {}, +- "
                   "{:.2g}, {:.2g}, {:.2g}]",
                   inertia[0].value, inertia[1].value, inertia[2].value, mark.date, mark.arm,
                   inertia[0].plus_minus, inertia[1].plus_minus, inertia[2].plus_minus)}};
  const auto add = [&](const char* key, const Estimate& is, const char* unit) {
    all.emplace_back(key, marked(is.value, unit, is.plus_minus, mark));
  };
  add("yaw_b", links.yaw_b, "kg m^2");
  add("yaw_c", links.yaw_c, "kg m^2");
  add("coupling", links.coupling, "kg m^2, the minimum for physical links");
  add("moment_b", links.moment_b, "kg m");
  add("moment_c", links.moment_c, "kg m, any negative weight at the tip");
  return all;
}

/// One line with all of them, the marks at its end.
std::string line_of(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string values, marks;
  for (const auto& [key, text] : entries) {
    const std::size_t mark = text.find("  # ");
    values += (values.empty() ? "" : ", ") + key + ": " + text.substr(0, mark);
    marks += (marks.empty() ? "" : "; ") + key + ": " + text.substr(mark + 4);
  }
  return "{" + values + "}  # " + marks;
}

bool put(const YAML::Node& simulation, const ArmConstants& found, const IdentifiedMark& mark,
         FileLines& lines) {
  const YAML::Node links = simulation["links"];
  if (!found.links && !(links && found.links_sought)) return true;
  const auto entries = entries_of(found.links.value_or(LinkConstants{}), mark);
  if (links && links.Style() == YAML::EmitterStyle::Flow) {
    return lines.exchange(links, line_of(entries));
  }
  if (links && links.IsMap() && links.size() > 0) {
    for (const auto& [key, text] : entries) {
      const bool done = links[key] ? lines.exchange(links[key], text)
                                   : lines.add_before(links.begin()->first, {key + ": " + text});
      if (!done) return false;
    }
    return true;
  }
  std::vector<std::string> section{"links:"};
  for (const auto& [key, text] : entries) section.push_back("  " + key + ": " + text);
  for (const auto& entry : simulation) {
    if (entry.first.as<std::string>() == "tip") return lines.add_before(entry.first, section);
  }
  return false;
}

}  // namespace

driver::Result<void> put_links(const YAML::Node& simulation, const ArmConstants& found,
                               const IdentifiedMark& mark, FileLines& lines) {
  if (put(simulation, found, mark, lines)) return {};
  return driver::Error{
      "The section simulation.links of the arm file cannot be replaced. Write each key on a "
      "separate line."};
}

bool reads_links(const device_sim::LinkSettings& read, const ArmConstants& found) {
  if (!found.links) return !found.links_sought || !read.named();
  const device_sim::LinkSettings put = settings_of(*found.links);
  const auto near = [](double value, double wanted) {
    return std::abs(value - wanted) <= 1e-5 * std::abs(wanted) + 1e-12;
  };
  bool right = near(read.yaw_b, put.yaw_b) && near(read.yaw_c, put.yaw_c) &&
               near(read.coupling, put.coupling) && near(read.moment_b, put.moment_b) &&
               near(read.moment_c, put.moment_c);
  for (Eigen::Index i = 0; i < 3; ++i) right = right && near(read.inertia[i], put.inertia[i]);
  return right;
}

}  // namespace thimble::bringup
