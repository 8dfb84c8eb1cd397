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
/// are applied as soon as an operator of the same or lower precedence follows; parentheses, brackets and conditionals
/// c ? x : y stay on it until they end. The parser is not recursive, so that deep nesting cannot overflow the call
/// stack.
class Parser {
 public:
  Parser(Graph& graph, const std::string& text, const std::function<FormulaValue(std::size_t)>& value_of)
      : graph_(graph), text_(text), value_of_(value_of) {}

  ParsedFormula run(const std::vector<Token>& tokens) {
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
    return {values_.front().value, std::move(norms_)};
  }

 private:
  /// An element of the operator stack: an operator, a function call, or a parenthesis or bracket that is still open.
  struct Pending {
    enum class Kind { operation, parenthesis, bracket, question, colon };
    Kind kind;
    const Token* token;  ///< the operator, parenthesis or bracket; for a function call, the function's name
    const Operation* operation = nullptr;  ///< applied operation; null for a bracket or a grouping parenthesis
    std::size_t count = 0;                 ///< number of arguments or elements that have been read so far
  };
  using Kind = Pending::Kind;
  struct Operand {
    FormulaValue value;
    const Operation* from;  ///< operation that computed the value; null for a number, a variable or a vector
  };

  void push_token(const Token& token) {
    const char symbol = token.text[0];
    if (token.number || token.name || token.function || token.vector_function || symbol == '(' || symbol == '[') {
      if (!wants_operand_) refuse_misplaced(token);
      if (token.number) push(Term(graph_, *token.number));
      if (token.name) push(value_of_(*token.name));
      if (symbol == '(') operators_.push_back({Kind::parenthesis, called_, called_ ? called_->function : nullptr, 1});
      if (symbol == '[') operators_.push_back({Kind::bracket, &token, nullptr, 1});
      called_ = token.function || token.vector_function ? &token : nullptr;
    } else if (wants_operand_) {
      if (symbol != '-' && symbol != '+') refuse_misplaced(token);
      if (symbol == '-') operators_.push_back({Kind::operation, &token, &negation()});
    } else if (!token.part.empty()) {
      take_part(token);
    } else if (const Operation* operation = find_named(operators(), token.text)) {
      apply_operators(symbol == '^' ? operation->rank + 1 : operation->rank);
      operators_.push_back({Kind::operation, &token, operation});
      wants_operand_ = true;
    } else if (symbol == '?') {
      apply_operators(0);
      operators_.push_back({Kind::question, &token});
      wants_operand_ = true;
    } else {
      finish_conditionals();
      const bool in_question = !operators_.empty() && operators_.back().kind == Kind::question;
      if (symbol == ':' && !in_question) refuse(text_, "has a " + quote(":", token.position) + " without its '?'");
      if ((symbol == ')' || symbol == ']') && in_question) refuse(text_, kMissingColon);
      if (symbol == ',' && in_question) refuse_misplaced(token);
      if (symbol == ')' || symbol == ']') return close();
      wants_operand_ = true;
      if (symbol == ',') {
        ++operators_.back().count;
      } else {
        operators_.back() = {Kind::colon, operators_.back().token};
      }
    }
  }

  void close() {
    const Pending open = operators_.back();
    operators_.pop_back();
    if (open.kind == Kind::bracket) return make_vector(*open.token);
    if (open.operation) return call(open, open.count);
    if (open.token) call_vector_function(*open.token);
  }

  /// Applies the operators on top of the stack whose precedence is at least `rank`.
  void apply_operators(int rank) {
    for (; !operators_.empty(); operators_.pop_back()) {
      const Pending& top = operators_.back();
      if (top.kind != Kind::operation || top.operation->rank < rank) return;
      call(top, top.operation->arguments);
    }
  }
  /// Applies all operators on top of the stack, and all conditionals that have both branches.
  void finish_conditionals() {
    for (apply_operators(0); !operators_.empty() && operators_.back().kind == Kind::colon; apply_operators(0)) {
      Pending conditional = operators_.back();
      conditional.operation = &choice();
      operators_.pop_back();
      call(conditional, choice().arguments);
    }
  }

  /// Removes the last `count` operands from the value stack. @return these operands, in their order
  std::vector<Operand> take(std::size_t count) {
    const auto first = values_.end() - static_cast<std::ptrdiff_t>(count);
    std::vector<Operand> operands(first, values_.end());
    values_.erase(first, values_.end());
    return operands;
  }
  static std::vector<FormulaValue> values_of(const std::vector<Operand>& operands) {
    std::vector<FormulaValue> values;
    for (const Operand& operand : operands) values.push_back(operand.value);
    return values;
  }

  void call(const Pending& called, std::size_t count) {
    const Operation& operation = *called.operation;
    const std::vector<Operand> arguments = take(count);
    for (const Operand& argument : arguments) compares_comparison_ |= compares(&operation) && compares(argument.from);
    std::vector<Node> nodes;
    for (const Operand& argument : arguments)
      if (const Term* const term = std::get_if<Term>(&argument.value)) nodes.push_back(term->node());
    if (nodes.size() == count) return push(Term(graph_, graph_.apply(operation, nodes)), &operation);
    const std::vector<FormulaValue> values = values_of(arguments);
    if (const auto value =
            operation.rank > 0 || operation == choice() ? apply_to_vectors(operation, values) : std::nullopt)
      return push(*value, &operation);
    refuse_kinds(called, values);
  }

  void call_vector_function(const Token& token) {
    const VectorFunction& function = *token.vector_function;
    const std::vector<FormulaValue> values = values_of(take(function.arguments.size()));
    for (std::size_t i = 0; i < values.size(); ++i)
      if (kind_of(values[i]) != function.arguments[i])
        refuse(text_, "gives " + kind_of(values[i]) + " to " + quote(token.text, token.position) + ", whose argument " +
                          std::to_string(i + 1) + " is " + function.arguments[i]);
    push(function.apply(values));
    if (function.normed) norms_.push_back(length(function.normed(values)).node());
  }

  void make_vector(const Token& bracket) {
    std::vector<Term> elements;
    for (const Operand& operand : take(3)) {
      const Term* const term = std::get_if<Term>(&operand.value);
      if (!term)
        refuse(text_, "has " + kind_of(operand.value) + " as element " + std::to_string(elements.size() + 1) +
                          " of the vector " + quote("[", bracket.position) + "; expected scalars");
      elements.push_back(*term);
    }
    push(Vector3{elements[0], elements[1], elements[2]});
  }

  void take_part(const Token& token) {
    const FormulaValue whole = values_.back().value;
    const auto part = part_of(whole, token.part);
    if (!part)
      refuse(text_, "has a " + quote(token.text, token.position) + " after " + kind_of(whole) +
                        "; a vector has .x, .y and .z, a frame .origin and .R");
    values_.back() = {*part, nullptr};
  }

  void push(const FormulaValue& value, const Operation* from = nullptr) {
    values_.push_back({value, from});
    wants_operand_ = false;
  }

  /// Reports that an operation is not defined for arguments of these kinds (scalar, vector, rotation, frame).
  [[noreturn]] void refuse_kinds(const Pending& called, const std::vector<FormulaValue>& values) const {
    const std::string token = quote(called.token->text, called.token->position);
    if (called.operation->rank == 0 && !(*called.operation == choice())) {
      for (const FormulaValue& value : values)
        if (!std::holds_alternative<Term>(value))
          refuse(text_, "gives " + kind_of(value) + " to " + token + ", which takes scalars");
    }
    if (values.size() == 1) refuse(text_, "has a " + token + " before " + kind_of(values[0]));
    const std::size_t last = values.size() - 1;
    refuse(text_, "has a " + token + " between " + kind_of(values[last - 1]) + " and " + kind_of(values[last]));
  }

  [[noreturn]] void refuse_misplaced(const Token& token) const {
    refuse(text_, "has a " + quote(token.text, token.position) + ", where " +
                      (wants_operand_ ? "a number, a name or '('" : "an operator") + " is expected");
  }

  Graph& graph_;
  const std::string& text_;
  const std::function<FormulaValue(std::size_t)>& value_of_;
  std::vector<Pending> operators_;
  std::vector<Operand> values_;
  std::vector<Node> norms_;
  const Token* called_ = nullptr;  ///< the previous token, if it is the name of a function
  bool wants_operand_ = true, after_sign_ = false, compares_comparison_ = false;
};

}  // namespace

ParsedFormula parse_formula(Graph& graph, const std::string& text, const Names& names,
                            const std::function<FormulaValue(std::size_t)>& value_of) {
  const std::vector<Token> tokens = tokenize(text, names);
  if (text.size() >= kMaxCharacters) refuse(text, "has more than " + std::to_string(kMaxCharacters) + " characters");
  return Parser(graph, text, value_of).run(tokens);
}

Node read_formula(Graph& graph, const std::string& text, const Names& names, std::span<const Node> nodes) {
  const FormulaValue value =
      parse_formula(graph, text, names, [&](std::size_t i) { return Term(graph, nodes[i]); }).value;
  if (const Term* const term = std::get_if<Term>(&value)) return term->node();
  refuse(text, "is " + kind_of(value) + "; expected a scalar");
}

}  // namespace pkm::expression
