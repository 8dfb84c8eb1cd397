// Colours on a terminal. What a command prints is the same everywhere; on a terminal its lines are painted by what they
// say: headings, what holds and what is broken, what is active, what is wrong, what to type next.
#pragma once

#include <string>
#include <string_view>

namespace pkm {

/// A terminal that has colours is behind the descriptor, and NO_COLOR (https://no-color.org) does not forbid them.
bool shows_colours(int descriptor);

/// Whole lines with colours: without their escape sequences they are what came.
/// @param program  whose name stands before complaints
std::string painted(std::string_view lines, std::string_view program);

}  // namespace pkm
