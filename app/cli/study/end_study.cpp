#include "cli/study/end_study.h"

#include <cstdio>

#include "cli/options/json_option.h"
#include "cli/report_error.h"
#include "log/printed_text.h"
#include "report/figure_json.h"

namespace thimble::cli {

ExitCode end_study(const std::vector<session::Figure>& figures, const std::filesystem::path& folder,
                   const std::string& where_to_look) {
  if (const auto written = report::write_figures(figures, folder / "figures.json"); !written) {
    return report_error(written.error(), kExitTrouble);
  }
  scene::print_format("%s\nWritten to %s%s.\n", report::figure_table(figures).c_str(),
                      folder.c_str(), where_to_look.c_str());
  print_json("study", {{"folder", folder.string()}, {"figures", report::figures_json(figures)}});
  const std::string unmet = report::unmet_line(figures);
  if (unmet.empty()) return kExitDone;
  scene::print_toned(scene::Tone::kBad, unmet + "\n");
  return kExitUnmet;
}

}  // namespace thimble::cli
