#include "engine/core/printable.hpp"

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(Printable, LeavesPrintableTextUnchanged) {
  for (const std::string text : {"", "plain \\ text", "m²", "größer 工 🤖", "\\x1b"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesControlCharacters) {
  EXPECT_EQ(printable("\x1b[31mred\x7f\n\t"), "\\x1b[31mred\\x7f\\x0a\\x09");
  EXPECT_EQ(printable("a\nb\tc\r", "\n\t"), "a\nb\tc\\x0d");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");  // the C1 control sequence introducer (CSI)
  EXPECT_EQ(printable("a\u202e"
                      "b"),
            "a\\xe2\\x80\\xae"
            "b");  // right-to-left override
}

TEST(Printable, EscapesInvalidUtf8) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\x9b[2J"), "\\x9b[2J");
  EXPECT_EQ(printable("\xc3"), "\\xc3");
  EXPECT_EQ(printable("\xc0\x8a"), "\\xc0\\x8a");  // an overlong line feed
  EXPECT_EQ(printable("\xe0\x80\x9b"), "\\xe0\\x80\\x9b");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a surrogate pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(Excerpt, KeepsTheBeginningAndTheEnd) {
  EXPECT_EQ(excerpt("short", 5), "short");
  std::string text(1000, 'a');
  text.append("end");
  EXPECT_EQ(excerpt(text, 23), "aaaaaaaaaaaaaaa...aaend");
  for (std::size_t max_size = 8; max_size < 40; ++max_size) {
    const std::string abbreviated = excerpt("ääääääääääääääääääääääääääää", max_size);
    EXPECT_LE(abbreviated.size(), max_size);
    EXPECT_EQ(printable(abbreviated), abbreviated);
  }
}

TEST(IncompleteCharacter, IsFoundAtTheEndOfAText) {
  EXPECT_EQ(incomplete_character_size("a"), 0u);
  EXPECT_EQ(incomplete_character_size("ä"), 0u);
  EXPECT_EQ(incomplete_character_size("a\xc3"), 1u);
  EXPECT_EQ(incomplete_character_size("\xf0\x9f\xa4"), 3u);
  EXPECT_EQ(incomplete_character_size("\x80\x80\x80\x80"), 0u);
}

}  // namespace
}  // namespace pkm
