// Characters that YAML does not allow where they are: reported with line and column.
#include "yaml/yaml_text.h"

#include <gtest/gtest.h>

#include <string>

#include "text/utf8.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {
namespace {

/// Reads a text similar to a scene and returns its mistakes.
std::string mistakes_of_text(const std::string& text) {
  auto file = YamlFile::parse(text, "s.yaml");
  if (!file) return file.error().message;
  YamlMap& root = file->root();
  root.optional_string("name", "");
  if (root.has("object")) {
    YamlMap object = root.require_map("object");
    object.optional_number("stiffness", 0, "N/m", 0, 1000);
    object.finish();
  }
  root.optional_number("rate", 0, "Hz", 0, 1000);
  root.finish();
  const auto done = file->finish();
  return done ? "" : done.error().message;
}

TEST(YamlText, Latin1IsNamedWithLineAndColumn) {
  EXPECT_EQ(mistakes_of_text("rate: 7\nname: caf\xe9\n"),
            "s.yaml:2:10: the byte 0xE9 is not UTF-8; save the file as UTF-8 (it may be "
            "Latin-1: iconv -f latin1 -t utf8).");
}

TEST(YamlText, ColumnsCountCharacters) {
  EXPECT_NE(mistakes_of_text("name: \xc3\xa9\xf0\x9f\x98\x80\xff\n").find("s.yaml:1:9:"),
            std::string::npos);
}

TEST(YamlText, InvalidUtf8IsFoundInComments) {
  EXPECT_NE(mistakes_of_text("rate: 7 # 5 \xb5m\n").find("s.yaml:1:13: the byte 0xB5"),
            std::string::npos);
}

TEST(YamlText, OnlyShortestFormsOfCharactersAreUtf8) {
  for (const std::string bad : {"\xc0\x80", "\xe0\x80\x80", "\xf0\x80\x80\x80", "\xed\xa0\x80",
                                "\xf4\x90\x80\x80", "\xc3", "\xe2\x82", "\x80"}) {
    EXPECT_TRUE(find_invalid_utf8("a" + bad).has_value());
  }
}

TEST(YamlText, AcceptsAllOfUtf8) {
  EXPECT_FALSE(
      find_invalid_utf8("a\xc2\x80\xdf\xbf\xe0\xa0\x80\xed\x9f\xbf\xee\x80\x80\xef\xbf\xbf"
                        "\xf0\x90\x80\x80\xf4\x8f\xbf\xbf\n"));
}

TEST(Utf8, OtherBytesAreReplaced) {
  EXPECT_EQ(as_utf8("caf\xe9.off"), "caf\xef\xbf\xbd.off");
  EXPECT_EQ(as_utf8("\xe2\x82"), "\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(as_utf8("caf\xc3\xa9"), "caf\xc3\xa9");
}

TEST(YamlText, Utf16IsLeftToTheParser) {
  std::string wide = "\xff\xfe";
  for (const char c : std::string("rate: 7\n")) wide += std::string{c, '\0'};
  EXPECT_EQ(mistakes_of_text(wide), "");
}

TEST(YamlText, IndentingTabIsNamed) {
  EXPECT_EQ(mistakes_of_text("object:\n\tstiffness: 7\n"),
            "s.yaml:2:1: a tab cannot indent in YAML; use spaces instead.");
  EXPECT_EQ(mistakes_of_text("object:\n  stiffness: 7\n \trate: 7\n"),
            "s.yaml:3:2: a tab cannot indent in YAML; use spaces instead.");
}

TEST(YamlText, IndentingNoBreakSpaceIsNamed) {
  EXPECT_EQ(mistakes_of_text("object:\n\xc2\xa0 stiffness: 7\n"),
            "s.yaml:2:1: a no-break space (U+00A0) is not a blank in YAML; use a space instead.");
}

TEST(YamlText, NoBreakSpaceBehindAColonIsNamed) {
  EXPECT_EQ(mistakes_of_text("name: a\nrate:\xc2\xa0"
                             "7\n"),
            "s.yaml:2:6: a no-break space (U+00A0) is not a blank in YAML; use a space instead.");
}

TEST(YamlText, NoBreakSpaceBehindANumberIsNamed) {
  EXPECT_EQ(mistakes_of_text("rate: 7\xc2\xa0\n"),
            "s.yaml:1:8: a no-break space (U+00A0) is not a blank in YAML; use a space instead.");
  EXPECT_EQ(mistakes_of_text("rate: 7\xe2\x80\xaf# Hz\n"),
            "s.yaml:1:8: a narrow no-break space (U+202F) is not a blank in YAML; use a space "
            "instead.");
}

TEST(YamlText, BlanksWithinTextsAreAllowed) {
  EXPECT_EQ(mistakes_of_text("name: 5\xc2\xa0N\trate\nrate:\t7\t# 5\xc2\xa0Hz\n\t\n"), "");
  EXPECT_EQ(mistakes_of_text("name: \"\xc2\xa0\"\nrate: 7\n"), "");
  EXPECT_EQ(mistakes_of_text("{\n\t\"rate\": 7\n}\n"), "");
}

TEST(YamlText, OtherMistakesKeepTheirSentence) {
  EXPECT_EQ(mistakes_of_text("name: 5\xc2\xa0N\nrate: fast\n"),
            "s.yaml:2: rate: expected a number from 0 to 1000 Hz, found \"fast\".");
  EXPECT_NE(mistakes_of_text("name: \"a\\\"\xc2\xa0: \"\nrate: [\n").find("is not valid YAML"),
            std::string::npos);
}

TEST(YamlText, CutsFoundTextsBetweenCharacters) {
  // Characters whose last byte is even and odd, begun at each of three bytes.
  for (const char* character : {"\xe2\x82\xac", "\xe2\x82\xad", "\xe2\x83\x83"}) {
    for (const char* begin : {"", "a", "ab"}) {
      std::string text = std::string("rate: ") + begin;
      for (int i = 0; i < 30; ++i) text += character;
      EXPECT_FALSE(find_invalid_utf8(mistakes_of_text(text + "\n"))) << character << begin;
    }
  }
}

}  // namespace
}  // namespace thimble::scene
