#include "engine/math/formula_reader.hpp"

#include <muParser.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "engine/math/formula_words.hpp"
#include "engine/math/portable.hpp"

namespace pkm::formula {
namespace {

int identify_number(const char* text, int* position, double* value) {
  const std::size_t length = read_number(text, *value);
  *position += static_cast<int>(length);
  return length > 0 ? 1 : 0;
}

// muParser would call these to evaluate, which it never does here: their addresses tell calls and signs apart.
double call_1(void*, double) { return 0; }
double call_2(void*, double, double) { return 0; }
double call_many(void*, const double*, int) { return 0; }
double minus(double x) { return -x; }
double plus(double x) { return x; }

/// muParser with our words only.
class Parser final : public mu::ParserBase {
 public:
  Parser() {
    AddValIdent(identify_number);
    InitCharSets();
    InitFun();
    InitConst();
    InitOprt();
    EnableOptimizer(false);  // each operation becomes a step, in the order in which it is written
  }

 private:
  void InitCharSets() override {
    DefineNameChars("0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    DefineOprtChars("+-*/^<>=!&|?:");
    DefineInfixOprtChars("+-");
  }
  void InitFun() override {
    for (const Function& function : functions()) {
      void* tag = const_cast<Function*>(&function);  // is handed on and comes back in the byte code
      if (function.arguments == 1) DefineFunUserData(function.name, call_1, tag);
      if (function.arguments == 2) DefineFunUserData(function.name, call_2, tag);
      if (function.arguments == 0) DefineFunUserData(function.name, call_many, tag);
    }
  }
  void InitConst() override { DefineConst(kPiName, kPi); }
  void InitOprt() override {
    DefineInfixOprt("-", minus);
    DefineInfixOprt("+", plus);
  }
};

/// muParser's complaint about words in the wrong order, as a sentence of ours.
std::string sentence_of(const mu::ParserError& error, const std::string& text) {
  const std::string token = error.GetToken();
  std::size_t place = error.GetPos() < 0 ? std::string::npos : static_cast<std::size_t>(error.GetPos());
  switch (error.GetCode()) {
    case mu::ecUNEXPECTED_EOF:
      return "ends where a number, a name or '(' is expected";
    case mu::ecMISSING_ELSE_CLAUSE:
      return "has a '?' without its ':'";
    case mu::ecMISPLACED_COLON:
      return "has a " + quote(":", text.rfind(':', place)) + " without its '?'";
    case mu::ecEXPRESSION_TOO_LONG:
      return "has more than " + std::to_string(mu::MaxLenExpression) + " characters";
    default:
      break;
  }
  // Some complaints tell the place behind the word.
  if (token.empty() || token == "-" || token == "+") --place;
  if (place >= text.size()) return "cannot be read: " + error.GetMsg();
  std::size_t end = place;
  while (end > 0 && is_blank(text[end - 1])) --end;
  const bool behind_operand = end > 0 && (is_name_part(text[end - 1]) || text[end - 1] == '.' || text[end - 1] == ')');
  return "has a " + quote(token.empty() ? text.substr(place, 1) : token, place) + ", where " +
         (behind_operand ? "an operator" : "a number, a name or '('") + " is expected";
}

Operation operation_of(mu::ECmdCode code) {
  switch (code) {
    case mu::cmLE:
      return Operation::less_or_equal;
    case mu::cmGE:
      return Operation::greater_or_equal;
    case mu::cmNEQ:
      return Operation::unequal;
    case mu::cmEQ:
      return Operation::equal;
    case mu::cmLT:
      return Operation::less;
    case mu::cmGT:
      return Operation::greater;
    case mu::cmADD:
      return Operation::add;
    case mu::cmSUB:
      return Operation::subtract;
    case mu::cmMUL:
      return Operation::multiply;
    case mu::cmDIV:
      return Operation::divide;
    case mu::cmPOW:
      return Operation::power;
    case mu::cmLAND:
      return Operation::both;
    case mu::cmLOR:
      return Operation::either;
    default:
      throw std::logic_error("muParser made a step of a formula that nobody knows");
  }
}

bool is_order(Operation operation) {
  return operation == Operation::less || operation == Operation::less_or_equal || operation == Operation::greater ||
         operation == Operation::greater_or_equal;
}

/// Makes one step of each word of muParser's byte code, so that its jumps keep their lengths, and follows what the
/// steps leave on the stack.
class Translation {
 public:
  Translation(const std::string& text, const double* slots) : text_(text), slots_(slots) {}

  Program run(const mu::ParserByteCode& code) {
    for (const mu::SToken* token = code.GetBase(); token->Cmd != mu::cmEND; ++token) add(*token);
    if (stack_.size() != 1) throw confusion();
    auto& used = program_.used;
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    return std::move(program_);
  }

 private:
  void add(const mu::SToken& token) {
    switch (token.Cmd) {
      case mu::cmVAL:
        return push({Operation::number, 0, token.Val.data2});
      case mu::cmVAR:
        program_.used.push_back(static_cast<std::size_t>(token.Val.ptr - slots_));
        return push({Operation::name, program_.used.back()});
      case mu::cmFUNC:
        if (const auto* function = static_cast<const Function*>(token.Fun.cb._pUserData))
          return call(function->operation, static_cast<std::size_t>(std::abs(token.Fun.argc)));
        if (token.Fun.cb._pRawFun == reinterpret_cast<mu::erased_fun_type>(minus)) return call(Operation::negate, 1);
        return step({Operation::nothing});
      case mu::cmIF:
        pop(1);
        branches_.push_back(stack_.size());
        return step({Operation::jump_if_zero, behind_jump(token)});
      case mu::cmELSE:
        pop(1);
        return step({Operation::jump, behind_jump(token)});
      case mu::cmENDIF:
        if (branches_.empty() || stack_.size() != branches_.back() + 1) throw confusion();
        branches_.pop_back();
        return step({Operation::nothing});
      default:
        return call(operation_of(token.Cmd), 2);
    }
  }

  std::size_t behind_jump(const mu::SToken& token) const {
    return program_.steps.size() + static_cast<std::size_t>(token.Oprt.offset) + 1;
  }
  void call(Operation operation, std::size_t count) {
    if (is_order(operation) && stack_.size() >= 2 && (is_order(stack_.back()) || is_order(stack_[stack_.size() - 2])))
      refuse(text_, "compares a comparison; write a < b && b < c for a < b < c");
    pop(count);
    push({operation, count});
  }
  void push(const Step& made) {
    stack_.push_back(made.operation);
    program_.depth = std::max(program_.depth, stack_.size());
    step(made);
  }
  void pop(std::size_t count) {
    if (stack_.size() < count) throw confusion();
    stack_.resize(stack_.size() - count);
  }
  void step(const Step& made) { program_.steps.push_back(made); }
  static std::logic_error confusion() { return std::logic_error("muParser made steps of a formula that do not fit"); }

  const std::string& text_;
  const double* slots_;
  Program program_;
  std::vector<Operation> stack_;       ///< what gave each number
  std::vector<std::size_t> branches_;  ///< depth of the stack before each open c ? x : y
};

}  // namespace

Program read_program(const std::string& text, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!may_be_name(names[i]) ||
        std::find(names.begin() + static_cast<std::ptrdiff_t>(i) + 1, names.end(), names[i]) != names.end())
      throw std::logic_error("a formula cannot know a number called '" + names[i] + "'");
  const std::string prepared = check_words(text, names);
  std::vector<double> slots(names.size());  // their addresses stand for the names
  Parser parser;
  for (std::size_t i = 0; i < names.size(); ++i) parser.DefineVar(names[i], &slots[i]);
  try {
    parser.SetExpr(prepared);
    parser.GetUsedVar();  // reads without evaluating
  } catch (const mu::ParserError& error) {
    refuse(text, sentence_of(error, prepared));
  }
  return Translation(text, slots.data()).run(parser.GetByteCode());
}

}  // namespace pkm::formula
