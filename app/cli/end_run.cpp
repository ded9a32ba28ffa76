#include "cli/end_run.h"

#include <cstddef>
#include <cstdio>

#include "log/printed_text.h"
#include "print.h"
#include "thimble/session/run_figures.h"

namespace thimble::cli {

bool zero_assured(const session::Session& session) {
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    if (!session.device(arm).zero_assured()) return false;
  }
  return true;
}

void print_summaries(const session::Session& session, const driver::RealTimeGrant& grant) {
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    if (session.arms() > 1) session::print(scene::text_stream(), "--- {}\n", session.arm_name(arm));
    session::print(scene::text_stream(), "{}", summary(session.figures(grant, arm)));
  }
}

ExitCode end_of(const session::Session& session, bool by_viewer) {
  ExitCode code = kExitDone;
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    const session::RunFigures figures = session.figures({}, arm);
    code = more_serious(code, exit_code_of(figures.end, figures.fault, by_viewer));
  }
  return code;
}

}  // namespace thimble::cli
