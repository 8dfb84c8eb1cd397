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
  std::size_t position = 0;                         ///< position of its first character, from 0
  std::optional<double> number = {};                ///< value of a number
  std::optional<std::size_t> name = {};             ///< index of a variable
  const Operation* function = nullptr;              ///< called function of scalars; the next token is its '('
  const VectorFunction* vector_function = nullptr;  ///< called function of vectors; the next token is its '('
  std::string part = "";                            ///< "x" of ".x": a part of the value before it
};

/// True if a variable of a formula can have this name: letters, digits and '_', not beginning with a digit, and neither
/// `pi` nor a function.
bool may_be_name(const std::string& name);

/// Throws std::invalid_argument with the formula's text and the predicate `error`: the formula "a +" ends where ...
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
