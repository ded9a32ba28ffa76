#include "yaml/yaml_reader.h"

#include <gtest/gtest.h>

#include <string>

namespace thimble::app {
namespace {

// Reads `text` as a small file with one number and one word, and tells what was wrong with it.
std::string mistakes_in(const std::string& text) {
  auto file = scene::YamlFile::parse(text, "arm.yaml");
  if (!file) return file.error().message;
  file->root().require_number("stiffness", "N/m", 0, 1e5);
  file->root().optional_string("name", "");
  file->root().optional_vector3("place", Eigen::Vector3d::Zero(), "m", -1, 1);
  file->root().optional_rotation("rotate_degrees");
  if (file->root().has("kind")) file->root().require_choice("kind", {"quantised", "ideal"});
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

TEST(YamlReader, ReadsWhatIsRight) {
  EXPECT_EQ(mistakes_in("stiffness: 800\nname: arm\nplace: [0.1, -1, +1e-1]\nkind: ideal\n"), "");
}

TEST(YamlReader, TellsFileLineAndRangeOfAWordInPlaceOfANumber) {
  EXPECT_EQ(mistakes_in("name: a\nstiffness: stiff\n"),
            "arm.yaml:2: stiffness: expected a number from 0 to 100000 N/m, found \"stiff\".");
}

TEST(YamlReader, RefusesEveryValueThatIsNoFiniteNumberInRange) {
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

TEST(YamlReader, NamesTheMissingKey) {
  EXPECT_EQ(mistakes_in("name: a\n"), "arm.yaml:1: stiffness: is missing here.");
}

TEST(YamlReader, SuggestsTheNearestKnownKeyForAnUnknownOne) {
  EXPECT_EQ(mistakes_in("stiffness: 1\nnmae: a\n"),
            "arm.yaml:2: nmae: is no key that is known here; perhaps \"name\" was meant.");
  EXPECT_EQ(mistakes_in("stiffness: 1\nwxyzwxyz: a\n"),
            "arm.yaml:2: wxyzwxyz: is no key that is known here.");
}

TEST(YamlReader, RefusesAKeyThatStandsTwice) {
  EXPECT_EQ(mistakes_in("stiffness: 1\nname: a\nstiffness: 2\n"),
            "arm.yaml:3: stiffness: stands twice, first in line 1; keep one of them.");
}

TEST(YamlReader, RefusesEmptyFilesInOneSentence) {
  for (const std::string text : {"", "\n\n", "# nothing\n", "---\n", "~\n"}) {
    EXPECT_EQ(mistakes_in(text), "arm.yaml: is empty; expected a map of keys and values.") << text;
  }
}

TEST(YamlReader, RefusesWhatIsNoMap) {
  EXPECT_EQ(mistakes_in("- 1\n- 2\n"),
            "arm.yaml:1: expected a map of keys and values, found a list of 2.");
  EXPECT_EQ(mistakes_in("hello\n"),
            "arm.yaml:1: expected a map of keys and values, found \"hello\".");
}

TEST(YamlReader, TellsTheLineOfASyntaxError) {
  EXPECT_TRUE(
      mistakes_in("name: a\nstiffness: [1, 2\n").starts_with("arm.yaml:3: is not proper YAML"));
  EXPECT_TRUE(
      mistakes_in("name: a\n\tstiffness: 1\n").starts_with("arm.yaml:2: is not proper YAML"));
  EXPECT_TRUE(mistakes_in("name: *nobody\n").starts_with("arm.yaml:1: is not proper YAML"));
}

TEST(YamlReader, AnswersHugeNestingWithASentence) {
  const std::string said = mistakes_in(std::string(200000, '['));
  EXPECT_TRUE(said.starts_with("arm.yaml")) << said.substr(0, 200);
  EXPECT_LT(said.size(), 300U);
}

TEST(YamlReader, RefusesASecondDocument) {
  EXPECT_NE(mistakes_in("stiffness: 1\n---\nstiffness: 2\n").find("expected one document"),
            std::string::npos);
}

TEST(YamlReader, EndsWhereTheParserStandsStill) {
  // Before such a comma yaml-cpp finds one empty document after the other.
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
  // y -> z by the first turn, and z stays z in the second; z -> -y -> x.
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

TEST(YamlReader, NamesAFileThatIsNotThere) {
  const auto file = scene::YamlFile::load("no/such/file.yaml");
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().message, "no/such/file.yaml: there is no such file.");
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

}  // namespace
}  // namespace thimble::app
