#include "engine/expression/formula_parser.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/expression/formula_lexer.hpp"

namespace pkm::expression {
namespace {

constexpr std::size_t kMaxCharacters = 20000;
constexpr const char* kMissingColon = "has a '?' without its ':'";

/// Whether an operator is one of < <= > >=.
bool compares(const Operation* operation) {
  return operation && (operation->name[0] == '<' || operation->name[0] == '>');
}

/// Dijkstra's shunting-yard algorithm: operands go to a value stack, and operators to a second stack, from which they
/// are applied as soon as an operator of the same or lower precedence follows; parentheses and conditionals c ? x : y
/// stay on it until they end. The parser is not recursive, so that deep nesting cannot overflow the call stack.
class Parser {
 public:
  Parser(Graph& graph, const std::string& text, std::span<const Node> names)
      : graph_(graph), text_(text), names_(names) {}

  Node run(const std::vector<Token>& tokens) {
    for (const Token& token : tokens) {
      const bool is_sign = wants_operand_ && (token.text == "+" || token.text == "-");
      if (is_sign && after_sign_) refuse_misplaced(token);
      push_token(token);
      after_sign_ = is_sign;
    }
    if (wants_operand_) refuse(text_, "ends where a number, a name or '(' is expected");
    finish_conditionals();
    if (!operators_.empty()) refuse(text_, kMissingColon);
    if (compares_comparison_) refuse(text_, "compares the result of a comparison; write a < b && b < c for a < b < c");
    return values_.front().node;
  }

 private:
  /// An element of the operator stack.
  struct Pending {
    enum class Kind { operation, parenthesis, question, colon };
    Kind kind;
    const Operation* operation = nullptr;  ///< parenthesis: the called function; null: it only groups
    std::size_t count = 0;                 ///< parenthesis: number of arguments so far
  };
  using Kind = Pending::Kind;
  struct Value {
    Node node;
    const Operation* from;  ///< operation that computed the value; null: a number or a variable
  };

  void push_token(const Token& token) {
    const char symbol = token.text[0];
    if (token.number || token.name || token.function || symbol == '(') {
      if (!wants_operand_) refuse_misplaced(token);
      if (token.number) push(graph_.number(*token.number), nullptr);
      if (token.name) push(names_[*token.name], nullptr);
      if (symbol == '(') operators_.push_back({Kind::parenthesis, called_, 1});
      called_ = token.function;
    } else if (wants_operand_) {
      if (symbol != '-' && symbol != '+') refuse_misplaced(token);
      if (symbol == '-') operators_.push_back({Kind::operation, &negation()});
    } else if (const Operation* operation = find_named(operators(), token.text)) {
      apply_operators(symbol == '^' ? operation->rank + 1 : operation->rank);
      operators_.push_back({Kind::operation, operation});
      wants_operand_ = true;
    } else if (symbol == '?') {
      apply_operators(0);
      operators_.push_back({Kind::question});
      wants_operand_ = true;
    } else {
      finish_conditionals();
      const bool in_question = !operators_.empty() && operators_.back().kind == Kind::question;
      if (symbol == ':' && !in_question) refuse(text_, "has a " + quote(":", token.position) + " without its '?'");
      if (symbol == ')' && in_question) refuse(text_, kMissingColon);
      if (symbol == ',' && in_question) refuse_misplaced(token);
      if (symbol == ')') return close();
      wants_operand_ = true;
      if (symbol == ',') {
        ++operators_.back().count;
      } else {
        operators_.back() = {Kind::colon};
      }
    }
  }

  void close() {
    const Pending open = operators_.back();
    operators_.pop_back();
    if (open.operation) call(open.operation, open.count);
  }

  /// Applies the operators on top of the stack whose precedence is at least `rank`.
  void apply_operators(int rank) {
    for (; !operators_.empty(); operators_.pop_back()) {
      const auto& [kind, operation, count] = operators_.back();
      if (kind != Kind::operation || operation->rank < rank) return;
      call(operation, operation->arguments);
    }
  }
  /// Applies all operators on top of the stack, and all conditionals that have both branches.
  void finish_conditionals() {
    for (apply_operators(0); !operators_.empty() && operators_.back().kind == Kind::colon; apply_operators(0)) {
      operators_.pop_back();
      call(&choice(), choice().arguments);
    }
  }

  void call(const Operation* operation, std::size_t count) {
    const auto arguments = values_.end() - static_cast<std::ptrdiff_t>(count);
    compares_comparison_ |= compares(operation) && std::any_of(arguments, values_.end(),
                                                               [](const Value& value) { return compares(value.from); });
    std::vector<Node> nodes;
    std::transform(arguments, values_.end(), std::back_inserter(nodes), [](const Value& value) { return value.node; });
    values_.erase(arguments, values_.end());
    push(graph_.apply(*operation, nodes), operation);
  }
  void push(Node node, const Operation* from) {
    values_.push_back({node, from});
    wants_operand_ = false;
  }

  [[noreturn]] void refuse_misplaced(const Token& token) const {
    refuse(text_, "has a " + quote(token.text, token.position) + ", where " +
                      (wants_operand_ ? "a number, a name or '('" : "an operator") + " is expected");
  }

  Graph& graph_;
  const std::string& text_;
  std::span<const Node> names_;
  std::vector<Pending> operators_;
  std::vector<Value> values_;
  const Operation* called_ = nullptr;  ///< the function whose name is the previous token
  bool wants_operand_ = true, after_sign_ = false, compares_comparison_ = false;
};

}  // namespace

Node read_formula(Graph& graph, const std::string& text, const Names& names, std::span<const Node> nodes) {
  const std::vector<Token> tokens = tokenize(text, names);
  if (text.size() >= kMaxCharacters) refuse(text, "has more than " + std::to_string(kMaxCharacters) + " characters");
  return Parser(graph, text, nodes).run(tokens);
}

}  // namespace pkm::expression
