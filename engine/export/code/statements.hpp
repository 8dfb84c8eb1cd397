// Converts nodes of an expression graph to statements of a programming language.
//
// Nodes that several others use become named constants, in topological order; a node that is used once is written where
// it is used, unless the expression becomes long. The operations and their order are those of the graph, so that the
// values have the same bits as the engine's, except for the elementary functions of the language's library.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/mechanism/code_module.hpp"

namespace pkm::code {

/// Functions that write numbers, inputs and operations in the syntax of one language.
struct Syntax {
  std::string (*number)(double value, bool single_precision);
  std::string (*input)(const InputPlace& place);
  /// Writes an operation applied to operands, each of which is a name, a number or an expression in parentheses. If the
  /// result contains operators, it is in parentheses, too.
  std::string (*call)(const std::string& operation, const std::vector<std::string>& operands);
  /// Writes the definition of a constant, for example "const real t1 = a + b;".
  std::string (*define)(const std::string& name, const std::string& expression);
};

/// Writes a function body: the lines that define the constants, followed by the lines that assign() writes for each
/// output.
/// @param indent  indentation of the definitions
/// @param assign  assign(output, values): the lines that assign `values` to an output
std::string body_of(const Module& module, const Function& function, const Syntax& syntax, const std::string& indent,
                    const std::function<std::string(const Output&, const std::string*)>& assign);

/// The shortest decimal text from which the number can be read back exactly, for example "0.1" or "1e-05".
std::string shortest_number(double value);
/// Returns a text in which every occurrence of `from` is replaced by `to`.
std::string with_replacements(std::string text, const std::string& from, const std::string& to);
/// Returns the expression without the parentheses that enclose it, if there are any.
std::string without_parentheses(const std::string& expression);

/// Names and units of the elements of an array for comments: "x [m], y [m]".
std::string elements_text(const std::vector<NamedUnit>& elements);

}  // namespace pkm::code
