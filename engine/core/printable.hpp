// Text of others (names, arguments, values of a file) as it may be shown: nothing in it steers a terminal.
#pragma once

#include <string>
#include <string_view>

namespace pkm {

/// The text with its control characters (those of Unicode and those that change the direction of writing, too) and
/// with bytes that are no UTF-8 as "\x1b". All else, backslashes included, stays: printable text stays as it is.
/// @param keep  control characters that stay, such as "\n"
std::string printable(std::string_view text, std::string_view keep = "");

/// At most so many bytes of the text: of a longer one its beginning, "..." and its end.
std::string excerpt(std::string_view text, std::size_t longest);

/// How many bytes at the end of the text begin a character of UTF-8 that more text may complete.
std::size_t begun_character(std::string_view text);

}  // namespace pkm
