// Value of a Python function of the parameters of a design.
#include <algorithm>
#include <cctype>

#include "engine/problem/expression.hpp"
#include "engine/problem/external_functions.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

bool is_python_name(const std::string& text) {
  const auto is_letter = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.'; };
  return !text.empty() && !std::isdigit(static_cast<unsigned char>(text[0])) && std::ranges::all_of(text, is_letter);
}

/// The option `call`: "FILE.py:FUNCTION", or the name of a function that the program running the study provides. Throws
/// std::invalid_argument if it has neither form.
const std::string& call_of(const EntryContext& context) {
  const std::string& call = context.options.word("call");
  const std::size_t colon = call.rfind(':');
  const std::string function = colon == std::string::npos ? call : call.substr(colon + 1);
  const std::string file = colon == std::string::npos ? "" : call.substr(0, colon);
  if (!is_python_name(function) || (colon != std::string::npos && (!file.ends_with(".py") || file.size() < 4)))
    throw std::invalid_argument("call = \"" + call + "\" names no function; expected \"FILE.py:FUNCTION\"");
  return call;
}

}  // namespace

ObjectiveEntry python_objective() {
  return {
      .name = "python",
      .meaning = "the value of a Python function of the parameters",
      .direction = Direction::minimise,
      .options = {{.name = "call",
                   .kind = OptionKind::word,
                   .required = true,
                   .meaning = "the function, as \"FILE.py:FUNCTION\", relative to the study; it gets a dict of all "
                              "parameters in SI units and returns a number"},
                  {.name = "unit",
                   .kind = OptionKind::word,
                   .initial = std::string("1"),
                   .meaning = "SI unit of the value and of its bounds"}},
      .unit = expression_unit,
      .make = [](const EntryContext& context) { return std::make_unique<ExternalQuantity>(call_of(context)); },
      .detail = [](const EntryContext& context) { return "value of " + call_of(context); },
      .uses_workspace = false,
  };
}

}  // namespace pkm
