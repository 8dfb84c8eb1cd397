// Escapes and abbreviates external text (names, arguments, values from files) for display, so that it cannot contain
// terminal control sequences.
#pragma once

#include <string>
#include <string_view>

namespace pkm {

/// Escapes control characters (including the C1 and bidirectional controls of Unicode) and bytes that are not valid
/// UTF-8 in the form "\x1b". Everything else, backslashes included, is unchanged.
/// @param keep  control characters that are not escaped, such as "\n"
std::string printable(std::string_view text, std::string_view keep = "");

/// Abbreviates a text to at most `max_size` bytes: a longer text is replaced by its beginning, "..." and its end.
/// Multi-byte characters are not split.
std::string excerpt(std::string_view text, std::size_t max_size);

/// Number of bytes at the end of a text that are the beginning of a UTF-8 character, which following text may complete.
std::size_t incomplete_character_size(std::string_view text);

}  // namespace pkm
