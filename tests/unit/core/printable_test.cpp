#include "engine/core/printable.hpp"

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  for (const std::string text : {"", "plain \\ text", "m²", "größer 工 🤖", "\\x1b"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesWhatSteersATerminal) {
  EXPECT_EQ(printable("\x1b[31mred\x7f\n\t"), "\\x1b[31mred\\x7f\\x0a\\x09");
  EXPECT_EQ(printable("a\nb\tc\r", "\n\t"), "a\nb\tc\\x0d");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");  // the control sequence introducer of one character
  EXPECT_EQ(printable("a\u202e"
                      "b"),
            "a\\xe2\\x80\\xae"
            "b");  // writes from right to left
}

TEST(Printable, EscapesBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\x9b[2J"), "\\x9b[2J");
  EXPECT_EQ(printable("\xc3"), "\\xc3");
  EXPECT_EQ(printable("\xc0\x8a"), "\\xc0\\x8a");  // an overlong line feed
  EXPECT_EQ(printable("\xe0\x80\x9b"), "\\xe0\\x80\\x9b");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a surrogate pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(Excerpt, KeepsBeginningAndEnd) {
  EXPECT_EQ(excerpt("short", 5), "short");
  std::string text(1000, 'a');
  text.append("end");
  EXPECT_EQ(excerpt(text, 23), "aaaaaaaaaaaaaaa...aaend");
  for (std::size_t longest = 8; longest < 40; ++longest) {
    const std::string cut = excerpt("ääääääääääääääääääääääääääää", longest);
    EXPECT_LE(cut.size(), longest);
    EXPECT_EQ(printable(cut), cut);
  }
}

TEST(BegunCharacter, CountsBytesThatMoreTextMayComplete) {
  EXPECT_EQ(begun_character("a"), 0u);
  EXPECT_EQ(begun_character("ä"), 0u);
  EXPECT_EQ(begun_character("a\xc3"), 1u);
  EXPECT_EQ(begun_character("\xf0\x9f\xa4"), 3u);
  EXPECT_EQ(begun_character("\x80\x80\x80\x80"), 0u);
}

}  // namespace
}  // namespace pkm
