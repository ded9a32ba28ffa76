#include "cli/complain.h"

#include "log/logger.h"

namespace thimble::cli {

ExitCode complain(const driver::Error& error, ExitCode exit_code) {
  scene::logger().error("{}", error.message);
  return exit_code;
}

}  // namespace thimble::cli
