#include "cli/report_error.h"

#include "log/logger.h"

namespace thimble::cli {

ExitCode report_error(const driver::Error& error, ExitCode exit_code) {
  scene::logger().error("{}", error.message);
  return exit_code;
}

}  // namespace thimble::cli
