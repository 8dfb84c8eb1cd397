#include "engine/config/motion_formulas.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/expression/formula_lexer.hpp"

namespace pkm {
namespace {

const std::string kTime = "t";

/// Whether text is a formula rather than a number with a unit: it does not begin with a number, or an operator follows
/// the number.
bool is_formula_text(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return true;
  while (*end == ' ') ++end;
  return *end != '\0' && std::string("+-*/^(").find(*end) != std::string::npos;
}

/// Whether the value of a key of a motion is a word.
bool is_word(const std::string& key) { return key == "name" || key == "type" || key == "law" || key == "cycle"; }

}  // namespace

MotionFormulas::MotionFormulas(const ConfigValue& table, const std::vector<Parameter>& parameters,
                               const std::vector<std::string>& inputs)
    : table_(table.toml()) {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (expression::may_be_name(parameters[i].name) && parameters[i].name != kTime) {
      names_.push_back(parameters[i].name);
      numbers_.push_back(i);
    }
  if (!table.is_table()) return;
  const ConfigValue plain(table.toml(), table.place().file, table.place().key);
  const TomlValue* const type = table.toml().find("type");
  const bool of_time = type && type->kind == TomlValue::Kind::text && type->text == "formulas";
  for (std::size_t k = 0; k < plain.keys().size(); ++k) {
    const std::string& key = plain.keys()[k];
    if (!is_word(key)) find(*plain.find(key), {k}, (of_time && key != "duration") || contains(inputs, key));
  }
  std::ranges::sort(used_);
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
}

void MotionFormulas::find(const ConfigValue& value, const std::vector<std::size_t>& path, bool may_use_time) {
  const auto below = [&path](std::size_t k) {
    std::vector<std::size_t> longer = path;
    longer.push_back(k);
    return longer;
  };
  if (value.is_text()) return add(value, path, may_use_time);
  if (value.is_list())
    for (std::size_t k = 0; const ConfigValue& element : value.elements("a list")) find(element, below(k++), false);
  if (value.is_table())
    for (std::size_t k = 0; k < value.keys().size(); ++k) find(*value.find(value.keys()[k]), below(k), false);
}

void MotionFormulas::add(const ConfigValue& value, const std::vector<std::size_t>& path, bool may_use_time) {
  const std::string& text = value.text("a number, text with a unit, or a formula of parameters");
  if (!is_formula_text(text)) return;
  std::vector<std::string> names = names_;
  if (may_use_time) names.push_back(kTime);
  const Formula formula = value.explained([&] { return Formula(text, names); });
  bool depends_on_time = false, depends_on_parameters = false;
  for (const std::size_t i : formula.used()) {
    depends_on_time = depends_on_time || i == names_.size();
    if (i == names_.size()) continue;
    depends_on_parameters = true;
    used_.push_back(numbers_[i]);
  }
  if (depends_on_time && !depends_on_parameters) return;
  places_.push_back({path, text, depends_on_time ? std::nullopt : std::optional(formula)});
}

std::string MotionFormulas::formula_of_time(const std::string& text, std::span<const double> parameters) const {
  std::vector<std::string> names = names_;
  names.push_back(kTime);
  std::string formula;
  std::size_t end = 0;
  for (const expression::Token& token : expression::tokenize(text, names)) {
    if (!token.name || *token.name == names_.size()) continue;
    formula += text.substr(end, token.position - end) + "(" + shortest(parameters[numbers_[*token.name]]) + ")";
    end = token.position + token.text.size();
  }
  return formula + text.substr(end);
}

TomlValue MotionFormulas::table_of(std::span<const double> parameters) const {
  std::vector<double> values;
  for (const std::size_t i : numbers_) values.push_back(parameters[i]);
  TomlValue table = table_;
  for (const Place& place : places_) {
    TomlValue* at = &table;
    for (const std::size_t k : place.path) at = &at->items[k];
    if (place.value) {
      at->kind = TomlValue::Kind::number;
      at->number = place.value->value(std::span<const double>(values));
      at->written += " = " + shortest(at->number);
    } else {
      at->text = formula_of_time(place.text, parameters);
    }
  }
  return table;
}

}  // namespace pkm
