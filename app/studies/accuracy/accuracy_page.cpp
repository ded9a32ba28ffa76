#include "studies/accuracy/accuracy_page.h"
#include "report/html/page_block.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "report/figure_output.h"
#include "report/inline_picture.h"
#include "report/json_text.h"
#include "studies/accuracy/axis_words.h"
#include "thimble/scene/build_info.h"

namespace thimble::studies {
namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Thimble: what accuracy costs in time</title>
<style>
body{font:16px/1.5 system-ui,"DejaVu Sans",sans-serif;color:#22262c;background:#fff;margin:0 auto;
 padding:1rem;max-width:88rem}
h1{font-size:1.7rem;line-height:1.25}h2{font-size:1.25rem;margin:3rem 0 .4rem;
 border-top:1px solid #d5d9de;padding-top:1.2rem}
p{max-width:48rem;margin:.5rem 0}
.pictures{display:flex;flex-wrap:wrap;gap:1rem}.pictures svg{flex:1 1 22rem;min-width:0;max-width:46rem;
 width:100%;height:auto}
.felt{border-left:4px solid #0072b2;padding-left:.7rem}
.small{color:#555c66;font-size:.92rem}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:.88rem;font-variant-numeric:tabular-nums}
th,td{padding:.15rem .7rem;text-align:right;white-space:nowrap;border-bottom:1px solid #e4e7eb}
th:first-child,td:first-child{text-align:left}tr.default td{font-weight:700}
summary{cursor:pointer;margin:.6rem 0}nav a{margin-right:.9rem;white-space:nowrap}a{color:#005a8c}
</style></head><body>
<h1>What accuracy costs in time</h1>
<p>Each diagram varies one parameter and shows the error of the result and its cost. The text below each diagram names the
reference: a closed form, a computation that shares no code with the product, or the product without that error. Lower is
more accurate, farther left is cheaper. In the shaded area below the dashed line the error cannot be felt. The ring marks the
default of Thimble. If the arm determines the parameter, the ring marks a PHANTOM-like arm.</p>
<p class="small">Times are medians of processor time on this machine, measured in turn, with half the distance between the
quartiles. Instructions are counted by callgrind. They are the same on every machine that runs the same binary, and decide
which point is cheaper. Errors are bit-identical in every run.</p>
)";

std::string cell(const std::string& text) {
  return "<td>" + report::html_text(text) + "</td>";
}

// Adds a list of the diagrams of one kind, if there are any.
void add_contents(const std::vector<AxisSection>& sections, bool given, const char* words,
                  std::ostringstream& page) {
  const char* begin = words;
  for (const AxisSection& section : sections) {
    const AccuracyAxis& a = section.axis->axis;
    if (a.given != given) continue;
    if (begin != nullptr) page << "<nav><b>" << std::exchange(begin, nullptr) << "</b> ";
    page << "<a href=\"#" << a.name << "\">" << a.name << "</a> ";
  }
  if (begin == nullptr) page << "</nav>\n";
}

void add_table(const MeasuredAxis& axis, std::ostringstream& page) {
  const AccuracyAxis& a = axis.axis;
  page << "<details><summary>Figures</summary><div class=\"scroll\"><table><tr><th>method</th><th>"
       << report::html_text(a.knob) << (a.knob_unit.empty() ? "" : ", ")
       << report::html_text(a.knob_unit) << "</th><th>" << report::html_text(a.unit)
       << "</th><th>ns " << (a.cost_is_added ? "more " : "") << "per " << a.per
       << "</th><th>&plusmn;</th><th>instructions</th>"
       << "<th>Pareto front</th></tr>\n";
  for (const MeasuredLine& line : axis.lines) {
    for (const MeasuredPoint& point : line.points) {
      page << "<tr" << (point.point->is_default ? " class=\"default\"" : "") << '>'
           << cell(line.line->apart ? name_of(axis, point) : line.line->title)
           << cell(std::isfinite(point.point->knob) ? three_digits(point.point->knob) : "")
           << cell(point.diverged ? "diverges" : three_digits(point.error))
           << cell(three_digits(point.ns)) << cell(three_digits(point.ns_spread))
           << cell(point.instructions ? three_digits(*point.instructions) : "")
           << cell(point.on_front ? "yes" : "") << "</tr>\n";
    }
  }
  page << "</table></div></details>\n";
}

}  // namespace

driver::Result<void> write_accuracy_page(const std::vector<AxisSection>& sections,
                                         const std::filesystem::path& folder) {
  std::ostringstream page;
  page << kHead;
  add_contents(sections, false, "Parameters to choose:", page);
  add_contents(sections, true, "Parameters of the arm:", page);
  for (const AxisSection& section : sections) {
    const MeasuredAxis& axis = *section.axis;
    const AccuracyAxis& a = axis.axis;
    page << "<h2 id=\"" << a.name << "\">" << report::html_text(a.title)
         << "</h2>\n<p class=\"felt\">" << report::html_text(felt_sentence(axis))
         << "</p>\n<div class=\"pictures\">\n";
    for (const std::string& name : section.pictures) {
      page << report::inline_picture(folder / (name + ".svg"), name + "-") << '\n';
    }
    page << "</div>\n<p>" << report::html_text(default_sentence(axis)) << "</p>\n";
    if (const std::string orders = order_sentence(axis); !orders.empty()) {
      page << "<p>" << report::html_text(orders) << "</p>\n";
    }
    page << "<p class=\"small\">Reference: " << report::html_text(a.truth)
         << " Not shown: " << report::html_text(a.left_out) << "</p>\n";
    add_table(axis, page);
  }
  const scene::BuildInfo build = scene::build_info();
  page << "<p><a href=\"runs/index.html\">One touch at each quality</a>: a recorded run "
          "for each, in which all parameters act together.</p>\n";
  page << "<p class=\"small\">thimble " << build.version << ", " << build.type << ", "
       << build.compiler << ".</p>\n</body></html>\n";
  return report::write_text(page.str(), folder / "index.html");
}

driver::Result<void> write_accuracy_summary(const std::vector<AxisSection>& sections,
                                            const std::filesystem::path& file) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const AxisSection& section : sections) {
    const MeasuredAxis& axis = *section.axis;
    const AccuracyAxis& a = axis.axis;
    nlohmann::ordered_json entry{{"axis", a.name},
                                 {"title", a.title},
                                 {"knob", a.knob},
                                 {"knob_unit", a.knob_unit},
                                 {"given_by_the_arm", a.given},
                                 {"metric", a.metric},
                                 {"unit", a.unit},
                                 {"truth", a.truth},
                                 {"felt", felt_sentence(axis)},
                                 {"default", default_sentence(axis)},
                                 {"orders", order_sentence(axis)},
                                 {"left_out", a.left_out}};
    if (a.threshold) entry["threshold"] = *a.threshold;
    const auto point_of = [&](const MeasuredPoint* point) {
      nlohmann::ordered_json one{
          {"point", name_of(axis, *point)}, {"error", point->error}, {"ns", point->ns}};
      if (point->instructions) one["instructions"] = *point->instructions;
      one["on_front"] = point->on_front;
      return one;
    };
    if (const auto* point = axis.default_point()) {
      entry[a.given ? "arm_point" : "default_point"] = point_of(point);
    }
    if (const auto* point = a.over_cost ? axis.enough() : nullptr) {
      entry["enough_point"] = point_of(point);
    }
    list.push_back(std::move(entry));
  }
  return report::write_json(list, file);
}

}  // namespace thimble::studies
