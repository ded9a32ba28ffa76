#include "yaml/yaml_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "yaml/key_log.h"
#include "yaml/yaml_words.h"

namespace thimble::scene {
namespace {

// Reads `text` as a small file with one number and one word. Returns the mistakes.
std::string mistakes_in(const std::string& text) {
  auto file = scene::YamlFile::parse(text, "arm.yaml");
  if (!file) return file.error().message;
  file->root().require_number("stiffness", "N/m", 0, 1e5);
  file->root().optional_string("name", "");
  file->root().optional_vector3("place", Eigen::Vector3d::Zero(), "m", -1, 1);
  file->root().optional_rotation("rotate_degrees");
  if (file->root().has("kind")) file->root().require_choice("kind", {"quantised", "ideal"});
  if (file->root().has("count")) file->root().require_whole("count", "", 0, 10);
  file->root().optional_bool("repair", false);
  if (file->root().has("parts")) {
    for (scene::YamlMap& part : file->root().require_maps("parts")) {
      part.require_number("mass", "kg", 0, 1);
      part.finish();
    }
  }
  file->root().finish();
  const auto done = file->finish();
  return done ? "" : done.error().message;
}

TEST(YamlReader, ReadsValidValues) {
  EXPECT_EQ(mistakes_in("stiffness: 800\nname: arm\nplace: [0.1, -1, +1e-1]\nkind: ideal\n"), "");
}

TEST(YamlReader, ReadsAliasesAsTheirAnchors) {
  EXPECT_EQ(mistakes_in("stiffness: &k 800\nplace: &p [0.1, 0, *k]\n"),
            "arm.yaml:1: place: expected a number from -1 to 1 m, found \"800\".");
  EXPECT_EQ(mistakes_in("stiffness: 800\nparts: [&a {mass: 0.1}, *a, *a]\n"), "");
  EXPECT_EQ(mistakes_in("stiffness: 800\nparts: [&a {mass: *a}]\n"),
            "arm.yaml:2: mass: expected a number from 0 to 1 kg, found a map.");
}

TEST(YamlReader, VisitsTheMapsThatRequireMapsReturns) {
  auto file = YamlFile::parse("parts: [{mass: 1}, {mass: 2}, {mass: 3}]\nnone: 4\n", "arm.yaml");
  ASSERT_TRUE(file);
  std::vector<double> visited, returned;
  file->root().visit_maps(
      "parts", [&](YamlMap& part) { visited.push_back(part.require_number("mass", "kg", 0, 10)); });
  for (YamlMap& part : file->root().require_maps("parts")) {
    returned.push_back(part.require_number("mass", "kg", 0, 10));
  }
  EXPECT_EQ(visited, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(returned, visited);
  EXPECT_EQ(file->root().list_size("parts"), 3u);
  EXPECT_EQ(file->root().list_size("none"), 0u);
  EXPECT_EQ(file->root().list_size("absent"), 0u);
}

TEST(YamlReader, NonNumberErrorNamesFileLineAndRange) {
  EXPECT_EQ(mistakes_in("name: a\nstiffness: stiff\n"),
            "arm.yaml:2: stiffness: expected a number from 0 to 100000 N/m, found \"stiff\".");
}

TEST(YamlReader, RejectsValuesThatAreNotFiniteOrInRange) {
  for (const std::string value :
       {".nan",   "nan",    ".inf", "-.inf", "inf",     "-1",   "1e6", "1e999",
        "0x10",   "12 N/m", "1,5",  "'800'", "\"800\"", "~",    "",    "[800]",
        "{a: 1}", "true",   "1e",   "--3",   "+-3",     "1_000"}) {
    const std::string said = mistakes_in("stiffness: " + value + "\n");
    EXPECT_TRUE(
        said.starts_with("arm.yaml:1: stiffness: expected a number from 0 to 100000 N/m, found "))
        << value << " -> " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << value;
  }
}

TEST(YamlReader, NamesQuotesAsTheCauseThatAValueIsAText) {
  const std::string cause = "; remove the quotes.";
  EXPECT_EQ(mistakes_in("stiffness: \"800\"\n"),
            "arm.yaml:1: stiffness: expected a number from 0 to 100000 N/m, found \"800\", a text "
            "because of its quotes" +
                cause);
  EXPECT_TRUE(mistakes_in("stiffness: 1\nplace: [0, '0.5', 0]\n").ends_with(cause));
  EXPECT_TRUE(mistakes_in("stiffness: 1\ncount: '7'\n").ends_with(cause));
  EXPECT_TRUE(mistakes_in("stiffness: 1\nrepair: 'true'\n").ends_with(cause));
  for (const char* other : {"stiff", "'stiff'", "900000", "[\"800\"]"}) {
    EXPECT_EQ(mistakes_in("stiffness: " + std::string(other) + "\n").find("quotes"),
              std::string::npos)
        << other;
  }
}

TEST(YamlReader, NamesTheMissingKey) {
  EXPECT_EQ(mistakes_in("name: a\n"), "arm.yaml:1: stiffness: is missing.");
}

TEST(YamlReader, SuggestsTheNearestKnownKeyForAnUnknownOne) {
  EXPECT_EQ(mistakes_in("stiffness: 1\nnmae: a\n"),
            "arm.yaml:2: nmae: unknown key (did you mean \"name\"?).");
  EXPECT_EQ(mistakes_in("stiffness: 1\nwxyzwxyz: a\n"), "arm.yaml:2: wxyzwxyz: unknown key.");
}

TEST(YamlReader, RejectsADuplicateKey) {
  EXPECT_EQ(mistakes_in("stiffness: 1\nname: a\nstiffness: 2\n"),
            "arm.yaml:3: stiffness: occurs twice, first in line 1; keep one of them.");
}

TEST(YamlReader, RefusesEmptyFilesInOneSentence) {
  for (const std::string text : {"", "\n\n", "# nothing\n", "---\n", "~\n"}) {
    EXPECT_EQ(mistakes_in(text), "arm.yaml:1: is empty; expected a map of keys and values.")
        << text;
  }
}

TEST(YamlReader, RejectsNonMaps) {
  EXPECT_EQ(mistakes_in("- 1\n- 2\n"),
            "arm.yaml:1: expected a map of keys and values, found a list of 2.");
  EXPECT_EQ(mistakes_in("hello\n"),
            "arm.yaml:1: expected a map of keys and values, found \"hello\".");
}

TEST(YamlReader, SyntaxErrorNamesTheLine) {
  EXPECT_TRUE(
      mistakes_in("name: a\nstiffness: [1, 2\n").starts_with("arm.yaml:3: is not valid YAML"));
  EXPECT_TRUE(mistakes_in("name: a\n stiffness: 1\n").starts_with("arm.yaml:2: is not valid YAML"));
  EXPECT_TRUE(mistakes_in("name: *missing\n").starts_with("arm.yaml:1: is not valid YAML"));
}

TEST(YamlReader, DeepNestingIsAnError) {
  const std::string said = mistakes_in(std::string(200000, '['));
  EXPECT_TRUE(said.starts_with("arm.yaml")) << said.substr(0, 200);
  EXPECT_LT(said.size(), 300U);
}

TEST(YamlReader, RefusesASecondDocument) {
  EXPECT_NE(mistakes_in("stiffness: 1\n---\nstiffness: 2\n").find("expected one document"),
            std::string::npos);
}

TEST(YamlReader, EndsIfTheParserMakesNoProgress) {
  // Before such a comma yaml-cpp returns one empty document after the other.
  for (const char* text : {",", ",nv", "a: 1\n---\n,b", "a: 1\n,b"}) {
    const auto file = scene::YamlFile::parse(text, "arm.yaml");
    ASSERT_FALSE(file.ok()) << text;
    EXPECT_TRUE(file.error().message.starts_with("arm.yaml")) << file.error().message;
  }
}

TEST(YamlReader, ChecksEachNumberOfAVector) {
  EXPECT_EQ(mistakes_in("stiffness: 1\nplace: [0, 1]\n"),
            "arm.yaml:2: place: expected a list of three numbers in m, found a list of 2.");
  EXPECT_EQ(mistakes_in("stiffness: 1\nplace: [0, 0,\n 7]\n"),
            "arm.yaml:3: place: expected a number from -1 to 1 m, found \"7\".");
}

TEST(YamlReader, NamesTheChoices) {
  EXPECT_EQ(mistakes_in("stiffness: 1\nkind: perfect\n"),
            "arm.yaml:2: kind: expected quantised or ideal, found \"perfect\".");
}

TEST(YamlReader, ChecksMapsInLists) {
  EXPECT_EQ(mistakes_in("stiffness: 1\nparts:\n  - {mass: 0.5}\n  - {mass: 5}\n"),
            "arm.yaml:4: mass: expected a number from 0 to 1 kg, found \"5\".");
  EXPECT_EQ(mistakes_in("stiffness: 1\nparts: []\n"),
            "arm.yaml:2: parts: expected a list with at least one entry, found a list of 0.");
  EXPECT_EQ(mistakes_in("stiffness: 1\nparts: [3]\n"),
            "arm.yaml:2: parts: expected a map of keys and values, found \"3\".");
}

TEST(YamlReader, TurnsAboutTheFixedAxesInOrder) {
  auto file = scene::YamlFile::parse("r: [[x, 90], [z, 90]]\n", "arm.yaml");
  ASSERT_TRUE(file.ok());
  const Eigen::Matrix3d R = file->root().optional_rotation("r");
  // The first rotation maps y to z, and the second keeps z; z -> -y -> x.
  EXPECT_LT((R * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_LT((R * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_TRUE(file->finish().ok());
  for (const std::string wrong :
       {"90", "[90]", "[[w, 90]]", "[[x]]", "[[x, east]]", "[[x, 400]]"}) {
    EXPECT_NE(mistakes_in("stiffness: 1\nrotate_degrees: " + wrong + "\n"), "") << wrong;
  }
}

TEST(YamlReader, KeepsTheFirstFiveMistakesAndCountsTheRest) {
  const std::string said =
      mistakes_in("stiffness: 1\nq1: 1\nq2: 1\nq3: 1\nq4: 1\nq5: 1\nq6: 1\nq7: 1\n");
  EXPECT_NE(said.find("arm.yaml:6: q5"), std::string::npos) << said;
  EXPECT_EQ(said.find("q6"), std::string::npos) << said;
  EXPECT_TRUE(said.ends_with("\n2 more mistakes follow.")) << said;
}

TEST(YamlReader, CountsASingleFurtherMistakeInTheSingular) {
  const std::string said = mistakes_in("stiffness: 1\nq1: 1\nq2: 1\nq3: 1\nq4: 1\nq5: 1\nq6: 1\n");
  EXPECT_TRUE(said.ends_with("\n1 more mistake follows.")) << said;
}

TEST(YamlReader, ReportsAMissingFile) {
  const auto file = scene::YamlFile::load("no/such/file.yaml");
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().message, "no/such/file.yaml: there is no such file.");
}

// Reads integers, and checks them against each other.
std::string whole_mistakes_in(const std::string& text) {
  auto file = scene::YamlFile::parse(text, "arm.yaml");
  if (!file) return file.error().message;
  scene::YamlMap& root = file->root();
  const std::int64_t seed = root.require_whole("seed", "", 1, std::int64_t{1} << 53);
  const auto home = root.optional_three_whole("home", {0, 0, 0}, "counts", -1000, 1000);
  if (root.has("sign")) root.require_signs("sign");
  if (home[0] > seed) root.reject("home", "must not be above seed");
  root.finish();
  const auto done = file->finish();
  return done ? "" : done.error().message;
}

TEST(YamlWhole, ReadsEveryFormOfAWholeNumber) {
  for (const std::string value : {"1", "+7", "7.0", "1e3", "0007", "9007199254740992"}) {
    EXPECT_EQ(whole_mistakes_in("seed: " + value + "\n"), "") << value;
  }
}

// Beyond 2^53 two different texts could mean the same double.
TEST(YamlWhole, IsExactUpToTwoToThe53) {
  EXPECT_EQ(to_whole("9007199254740992"), std::int64_t{1} << 53);
  EXPECT_EQ(to_whole("-9007199254740992"), -(std::int64_t{1} << 53));
  EXPECT_EQ(to_whole("9007199254740993"), std::nullopt);
  EXPECT_EQ(to_whole("-9007199254740993"), std::nullopt);
}

TEST(YamlWhole, RejectsOtherValuesWithOneMessage) {
  for (const std::string value : {"7.5",
                                  "0x1f",
                                  "0o17",
                                  "0b1",
                                  "1_000",
                                  "1,000",
                                  "-1",
                                  "0",
                                  "9007199254740993",
                                  "1e16",
                                  "9.007199254740993e15",
                                  "123456789012345678901234",
                                  "1e999",
                                  ".inf",
                                  ".nan",
                                  "'7'",
                                  "~",
                                  "[7]",
                                  "{a: 7}",
                                  "true",
                                  "7 N",
                                  "--7",
                                  "7e",
                                  "0.1"}) {
    const std::string said = whole_mistakes_in("seed: " + value + "\n");
    EXPECT_TRUE(said.starts_with(
        "arm.yaml:1: seed: expected a whole number from 1 to 9007199254740992, found "))
        << value << " -> " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

TEST(YamlWhole, ChecksEachOfThree) {
  EXPECT_EQ(whole_mistakes_in("seed: 9\nhome: [1, 2.5, 3]\n"),
            "arm.yaml:2: home: expected a whole number from -1000 to 1000 counts, found \"2.5\".");
  EXPECT_EQ(whole_mistakes_in("seed: 9\nhome: [1, 2]\n"),
            "arm.yaml:2: home: expected a list of three whole numbers, found a list of 2.");
}

TEST(YamlWhole, SignsAreOneOrMinusOne) {
  EXPECT_EQ(whole_mistakes_in("seed: 9\nsign: [1, -1, 1.0]\n"), "");
  EXPECT_EQ(whole_mistakes_in("seed: 9\nsign: [1, 0, 1]\n"),
            "arm.yaml:2: sign: expected each to be 1 or -1, found \"0\".");
}

TEST(YamlReader, ChecksAgainstWrongValuesAreNotReported) {
  EXPECT_EQ(whole_mistakes_in("seed: 3\nhome: [7, 0, 0]\n"),
            "arm.yaml:2: home: must not be above seed.");
  EXPECT_EQ(whole_mistakes_in("seed: 0x3\nhome: [7, 0, 0]\n"),
            "arm.yaml:1: seed: expected a whole number from 1 to 9007199254740992, found \"0x3\".");
}

TEST(YamlReader, TimeIsLinearInUnknownKeys) {
  // Reads n keys. Returns the processor time, s.
  const auto seconds = [](int n) {
    std::string text = "stiffness: 1\n";
    for (int i = 0; i < n; ++i) text += "unknown_key_" + std::to_string(i) + ": 1\n";
    const std::clock_t begin = std::clock();
    EXPECT_TRUE(mistakes_in(text).ends_with(std::to_string(n - 5) + " more mistakes follow."));
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  };
  seconds(1000);
  // If each key were compared with every other, five times the keys would take 25 times as long.
  const double few = std::min(seconds(16'000), seconds(16'000));
  EXPECT_LT(std::min(seconds(80'000), seconds(80'000)), 12 * few);
}

TEST(YamlReader, NeverThrowsOnCutOrScrambledFiles) {
  const std::string whole =
      "stiffness: 800\nname: 'arm'\nplace: [0, &a 1, *a]\nparts:\n  - {mass: 1}\n";
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    EXPECT_NO_THROW(mistakes_in(whole.substr(0, size))) << size;
    for (const char c : {'[', '{', ':', '"', '\t', '&', '*', '-', '\0', '\x80'}) {
      std::string scrambled = whole;
      scrambled.insert(size, 1, c);
      EXPECT_NO_THROW(mistakes_in(scrambled)) << size << ' ' << c;
    }
  }
}

TEST(YamlReader, NotesTheLimitsOfARequiredNumber) {
  KeyLog log;
  auto file = scene::YamlFile::parse("mass: 1\n", "arm.yaml", &log);
  ASSERT_TRUE(file);
  file->root().require_number("mass", "kg", 0.5, 10);
  ASSERT_EQ(log.notes().size(), 1U);
  EXPECT_EQ(log.notes()[0].values.min, 0.5);
  EXPECT_EQ(log.notes()[0].values.max, 10);
  EXPECT_EQ(log.notes()[0].need, KeyNeed::kRequired);
}

TEST(YamlReader, NotesTheDefaultOfThreeNumbers) {
  KeyLog log;
  auto file = scene::YamlFile::parse("a: 1\n", "arm.yaml", &log);
  ASSERT_TRUE(file);
  file->root().optional_vector3("place", {1, 2, 3}, "m", -5, 5);
  ASSERT_EQ(log.notes().size(), 1U);
  EXPECT_EQ(need_in_words(log.notes()[0]), "default [1, 2, 3]");
}

TEST(YamlReader, NotesAKeyThatIsLookedForAsOptional) {
  KeyLog log;
  auto file = scene::YamlFile::parse("mass: 1\n", "arm.yaml", &log);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->root().has("mass"));
  file->root().require_number("mass", "kg", 0.5, 10);
  ASSERT_EQ(log.notes().size(), 1U);
  EXPECT_EQ(log.notes()[0].need, KeyNeed::kOptional);
}

}  // namespace
}  // namespace thimble::scene
