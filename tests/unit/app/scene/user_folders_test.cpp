#include "user_folders.h"

#include <gtest/gtest.h>
#include <pwd.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <string>

namespace thimble::scene {
namespace {

/// Sets an environment variable during its lifetime.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    value != nullptr ? setenv(name, value, 1) : unsetenv(name);
  }
  ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

std::string home_in_list_of_users() {
  const passwd* user = getpwuid(geteuid());
  return user != nullptr && user->pw_dir != nullptr && std::string(user->pw_dir) != "/"
             ? user->pw_dir
             : "/dev/null/HOME-is-not-set";
}

TEST(UserFolders, AreInHome) {
  const Variable home("HOME", "/somewhere"), state("XDG_STATE_HOME", nullptr);
  EXPECT_EQ(state_folder(), "/somewhere/.local/state/thimble");
}

TEST(UserFolders, FollowListOfUsersWithoutHome) {
  const Variable home("HOME", nullptr), state("XDG_STATE_HOME", nullptr);
  EXPECT_EQ(state_folder(), home_in_list_of_users() + "/.local/state/thimble");
}

TEST(UserFolders, EmptyHomeIsNoHome) {
  const Variable home("HOME", ""), state("XDG_STATE_HOME", nullptr);
  EXPECT_EQ(state_folder(), home_in_list_of_users() + "/.local/state/thimble");
}

TEST(UserFolders, RelativePathsAreIgnored) {
  const Variable home("HOME", "here"), state("XDG_STATE_HOME", "there");
  EXPECT_EQ(state_folder(), home_in_list_of_users() + "/.local/state/thimble");
}

}  // namespace
}  // namespace thimble::scene
