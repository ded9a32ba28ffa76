// Files with renamed keys are still read, with a warning that gives the new name.
#include "yaml/renamed_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scene_keys.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {
namespace {

/// Reads a map of a sandpaper effect with an optional wavelength.
struct Reading {
  double wavelength = 0;
  std::string mistakes;
  std::vector<std::string> warnings;
};

Reading read(const std::string& text, const std::string& place = "effects[] texture: sandpaper") {
  auto file = YamlFile::parse(text, "scene.yaml");
  if (!file) return {.wavelength = 0, .mistakes = file.error().message, .warnings = {}};
  file->root().set_place(place);
  Reading reading;
  reading.wavelength = file->root().optional_number("wavelength", 0.002, "m", 1e-5, 0.1);
  file->root().finish();
  const auto done = file->finish();
  if (!done) reading.mistakes = done.error().message;
  reading.warnings = file->warnings();
  return reading;
}

TEST(RenamedKeys, AreReadWithAWarning) {
  const Reading reading = read("\ngrain: 0.003\n");
  EXPECT_EQ(reading.mistakes, "");
  EXPECT_EQ(reading.wavelength, 0.003);
  ASSERT_EQ(reading.warnings.size(), 1U);
  EXPECT_EQ(reading.warnings[0],
            "scene.yaml:2: grain: is now called wavelength; the old name still works, but use "
            "the new one.");
}

TEST(RenamedKeys, NewNamesGiveNoWarning) {
  const Reading reading = read("wavelength: 0.003\n");
  EXPECT_EQ(reading.mistakes, "");
  EXPECT_EQ(reading.wavelength, 0.003);
  EXPECT_TRUE(reading.warnings.empty());
}

TEST(RenamedKeys, AreCheckedLikeTheNewOnes) {
  EXPECT_NE(read("grain: 7\n").mistakes.find("expected a number from 1e-05 to 0.1 m"),
            std::string::npos);
}

TEST(RenamedKeys, AreRejectedNextToTheNewName) {
  EXPECT_EQ(read("wavelength: 0.003\ngrain: 0.004\n").mistakes,
            "scene.yaml:2: grain: is the old name of wavelength, which is here too; keep the "
            "new one.");
}

TEST(RenamedKeys, AreKnownOnlyInTheirOwnMap) {
  const Reading reading = read("grain: 0.003\n", "effects[] texture: sines.waves[]");
  EXPECT_NE(reading.mistakes.find("grain: unknown key"), std::string::npos);
  EXPECT_TRUE(reading.warnings.empty());
}

// The table uses the same places and keys as the readers.
TEST(RenamedKeys, LeadToExistingKeys) {
  auto keys = scene_keys().value();
  const auto arm = arm_keys();
  keys.insert(keys.end(), arm.begin(), arm.end());
  for (const RenamedKey& renamed : kRenamedKeys) {
    const auto has = [&](std::string_view key) {
      return std::any_of(keys.begin(), keys.end(), [&](const KeyNote& note) {
        return note.place == renamed.place && note.key == key;
      });
    };
    EXPECT_TRUE(has(renamed.is)) << renamed.place << ": " << renamed.is;
    EXPECT_FALSE(has(renamed.was)) << renamed.place << ": " << renamed.was;
  }
}

}  // namespace
}  // namespace thimble::scene
