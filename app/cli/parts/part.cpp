#include "cli/parts/part.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <system_error>

namespace thimble::cli {
namespace {

char** arguments = nullptr;

}  // namespace

std::filesystem::path find_beside_program(const std::string& name,
                                          std::initializer_list<const char*> places) {
  std::error_code status;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", status).parent_path();
  if (status) return {};
  for (const char* place : places) {
    const auto file = (folder / place / name).lexically_normal();
    if (std::filesystem::is_regular_file(file, status)) return file;
  }
  return {};
}

std::filesystem::path part_program(const Part& part) {
  if (*part.package == 0) return {};
  return find_beside_program(part.package, {".", THIMBLE_PART_PROGRAMS});
}

std::filesystem::path main_program() {
  return find_beside_program("thimble", {".", THIMBLE_MAIN_PROGRAM});
}

std::string how_to_get(const Part& part) {
  const std::string package = part.package, option = part.option;
  return (package.empty()
              ? ""
              : "install the package " + package + " (`sudo apt install " + package + "`), or ") +
         "build it from source (app/setup.sh release thimble" +
         (option.empty() ? "" : "; CMake: " + option + "=ON") + ")";
}

void keep_arguments(char** argv) {
  arguments = argv;
}

driver::Error start_part(const std::filesystem::path& program) {
  execv(program.c_str(), arguments);
  return {program.string() + " cannot be started: " + std::strerror(errno) +
          ". Reinstall its package."};
}

}  // namespace thimble::cli
