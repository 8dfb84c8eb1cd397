#include "engine/graph/formula_reader.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/graph/formula_words.hpp"

namespace pkm::graph {
namespace {

constexpr std::size_t kMostCharacters = 20000;
constexpr const char* kNoColon = "has a '?' without its ':'";

bool is_order(const Operation* operation) {
  return operation && (operation->name[0] == '<' || operation->name[0] == '>');
}

/// Dijkstra's shunting yard: operators wait until one comes that binds no more than they do, parentheses and choices
/// c ? x : y until they end. Nothing recurses, so that no depth is too much.
class Reader {
 public:
  Reader(Graph& graph, const std::string& text, std::span<const Node> names)
      : graph_(graph), text_(text), names_(names) {}

  Node run(const std::vector<Word>& words) {
    for (const Word& word : words) {
      const bool is_sign = wants_operand_ && (word.text == "+" || word.text == "-");
      if (is_sign && after_sign_) misplaced(word);
      take(word);
      after_sign_ = is_sign;
    }
    if (wants_operand_) refuse(text_, "ends where a number, a name or '(' is expected");
    end_choices();
    if (!waiting_.empty()) refuse(text_, kNoColon);
    if (compares_comparison_) refuse(text_, "compares a comparison; write a < b && b < c for a < b < c");
    return stack_.front().node;
  }

 private:
  struct Waiting {
    enum class Kind { operation, parenthesis, question, colon };
    Kind kind;
    const Operation* operation = nullptr;  ///< also the function of a parenthesis; null: it only groups
    std::size_t count = 0;                 ///< arguments so far
  };
  using Kind = Waiting::Kind;
  struct Value {
    Node node;
    const Operation* from;  ///< null: a number or a name
  };

  void take(const Word& word) {
    const char mark = word.text[0];
    if (word.number || word.name || word.function || mark == '(') {
      if (!wants_operand_) misplaced(word);
      if (word.number) push(graph_.number(*word.number), nullptr);
      if (word.name) push(names_[*word.name], nullptr);
      if (mark == '(') waiting_.push_back({Kind::parenthesis, called_, 1});
      called_ = word.function;
    } else if (wants_operand_) {
      if (mark != '-' && mark != '+') misplaced(word);
      if (mark == '-') waiting_.push_back({Kind::operation, &negation()});
    } else if (const Operation* operation = find_named(operators(), word.text)) {
      finish(mark == '^' ? operation->rank + 1 : operation->rank);
      waiting_.push_back({Kind::operation, operation});
      wants_operand_ = true;
    } else if (mark == '?') {
      finish(0);
      waiting_.push_back({Kind::question});
      wants_operand_ = true;
    } else {
      end_choices();
      const bool in_question = !waiting_.empty() && waiting_.back().kind == Kind::question;
      if (mark == ':' && !in_question) refuse(text_, "has a " + quote(":", word.place) + " without its '?'");
      if (mark == ')' && in_question) refuse(text_, kNoColon);
      if (mark == ',' && in_question) misplaced(word);
      if (mark == ')') return close();
      wants_operand_ = true;
      if (mark == ',') {
        ++waiting_.back().count;
      } else {
        waiting_.back() = {Kind::colon};
      }
    }
  }

  void close() {
    const Waiting open = waiting_.back();
    waiting_.pop_back();
    if (open.operation) call(open.operation, open.count);
  }

  /// Carries out what waits on top and binds at least as much as `rank`.
  void finish(int rank) {
    for (; !waiting_.empty(); waiting_.pop_back()) {
      const auto& [kind, operation, count] = waiting_.back();
      if (kind != Kind::operation || operation->rank < rank) return;
      call(operation, operation->arguments);
    }
  }
  /// And the choices of which both branches are there.
  void end_choices() {
    for (finish(0); !waiting_.empty() && waiting_.back().kind == Kind::colon; finish(0)) {
      waiting_.pop_back();
      call(&choice(), choice().arguments);
    }
  }

  void call(const Operation* operation, std::size_t count) {
    const auto arguments = stack_.end() - static_cast<std::ptrdiff_t>(count);
    compares_comparison_ |= is_order(operation) && std::any_of(arguments, stack_.end(),
                                                               [](const Value& value) { return is_order(value.from); });
    std::vector<Node> nodes;
    std::transform(arguments, stack_.end(), std::back_inserter(nodes), [](const Value& value) { return value.node; });
    stack_.erase(arguments, stack_.end());
    push(graph_.apply(*operation, nodes), operation);
  }
  void push(Node node, const Operation* from) {
    stack_.push_back({node, from});
    wants_operand_ = false;
  }

  [[noreturn]] void misplaced(const Word& word) const {
    refuse(text_, "has a " + quote(word.text, word.place) + ", where " +
                      (wants_operand_ ? "a number, a name or '('" : "an operator") + " is expected");
  }

  Graph& graph_;
  const std::string& text_;
  std::span<const Node> names_;
  std::vector<Waiting> waiting_;
  std::vector<Value> stack_;
  const Operation* called_ = nullptr;  ///< by the name just read
  bool wants_operand_ = true, after_sign_ = false, compares_comparison_ = false;
};

}  // namespace

Node read_formula(Graph& graph, const std::string& text, const Names& names, std::span<const Node> nodes) {
  const std::vector<Word> words = words_of(text, names);
  if (text.size() >= kMostCharacters) refuse(text, "has more than " + std::to_string(kMostCharacters) + " characters");
  return Reader(graph, text, nodes).run(words);
}

}  // namespace pkm::graph
