#include "system/printable_text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "support/seed.h"

namespace thimble::driver {
namespace {

TEST(PrintableText, KeepsTextOfEveryLanguage) {
  const std::string text =
      "plain, \xC3\xA4\xC3\xB6 \xCE\xB1 \xE6\xBC\xA2 \xF0\x9F\x90\x98 \xE2\x80\x94\n\ttab";
  EXPECT_EQ(printable(text), text);
}

TEST(PrintableText, ReplacesControlCharacters) {
  EXPECT_EQ(printable(std::string("a\x1b[31m\r\b\a\0z\x7f", 12)), "a?[31m????z?");
}

TEST(PrintableText, ReplacesControlsOfTwoBytes) {
  EXPECT_EQ(printable("a\xC2\x80\xC2\x9B\xC2\x9Fz\xC2\xA0"), "a???z\xC2\xA0");
}

TEST(PrintableText, ReplacesCharactersThatReorderText) {
  EXPECT_EQ(printable("a\xE2\x80\xAE\xE2\x81\xA6\xE2\x80\x8F\xD8\x9C\xE2\x80\xA8z"), "a?????z");
}

TEST(PrintableText, ReplacesEachByteThatIsNoUtf8) {
  EXPECT_EQ(printable("\xFFz"), "?z");
  EXPECT_EQ(printable("\x9Bz"), "?z");            // a continuation byte
  EXPECT_EQ(printable("\xC0\x9Bz"), "??z");       // ESC in two bytes
  EXPECT_EQ(printable("\xE0\x80\x9Bz"), "???z");  // and in three
  EXPECT_EQ(printable("\xED\xA0\x80z"), "???z");  // half of a surrogate pair
  EXPECT_EQ(printable("\xF4\x90\x80\x80z"), "????z");
  EXPECT_EQ(printable("a\xE2\x80"), "a??");  // truncated
}

TEST(PrintableText, ReplacesLineFeedsOfNamesOnly) {
  EXPECT_EQ(printable("a\nb\tc"), "a\nb\tc");
  EXPECT_EQ(printable_name("a\nb\tc"), "a?b?c");
}

TEST(PrintableText, LeavesPrintableTextUnchanged) {
  auto state = static_cast<std::uint32_t>(support::seed_of(1));
  for (int round = 0; round < 2000; ++round) {
    std::string text;
    for (int i = 0; i < 20; ++i) {
      state = state * 1664525 + 1013904223;
      text += static_cast<char>(state >> 24U);
    }
    const std::string once = printable(text);
    EXPECT_EQ(printable(once), once);
  }
}

}  // namespace
}  // namespace thimble::driver
