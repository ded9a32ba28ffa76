// The commands of parts that this program lacks (THIMBLE_LACKS_PART): each answers with how to
// build the whole program.
#include "cli/commands.h"

#define THIMBLE_ANSWER(function, name, about, part)              \
  void add_##function##_command(CLI::App& app, int& exit_code) { \
    add_absent_command(app, exit_code, name, about, part);       \
  }
#define THIMBLE_NO_ANSWER(function, name, about, part)

#define THIMBLE_ANSWER_FIRST_TOUCH THIMBLE_NO_ANSWER
#define THIMBLE_ANSWER_WINDOW THIMBLE_NO_ANSWER  // see no_window.cpp
#define THIMBLE_OPTION_FIRST_TOUCH ""
#define THIMBLE_OPTION_WINDOW ""
#define THIMBLE_OPTION_TOOLS ""
#define THIMBLE_OPTION_STUDIES "THIMBLE_STUDIES"
#define THIMBLE_OPTION_COMMISSIONING "THIMBLE_COMMISSIONING"
#define THIMBLE_OPTION_COMPAT "THIMBLE_COMPAT"
#define THIMBLE_OPTION_VIEW "THIMBLE_VIEW"

#ifdef THIMBLE_LACKS_TOOLS
#define THIMBLE_ANSWER_TOOLS THIMBLE_ANSWER
#else
#define THIMBLE_ANSWER_TOOLS THIMBLE_NO_ANSWER
#endif
#ifdef THIMBLE_LACKS_STUDIES
#define THIMBLE_ANSWER_STUDIES THIMBLE_ANSWER
#else
#define THIMBLE_ANSWER_STUDIES THIMBLE_NO_ANSWER
#endif
#ifdef THIMBLE_LACKS_COMMISSIONING
#define THIMBLE_ANSWER_COMMISSIONING THIMBLE_ANSWER
#else
#define THIMBLE_ANSWER_COMMISSIONING THIMBLE_NO_ANSWER
#endif
#ifdef THIMBLE_LACKS_COMPAT
#define THIMBLE_ANSWER_COMPAT THIMBLE_ANSWER
#else
#define THIMBLE_ANSWER_COMPAT THIMBLE_NO_ANSWER
#endif
#ifdef THIMBLE_LACKS_VIEW
#define THIMBLE_ANSWER_VIEW THIMBLE_ANSWER
#else
#define THIMBLE_ANSWER_VIEW THIMBLE_NO_ANSWER
#endif

namespace thimble::cli {

#define THIMBLE_COMMAND(function, part, name, about) \
  THIMBLE_ANSWER_##part(function, name, about, THIMBLE_OPTION_##part)
#define THIMBLE_SUBCOMMAND THIMBLE_COMMAND
#include "cli/commands.inc"
#undef THIMBLE_COMMAND
#undef THIMBLE_SUBCOMMAND

}  // namespace thimble::cli
