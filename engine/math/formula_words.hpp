// The words of a formula: which there are, and what is refused word by word.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/math/formula_program.hpp"

namespace pkm::formula {

struct Function {
  std::string name;
  std::size_t arguments = 1;  ///< 0: two or more
  Operation operation = Operation::nothing;
};

/// Every function that a formula may call.
const std::vector<Function>& functions();

inline constexpr const char* kPiName = "pi";

bool is_blank(char c);
bool is_name_part(char c);
/// A name that a formula can hold and does not know already.
bool may_be_name(const std::string& name);

/// Length of the number at the beginning of `text`, 0 when there is none. A number that no double holds is NaN. Does
/// not depend on the locale.
std::size_t read_number(std::string_view text, double& value);

/// Throws std::invalid_argument with the formula and what is wrong with it.
[[noreturn]] void refuse(const std::string& text, const std::string& sentence);
/// "'x' at character 3", counted from 1.
std::string quote(std::string_view word, std::size_t place);

/// Refuses what muParser would take, or say too little of: unknown names and functions, wrong numbers of arguments,
/// parentheses, commas, assignments, texts. The order of operators and operands is left to muParser.
/// @return  the text for muParser, which wants a function's '(' right behind its name; all else is where it was
std::string check_words(const std::string& text, const std::vector<std::string>& names);

}  // namespace pkm::formula
