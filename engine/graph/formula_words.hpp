// The words of a formula: which there are, and what is refused word by word.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/graph/names.hpp"
#include "engine/graph/operation.hpp"

namespace pkm::graph {

struct Word {
  std::string text;
  std::size_t place = 0;  ///< of its first character
  std::optional<double> number = {};
  std::optional<std::size_t> name = {};  ///< its position
  const Operation* function = nullptr;   ///< that is called; its '(' comes next
};

/// A name that a formula can hold and does not know already.
bool may_be_name(const std::string& name);

/// Throws std::invalid_argument with the formula and what is wrong with it.
[[noreturn]] void refuse(const std::string& text, const std::string& sentence);
/// "'x' at character 3", counted from 1.
std::string quote(std::string_view word, std::size_t place);

/// Refuses unknown names and functions, wrong numbers of arguments, parentheses, commas, assignments, texts. The order
/// of operators and operands is left to the reader.
std::vector<Word> words_of(const std::string& text, const Names& names);

}  // namespace pkm::graph
