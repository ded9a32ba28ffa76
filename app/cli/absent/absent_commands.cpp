// The commands of parts that this program lacks (THIMBLE_LACKS_PART). Each starts the program of
// its part, or prints how to get it.
#include "cli/commands.h"
#include "cli/parts/part.h"

#define THIMBLE_ANSWER(function, name, about, part)              \
  void add_##function##_command(CLI::App& app, int& exit_code) { \
    add_absent_command(app, exit_code, name, about, part);       \
  }
#define THIMBLE_NO_ANSWER(function, name, about, part)

#define THIMBLE_ANSWER_FIRST_TOUCH THIMBLE_NO_ANSWER
#define THIMBLE_ANSWER_WINDOW THIMBLE_NO_ANSWER  // see no_window.cpp
#define THIMBLE_PART_FIRST_TOUCH kTools
#define THIMBLE_PART_WINDOW kViewer
#define THIMBLE_PART_TOOLS kTools
#define THIMBLE_PART_STUDIES kStudies
#define THIMBLE_PART_COMMISSIONING kCommissioning
#define THIMBLE_PART_COMPAT kCompat
#define THIMBLE_PART_VIEW kViewer

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
  THIMBLE_ANSWER_##part(function, name, about, THIMBLE_PART_##part)
#define THIMBLE_SUBCOMMAND THIMBLE_COMMAND
#include "cli/commands.inc"
#undef THIMBLE_COMMAND
#undef THIMBLE_SUBCOMMAND

}  // namespace thimble::cli
