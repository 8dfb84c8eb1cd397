#include "engine/export/code/statements.hpp"

#include <charconv>
#include <unordered_map>

namespace pkm::code {
namespace {

using expression::Entry;
using expression::Node;

constexpr std::size_t kMaxLength = 60;  // maximum number of characters of an expression that is written inline

/// Returns true if the first and the last character of a text are a matching pair of parentheses.
bool is_enclosed(const std::string& text) {
  if (text.size() < 2 || text.front() != '(' || text.back() != ')') return false;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (depth == 0 && i + 1 < text.size()) return false;
  }
  return true;
}

struct Statements {
  std::vector<std::string> definitions;
  std::vector<std::string> values;  ///< expressions for the elements of all outputs, one output after the other
};

Statements statements_of(const Module& module, const Function& function, const Syntax& syntax) {
  const expression::Graph& graph = module.graph;
  std::vector<Node> roots;
  for (const Output& output : function.outputs) roots.insert(roots.end(), output.nodes.begin(), output.nodes.end());
  const std::vector<Node> nodes = graph.reachable(roots);
  std::unordered_map<Node, int> uses;
  for (const Node node : nodes)
    for (const Node operand : graph[node].operands()) ++uses[operand];
  for (const Node root : roots) ++uses[root];
  Statements result;
  std::unordered_map<Node, std::string> texts;
  for (const Node node : nodes) {
    const Entry& entry = graph[node];
    if (entry.is_number()) {
      texts[node] = syntax.number(entry.number, module.options.single_precision);
    } else if (!entry.operation) {
      texts[node] = syntax.input(module.inputs[static_cast<std::size_t>(entry.input)]);
    } else {
      std::vector<std::string> operands;
      for (const Node operand : entry.operands()) operands.push_back(texts[operand]);
      const std::string name = entry.count == 1 && entry.operation->name == "-" ? "negate" : entry.operation->name;
      texts[node] = syntax.call(name, operands);
      if (uses[node] < 2 && texts[node].size() <= kMaxLength) continue;
      const std::string constant = "t" + std::to_string(result.definitions.size() + 1);
      result.definitions.push_back(syntax.define(constant, without_parentheses(texts[node])));
      texts[node] = constant;
    }
  }
  for (const Node root : roots) result.values.push_back(without_parentheses(texts[root]));
  return result;
}

}  // namespace

std::string shortest_number(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string with_replacements(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string without_parentheses(const std::string& expression) {
  return is_enclosed(expression) ? expression.substr(1, expression.size() - 2) : expression;
}

std::string elements_text(const std::vector<NamedUnit>& elements) {
  std::string text;
  for (const NamedUnit& each : elements)
    text +=
        (text.empty() ? "" : ", ") + each.name + (each.unit.empty() || each.unit == "1" ? "" : " [" + each.unit + "]");
  return text;
}

std::string body_of(const Module& module, const Function& function, const Syntax& syntax, const std::string& indent,
                    const std::function<std::string(const Output&, const std::string*)>& assign) {
  const Statements statements = statements_of(module, function, syntax);
  std::string text;
  for (const std::string& definition : statements.definitions) text += indent + definition + "\n";
  const std::string* values = statements.values.data();
  for (const Output& output : function.outputs) {
    text += assign(output, values);
    values += output.nodes.size();
  }
  return text;
}

}  // namespace pkm::code
