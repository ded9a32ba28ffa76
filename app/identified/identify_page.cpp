#include "identified/identify_page.h"

#include <fmt/format.h>

#include <cmath>

#include "bringup/identify/constants_table.h"
#include "bringup/identify/link_inertia/masses_per_pose.h"
#include "bringup/identify/unidentified_parameters.h"
#include "identified/identify_plots.h"
#include "report/html/page_block.h"
#include "report/inline_picture.h"
#include "report/picture_style.h"

namespace thimble::identified {
namespace {

constexpr const char* kStyle = R"(
body{font:15px/1.5 system-ui,"DejaVu Sans",sans-serif;color:#22262c;background:#fff;margin:0 auto;
 padding:1.2rem 1.4rem 3rem;max-width:66rem}
h1{font-size:1.6rem;line-height:1.25;margin:.3rem 0 .1rem}
h2{font-size:1.15rem;margin:2.2rem 0 .3rem;border-top:1px solid #d5d9de;padding-top:1.1rem}
p{max-width:48rem;margin:.4rem 0}.small{color:#555c66;font-size:.9rem}
.verdict{border-left:5px solid #00805f;padding:.35rem .8rem;margin:1rem 0;background:#f3f8f6}
.verdict.bad{border-color:#b3261e;background:#fcf3f2}.verdict p{margin:.25rem 0}
svg{width:100%;height:auto;display:block}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:.5rem 0}
th{font-weight:600;color:#555c66;font-size:.86rem}
th,td{padding:.2rem .8rem .2rem 0;text-align:right;white-space:nowrap;border-bottom:1px solid #e8ebee}
th:first-child,td:first-child,th:last-child,td:last-child{text-align:left}
td:last-child{color:#555c66}
ul{max-width:48rem;padding-left:1.2rem}li{margin:.35rem 0}
)";

std::string paragraph(const std::string& text, const char* kind = nullptr) {
  return fmt::format("<p{}>{}</p>\n", kind == nullptr ? "" : fmt::format(" class=\"{}\"", kind),
                     report::html_text(text));
}

/// Returns a value rounded to the last digit that is significant for its interval.
std::string rounded(double value, double plus_minus) {
  if (!(plus_minus > 0)) return fmt::format("{:.5g}", value);
  const int digits = std::max(0, 1 - static_cast<int>(std::floor(std::log10(plus_minus))));
  return fmt::format("{:.{}f}", value, std::min(digits, 6));
}

std::string verdict(const bringup::Identified& found, bool bad_fit_is_written) {
  if (found.against.empty()) {
    return "<div class=\"verdict\">" +
           paragraph("The fit is good: its residual is normal for an arm of this kind.") +
           "</div>\n";
  }
  std::string text =
      "<div class=\"verdict bad\">" +
      paragraph(std::string("The fit is bad, and ") +
                (bad_fit_is_written ? "every constant of it in an arm file is marked as a bad fit"
                                    : "no arm file was written") +
                ". The constants below belong to a model that this arm does not follow:");
  for (const std::string& sentence : found.against) text += paragraph(sentence);
  return text + "</div>\n";
}

std::string table(const bringup::Identified& found, const scene::ArmFile& file) {
  std::string text =
      "<div class=\"scroll\"><table><tr><th>constant</th><th>found</th><th>± 95 %</th><th>arm "
      "file</th><th>unit</th></tr>\n";
  for (const bringup::ConstantRow& row : bringup::constant_rows(found, file)) {
    text += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.2g}</td><td>{}</td><td>{}</td></tr>\n",
                        report::html_text(row.name), rounded(row.found.value, row.found.plus_minus),
                        row.found.plus_minus, row.named ? fmt::format("{:.5g}", *row.named) : "",
                        report::html_text(row.unit));
  }
  return text + "</table></div>\n";
}

/// Returns the apparent mass at each place of the tip as a table, and their range.
std::string masses_text(const bringup::LinkFit& fit, const scene::ArmFile& file) {
  std::string text =
      "<div class=\"scroll\"><table><tr><th>place, mm (world)</th><th>along x, g</th><th>along "
      "y</th><th>along z</th></tr>\n";
  for (const bringup::PoseMass& place : bringup::pose_masses(fit, file)) {
    text += fmt::format("<tr><td>{:.0f}, {:.0f}, {:.0f}</td>", 1e3 * place.p_W.x(),
                        1e3 * place.p_W.y(), 1e3 * place.p_W.z());
    for (const bringup::Estimate& mass : place.mass) {
      text += fmt::format("<td>{} ± {:.2g}</td>", rounded(1e3 * mass.value, 1e3 * mass.plus_minus),
                          1e3 * mass.plus_minus);
    }
    text += "</tr>\n";
  }
  return text + "</table></div>\n" + paragraph(bringup::range_text(fit, file), "small");
}

std::string page_text(const bringup::Identified& found, const scene::ArmFile& file,
                      const IdentifyHeading& heading, const std::vector<IdentifyPlot>& plots,
                      const std::filesystem::path& folder) {
  const std::string title = "What " + heading.arm + " is like";
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{} - Thimble</title>\n<link rel=\"icon\" "
      "href=\"data:,\">\n<style>{}</style></head><body>\n<h1>{}</h1>\n",
      report::html_text(title), kStyle, report::html_text(title));
  page += paragraph(
      fmt::format("{}, {}; {:g} s of motion under at most {:g} N{}.",
                  heading.simulated
                      ? "The simulated arm of this file; the constants do not describe a real arm"
                      : "Arm " + heading.device,
                  heading.date, heading.seconds, heading.max_force,
                  heading.known_mass > 0
                      ? fmt::format(", and a second time with {:g} g fixed to the tip",
                                    1e3 * heading.known_mass)
                      : ""),
      "small");
  page += verdict(found, heading.bad_fit_is_written);
  page +=
      "<h2>Constants</h2>\n" + table(found, file) + paragraph(bringup::fit_text(found), "small");
  for (const IdentifyPlot& plot : plots) {
    page += fmt::format("<h2>{}</h2>\n", report::html_text(plot.title)) +
            paragraph(plot.caption, "small") +
            report::inline_picture(folder / (plot.name + ".svg"), plot.name + "-") + "\n";
    if (plot.name == "identify_masses") page += masses_text(*found.over.fit, file);
  }
  if (plots.empty()) {
    page += "<h2>Plots</h2>\n" +
            paragraph(
                "There are no plots because gnuplot is not installed. Install it (apt install "
                "gnuplot-nox) and identify again. The numbers are in data/.");
  }
  page += "<h2>Not identified</h2>\n<ul>\n";
  for (const std::string& sentence : bringup::unidentified_parameters(found)) {
    const std::size_t colon = sentence.find(':');
    page +=
        fmt::format("<li><b>{}</b>{}</li>\n", report::html_text(sentence.substr(0, colon)),
                    report::html_text(colon == std::string::npos ? "" : sentence.substr(colon)));
  }
  page += "</ul>\n" + paragraph(heading.program, "small") + "</body></html>\n";
  return page;
}

}  // namespace

std::vector<session::Figure> identify_figures(const bringup::Identified& identified,
                                              const scene::ArmFile& file) {
  std::vector<session::Figure> figures;
  for (const bringup::ConstantRow& row : bringup::constant_rows(identified, file)) {
    figures.push_back({row.name, row.found.value, row.unit, "",
                       fmt::format("+- {:.2g} (95 %){}", row.found.plus_minus,
                                   row.named ? fmt::format("; file {:.5g}", *row.named) : "")});
  }
  figures.push_back({"explained", 100 * identified.bare.explained, "%", "", "of the acceleration"});
  figures.push_back({"model_misfits", static_cast<double>(identified.against.size()), "", "== 0",
                     identified.against.empty() ? "" : identified.against.front()});
  return figures;
}

driver::Result<void> write_identify_page(const bringup::Identified& identified,
                                         const scene::ArmFile& file, const IdentifyHeading& heading,
                                         const std::filesystem::path& folder) {
  if (auto made = report::make_picture_folder(folder); !made) return made;
  if (auto done =
          report::write_figures(identify_figures(identified, file), folder / "figures.json");
      !done) {
    return done;
  }
  const auto plots = draw_identified(identified, file, folder);
  if (!plots) return plots.error();
  return report::write_text(page_text(identified, file, heading, *plots, folder),
                            folder / "index.html");
}

}  // namespace thimble::identified
