#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

namespace thimble::support {

/// Records the items of a kind (arms, scenes, trackers) that a test has covered. The guide's page
/// of guarantees promises only these (tests/arch/promises.py). Add a name only after the test has
/// checked it. The notes of a test are a file with its name in the folder `covered` of its build.
class Covered {
 public:
  /// Takes the name of the kind, in the plural.
  explicit Covered(std::string kind) : kind_(std::move(kind)) {}

  void add(std::string_view name) {
    names_ += ' ';
    names_ += name;
    namespace fs = std::filesystem;
    fs::path build = fs::read_symlink("/proc/self/exe").parent_path();
    while (build.has_relative_path() && !fs::exists(build / "CMakeCache.txt"))
      build = build.parent_path();
    if (!build.has_relative_path()) return;  // The test was copied out of its build.
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string file = std::string(test->test_suite_name()) + '.' + test->name();
    std::replace(file.begin(), file.end(), '/', '-');
    fs::create_directories(build / "covered");
    std::ofstream(build / "covered" / (file + '.' + kind_)) << names_ << '\n';
  }

 private:
  std::string kind_, names_;
};

}  // namespace thimble::support
