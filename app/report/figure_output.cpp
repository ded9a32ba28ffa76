#include "report/figure_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "output/output_file.h"
#include "report/figure_json.h"
#include "report/json_text.h"

namespace thimble::report {

nlohmann::ordered_json figures_json(const std::vector<Figure>& figures) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Figure& figure : figures) {
    nlohmann::ordered_json entry{
        {"name", figure.name}, {"value", figure.value}, {"unit", figure.unit}};
    if (!figure.goal.empty()) {
      entry["goal"] = figure.goal;
      entry["met"] = figure.met();
    }
    if (!figure.note.empty()) entry["note"] = figure.note;
    list.push_back(std::move(entry));
  }
  return list;
}

driver::Result<void> write_figures(const std::vector<Figure>& figures,
                                   const std::filesystem::path& file) {
  return write_json(figures_json(figures), file);
}

std::string figure_table(const std::vector<Figure>& figures) {
  std::size_t width = 0;
  for (const Figure& figure : figures) width = std::max(width, figure.name.size());
  std::string table;
  for (const Figure& figure : figures) {
    const std::string value = fmt::format("{:12.6g}", figure.value);
    std::string line = figure.name + std::string(width - figure.name.size(), ' ') + value;
    line += " " + figure.unit;
    if (!figure.goal.empty()) {
      if (line.size() < width + 20) line.resize(width + 20, ' ');
      line += "  goal " + figure.goal + (figure.met() ? ": met" : ": NOT MET");
    }
    if (!figure.note.empty()) line += "  (" + figure.note + ")";
    table += line + "\n";
  }
  return table;
}

std::string unmet_line(const std::vector<Figure>& figures) {
  std::string line;
  int count = 0;
  for (const Figure& figure : figures) {
    if (figure.met()) continue;
    ++count;
    line += fmt::format("{}{} = {:.4g} {} (goal {}", count > 1 ? "; " : "", figure.name,
                        figure.value, figure.unit, figure.goal);
    line += figure.note.empty() ? ")" : "; " + figure.note + ")";
  }
  return count > 0 ? fmt::format("NOT MET: {} of {} figures: ", count, figures.size()) + line : "";
}

driver::Result<void> write_text(const std::string& text, const std::filesystem::path& file) {
  return output::write_file(file, output::kind_of_name(file), text);
}

driver::Result<void> write_json(const nlohmann::ordered_json& json,
                                const std::filesystem::path& file) {
  return write_text(json_text(json, 2) + "\n", file);
}

}  // namespace thimble::report
