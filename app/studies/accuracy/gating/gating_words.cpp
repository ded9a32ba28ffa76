#include <algorithm>
#include <string>
#include <vector>

#include "studies/accuracy/axis_words.h"
#include "studies/accuracy/gating/gating.h"

namespace thimble::studies {

std::string gating_text(const GatingReport& report) {
  std::string text;
  for (const GateDecision& one : report.decisions) {
    text += one.effect + ": " + (one.left_out ? "may be left out" : "is needed") + ". " + one.rule +
            ".";
    if (one.change) {
      text += " If only this effect is left out, the force changes by " +
              three_digits(100 * *one.change) + " %.";
    }
    text += "\n";
  }
  text += "\nWithout all effects that may be left out, the force (" + three_digits(report.force) +
          " N) changes by " + three_digits(100 * report.change) + " %: ";
  text += report.holds ? "too little to be felt. The reduced model is valid.\n"
                       : "this can be felt. This scene needs the full model.\n";
  const bool saves =
      std::any_of(report.decisions.begin(), report.decisions.end(),
                  [](const GateDecision& one) { return one.left_out && one.changes; });
  if (!saves)
    text +=
        "This scene needs every effect that costs time, so the reduced model saves "
        "nothing.\n";
  text += "A tick with the full model takes " + three_digits(report.full_ns) +
          " ns, with the reduced model " + three_digits(report.reduced_ns) + " ns";
  if (report.full_instructions && report.reduced_instructions) {
    text += "; " + three_digits(*report.full_instructions) +
            " instructions, with the reduced model " + three_digits(*report.reduced_instructions);
  }
  return text + ".\n";
}

std::vector<session::Figure> figures_of(const GatingReport& report) {
  std::vector<session::Figure> figures;
  for (const GateDecision& one : report.decisions) {
    figures.push_back({.name = one.effect + ": may be left out",
                       .value = one.left_out ? 1.0 : 0.0,
                       .unit = "",
                       .goal = {}});
    if (one.change) {
      figures.push_back({.name = one.effect + ": change of force without",
                         .value = 100 * *one.change,
                         .unit = "%",
                         .goal = one.left_out ? "<= 3.5" : ""});
    }
  }
  figures.push_back({.name = "all that may be left out: change of force",
                     .value = 100 * report.change,
                     .unit = "%",
                     .goal = "<= 3.5"});
  figures.push_back(
      {.name = "full model: time", .value = report.full_ns, .unit = "ns/tick", .goal = {}});
  figures.push_back(
      {.name = "reduced model: time", .value = report.reduced_ns, .unit = "ns/tick", .goal = {}});
  if (report.full_instructions && report.reduced_instructions) {
    figures.push_back({.name = "full model: instructions",
                       .value = *report.full_instructions,
                       .unit = "per tick",
                       .goal = {}});
    figures.push_back({.name = "reduced model: instructions",
                       .value = *report.reduced_instructions,
                       .unit = "per tick",
                       .goal = {}});
  }
  return figures;
}

}  // namespace thimble::studies
