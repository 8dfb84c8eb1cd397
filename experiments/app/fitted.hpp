// Rows of tables that end in a sentence, on a terminal that is narrower than they are.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace pkm {

/// Columns of the terminal behind the descriptor; 0: it is none, or does not tell.
std::size_t columns_of_terminal(int descriptor);

/// Whole lines, painted or not. The sentence that a row of a table ends in goes on below its own beginning where the
/// columns end; other lines stay as they are, so that commands, numbers and JSON are copied as they came.
std::string fitted(std::string_view lines, std::size_t columns);

}  // namespace pkm
