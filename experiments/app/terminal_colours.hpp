// Colours for output on a terminal, by ECMA-48 escape sequences. Commands print plain text; this filter recognises
// headings, labels such as "warning:", satisfied and violated constraints, and error messages by their wording and
// colours them.
#pragma once

#include <string>
#include <string_view>

namespace pkm {

/// @return true if the file descriptor is a terminal with colours and NO_COLOR (https://no-color.org) is not set
bool supports_colours(int descriptor);

/// Adds colours to complete lines. If the escape sequences are removed from the result, the input is obtained.
/// @param program  name of the program, with which its error messages begin
std::string coloured(std::string_view lines, std::string_view program);

}  // namespace pkm
