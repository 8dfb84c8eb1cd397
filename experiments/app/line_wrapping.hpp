// Wraps the last column of printed tables to the width of the terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace pkm {

/// Width of the terminal in columns; 0 if the file descriptor is not a terminal or its width is unknown.
std::size_t terminal_width(int descriptor);

/// Wraps table rows that end in a sentence and are wider than `columns`: the sentence continues below its own
/// beginning. Other lines are unchanged, so that commands, numbers and JSON can be copied. Lines may contain colours.
/// @param lines    complete lines
/// @param columns  width of the terminal; 0: no wrapping
std::string wrap_table_rows(std::string_view lines, std::size_t columns);

}  // namespace pkm
