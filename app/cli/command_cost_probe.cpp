#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "log/printed_text.h"
#include "studies/accuracy/gating/gating.h"
#include "studies/accuracy/probed_stroke.h"
#include "studies/cost/cost_subjects.h"
#include "studies/cost/instruction_count.h"

namespace thimble::cli {
namespace {

struct ProbeOptions {
  std::string subject;
  int strokes = 1;
};

// Points of the diagrams of `thimble study accuracy`, each one stroke.
constexpr std::string_view kAccuracy = "accuracy/";
// Scenes of `thimble study gating`, with all effects of the arm or without some.
constexpr std::string_view kGating = "gating/";

int probe(const ProbeOptions& options) {
  if (options.subject.compare(0, kAccuracy.size(), kAccuracy) == 0 &&
      studies::probe_strokes(options.subject.substr(kAccuracy.size())) > 0) {
    return kExitDone;
  }
  if (options.subject.compare(0, kGating.size(), kGating) == 0 &&
      studies::probe_gating(options.subject.substr(kGating.size()))) {
    return kExitDone;
  }
  for (const studies::CostSubject& subject : studies::cost_subjects()) {
    if (subject.name != options.subject) continue;
    const auto touch = subject.build();
    if (!touch) {
      return report_error(touch.error(), kExitBadInput);
    }
    const auto states = studies::ring_stroke(studies::kCostRing, studies::kStrokeTicks, 0.001);
    double sum = 0;
    for (int i = 0; i < options.strokes; ++i) {
      for (const auto& state : states) sum += (*touch)->update(state).f_T_W.x();
    }
    scene::print_format("%.17g\n", sum);
    return kExitDone;
  }
  return report_error({"SUBJECT: cost-probe has no subject \"" + options.subject + "\"."},
                      kExitBadInput);
}

}  // namespace

void add_cost_probe_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("cost-probe", "Run strokes of one cost subject");
  command->group("");  // internal: for `thimble study cost`
  auto options = std::make_shared<ProbeOptions>();
  command->add_option("SUBJECT", options->subject)->required();
  command->add_option("STROKES", options->strokes)->required()->check(CLI::Range(1, 100000));
  command->callback([options, &exit_code] { exit_code = probe(*options); });
}

}  // namespace thimble::cli
