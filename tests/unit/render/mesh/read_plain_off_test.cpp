// OFF files with one vertex or triangle per line are read without words: bit-identical to reading
// word by word, and only if each line has that form.
#include "mesh/file/read_plain_off.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>

#include "mesh/file/read_off.h"
#include "support/random.h"

namespace thimble::render {
namespace {

/// Returns a number in one of the forms that programs write.
std::string number_text(support::Random& random) {
  const double x = random.uniform(-2, 2);
  constexpr const char* kForms[] = {"%.7f", "%.17g", "%.9g", "%.3e", "%+.4f", "%.0f", "%g", "%.1f"};
  char text[64];
  const auto form = static_cast<std::size_t>(random.bits() % 10);
  if (form == 8) return ".5";
  if (form == 9) return "-0";
  std::snprintf(text, sizeof(text), kForms[form], x * (form == 3 ? 1e-9 : 1));
  return text;
}

TEST(ReadPlainOff, GivesTheNumbersOfReadingByWords) {
  support::Random random(1);
  // With two threads, and without.
  for (const std::size_t count : {1UL, 2UL, 999UL, 50'001UL}) {
    std::string first, rest;
    for (std::size_t i = 0; i < count; ++i) {
      std::string& to = i == 0 ? first : rest;
      const char* const gap = i % 3 == 0 ? "  " : " ";
      to += number_text(random) + gap + number_text(random) + " " + number_text(random) +
            (i % 5 == 0   ? " \n"
             : i % 7 == 0 ? "\r\n"
                          : "\n");
    }
    for (std::size_t i = 0; i < count + 2; ++i) {
      rest += "3";
      for (int k = 0; k < 3; ++k) {
        rest += " " + std::to_string(random.bits() % count);
      }
      rest += i + 1 < count + 2 ? "\n" : "";
    }
    const auto plain = read_plain_off(first + rest, count, count + 2);
    ASSERT_TRUE(plain) << count;
    const std::string head =
        "OFF\n" + std::to_string(count) + " " + std::to_string(count + 2) + " 0\n";
    // A comment is not plain.
    const std::string with_words = first + "# words\n" + rest;
    EXPECT_FALSE(read_plain_off(with_words, count, count + 2));
    const auto words = read_off(head + with_words, "words.off");
    ASSERT_TRUE(words) << words.error().message;
    ASSERT_EQ(plain->vertices.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(std::bit_cast<std::uint64_t>(plain->vertices[i][axis]),
                  std::bit_cast<std::uint64_t>(words->vertices[i][axis]))
            << "vertex " << i;
      }
    }
    EXPECT_EQ(plain->triangles, words->triangles);
    const auto whole = read_off(head + first + rest, "plain.off");
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->triangles, words->triangles);
    EXPECT_EQ(whole->vertices, words->vertices);
  }
}

TEST(ReadPlainOff, LeavesAllOtherFormsToReadingByWords) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_TRUE(read_plain_off(vertices + "3 0 1 2\n", 3, 1));
  EXPECT_TRUE(read_plain_off(vertices + "3 0 1 2", 3, 1));
  EXPECT_TRUE(read_plain_off(vertices + "3 0 1 2\nmore", 3, 1)) << "as word by word";
  for (const char* const other :
       {"3 0 1 3\n", "3 0 1 -1\n", "3 0 1 +2\n", "3 0 1\n2\n", "3 0 1 2 7\n", "4 0 1 2 0\n",
        "3\t0 1 2\n", "\n3 0 1 2\n", "3 0 1 2#\n", "3 0 1 2\r\r\n", "3 0 1 2.0\n",
        "3 0 1 4294967297\n", "3 0 1 18446744073709551618\n", "3 0 1 x\n", "3 0 1 :       \n",
        "3 0 1 /       \n", "", "03 0 1 0000000002\n", "2 0 1\n"}) {
    EXPECT_FALSE(read_plain_off(vertices + other, 3, 1)) << other;
  }
  for (const char* const other :
       {"0 0 1mm\n", "0 0\n0\n", "0 0 0 0\n", "0 0 nan\n", "0 0 inf\n", "0 0 1e16\n",
        "0 0 -1000000000000001\n", "0,0 0 0\n", "0 0 .\n", "0 0 -\n", "0 0 1.2.3\n", "0\t0 0\n",
        "0 0 0 #\n", "\n0 0 0\n", "0 0 0\r", "0 0 0x1\n", "0 0 :       \n"}) {
    EXPECT_FALSE(read_plain_off(other + vertices + "3 0 1 2\n", 4, 1)) << other;
  }
  EXPECT_FALSE(read_plain_off(vertices + "3 0 1 2\n", 3, 0));
  EXPECT_FALSE(read_plain_off(vertices + "3 0 1 2\n", 3, 2));
  EXPECT_FALSE(read_plain_off(vertices, 5, 1));
  EXPECT_FALSE(read_plain_off("", 0, 0));
}

}  // namespace
}  // namespace thimble::render
