// Lexer of formulas: splits the text into tokens and reports the errors that need no grammar (unknown names, wrong
// numbers of arguments, unbalanced parentheses and brackets).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/expression/formula_value.hpp"
#include "engine/expression/symbol_table.hpp"

namespace pkm::expression {

struct Token {
  std::string text;
  std::size_t position = 0;                         ///< position in the formula of the token's first character, from 0
  std::optional<double> number = {};                ///< the value, if the token is a number
  std::optional<std::size_t> name = {};             ///< index of the variable, if the token is its name
  const Operation* function = nullptr;              ///< called function of scalars; the next token is its '('
  const VectorFunction* vector_function = nullptr;  ///< called function of vectors; the next token is its '('
  std::string part = "";  ///< "x" for the token ".x", which selects this part of the preceding value; otherwise ""
};

/// True if a variable of a formula can have this name: letters, digits and '_', not beginning with a digit, and neither
/// `pi` nor a function.
bool may_be_name(const std::string& name);

/// Throws std::invalid_argument with the message: the formula "TEXT" ERROR.
/// @param error  the predicate of this sentence, such as "has the unknown name 'x' at character 3"
[[noreturn]] void refuse(const std::string& text, const std::string& error);
/// A token with its position, for messages: "'x' at character 3". @param position  position of the first character,
/// from 0; printed from 1
std::string quote(std::string_view token, std::size_t position);

/// Splits a formula into tokens. Throws std::invalid_argument on unknown names and functions, wrong numbers of
/// arguments, unbalanced parentheses and brackets, commas outside of calls and vectors, assignments and unknown
/// characters. The order of
/// operators and operands is checked by the parser.
std::vector<Token> tokenize(const std::string& text, const Names& names);

}  // namespace pkm::expression
