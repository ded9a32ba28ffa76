#include "support/seed.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "support/random.h"

namespace thimble {
namespace {

/// Result of a test program in a separate environment: the seeds that it used, and its output.
struct Child {
  std::array<std::uint64_t, 3> seeds{};
  std::string said;
  int exit_code = -1;
};

/// Returns the seeds of the cases 7, 8 and 7 in a separate process with these variables (null:
/// unset).
Child child(const char* long_form, const char* asked) {
  Child result;
  std::FILE* const seeds = std::tmpfile();
  std::FILE* const said = std::tmpfile();
  if (seeds == nullptr || said == nullptr) {
    ADD_FAILURE() << "no temporary file";
    return result;
  }
  std::fflush(nullptr);
  const pid_t process = fork();
  if (process == 0) {
    const auto set = [](const char* name, const char* value) {
      value == nullptr ? unsetenv(name) : setenv(name, value, 1);
    };
    set("THIMBLE_LONG", long_form);
    set("THIMBLE_SEED", asked);
    dup2(fileno(said), STDERR_FILENO);
    const std::array<std::uint64_t, 3> taken{support::seed_of(7), support::seed_of(8),
                                             support::seed_of(7)};
    const bool written = write(fileno(seeds), taken.data(), sizeof taken) == sizeof taken;
    std::fflush(stderr);
    _exit(written ? 0 : 3);
  }
  int status = 0;
  waitpid(process, &status, 0);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (result.exit_code == 0) {
    EXPECT_EQ(pread(fileno(seeds), result.seeds.data(), sizeof result.seeds, 0),
              static_cast<ssize_t>(sizeof result.seeds));
  }
  std::array<char, 512> text{};
  const ssize_t size = pread(fileno(said), text.data(), text.size(), 0);
  if (size > 0) result.said.assign(text.data(), static_cast<std::size_t>(size));
  std::fclose(seeds);
  std::fclose(said);
  return result;
}

/// Returns the number after "THIMBLE_SEED=" in an output; empty if there is none.
std::string printed_seed(const std::string& said) {
  const std::string before = "THIMBLE_SEED=";
  const std::size_t at = said.find(before);
  if (at == std::string::npos) return {};
  return said.substr(at + before.size(), said.find(' ', at) - at - before.size());
}

TEST(SeedOf, IsTheFixedSeedInTheShortForm) {
  const Child found = child(nullptr, nullptr);
  EXPECT_EQ(found.seeds, (std::array<std::uint64_t, 3>{7, 8, 7}));
  EXPECT_EQ(found.said, "");
}

TEST(SeedOf, DiffersInEachRunOfTheLongForm) {
  const Child first = child("1", nullptr), second = child("1", nullptr);
  EXPECT_NE(first.seeds[0], 7u);
  EXPECT_NE(first.seeds[0], second.seeds[0]);
  EXPECT_NE(first.seeds[0], first.seeds[1]);
  EXPECT_EQ(first.seeds[0], first.seeds[2]) << "of one number twice";
}

TEST(SeedOf, PrintsTheNumberThatRepeatsARun) {
  const Child fresh = child("1", nullptr);
  const std::string number = printed_seed(fresh.said);
  ASSERT_FALSE(number.empty()) << fresh.said;
  for (const char* long_form : {static_cast<const char*>(nullptr), "1"}) {
    const Child again = child(long_form, number.c_str());
    EXPECT_EQ(again.seeds, fresh.seeds);
    EXPECT_EQ(again.said, fresh.said);
  }
}

TEST(SeedOf, InvalidNumberEndsTheProgram) {
  for (const char* wrong : {"seven", "7 ", "-1", "0x7", "99999999999999999999"}) {
    const Child found = child("1", wrong);
    EXPECT_EQ(found.exit_code, 2) << wrong;
    EXPECT_NE(found.said.find("THIMBLE_SEED: expected a whole number"), std::string::npos)
        << found.said;
  }
}

TEST(Random, CaseNumberDrawsNewCasesAndSeedIsFixed) {
  EXPECT_EQ(support::Random(7).bits(), support::Random(support::seed_of(7)).bits());
  EXPECT_EQ(support::Random(std::uint64_t{7}).bits(), std::mt19937_64(7)());
}

}  // namespace
}  // namespace thimble
