// The known word that a mistyped word most likely means.
#include "text/nearest_word.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace thimble::scene {
namespace {

const std::vector<std::string> kKnown{"run", "replay", "study", "friction", "bench"};

TEST(NearestWord, FindsEachKindOfTypo) {
  EXPECT_EQ(nearest_word("rum", kKnown), "run");            // another letter
  EXPECT_EQ(nearest_word("friktion", kKnown), "friction");  // in a longer word
  EXPECT_EQ(nearest_word("repay", kKnown), "replay");       // a letter is missing
  EXPECT_EQ(nearest_word("sstudy", kKnown), "study");       // a letter is too many
  EXPECT_EQ(nearest_word("urn", kKnown), "run");            // two letters are swapped
}

TEST(NearestWord, CapitalLettersAreNoMistake) {
  EXPECT_EQ(nearest_word("RUN", kKnown), "run");
  EXPECT_EQ(nearest_word("Stiffness", {"damping", "stiffness"}), "stiffness");
}

TEST(NearestWord, IgnoresDissimilarWords) {
  EXPECT_FALSE(nearest_word("elephant", kKnown));
  EXPECT_FALSE(nearest_word("", kKnown));
  EXPECT_FALSE(nearest_word("xy", {"ab"}));
  EXPECT_FALSE(nearest_word("foo", {"on", "off", "fit", "form"}));
  EXPECT_FALSE(nearest_word("run", {}));
  EXPECT_EQ(nearest_word("o", {"at", "out"}), "out");
}

TEST(NearestWord, FindsTheOnlyWordThatBeginsSo) {
  EXPECT_EQ(nearest_word("fr", kKnown), "friction");
  EXPECT_FALSE(nearest_word("r", {"replaying", "recording"}));
}

TEST(NearestWord, PrefersTheFirstOfEquallyNear) {
  EXPECT_EQ(nearest_word("bat", {"cat", "hat"}), "cat");
}

TEST(NearestWord, SwappedLettersCountOnce) {
  EXPECT_EQ(nearest_word("urn", {"arn", "run"}), "arn");
  EXPECT_EQ(nearest_word("nmae", {"main", "name"}), "name");
}

}  // namespace
}  // namespace thimble::scene
