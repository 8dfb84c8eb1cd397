#include "engine/core/options.hpp"

#include <array>
#include <charconv>

namespace pkm {

Options default_options(const std::vector<OptionSpec>& specs) {
  Options options;
  for (const auto& spec : specs)
    if (spec.initial) options.set(spec.name, *spec.initial);
  return options;
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

namespace {

std::string quoted(const std::string& word) {
  std::string text = "\"";
  for (const char c : word) {
    if (c == '\n')
      text += "\\n";
    else if (c == '\t')
      text += "\\t";
    else
      text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  }
  return text + '"';
}

}  // namespace

std::string to_text(const OptionValue& value) {
  struct Writer {
    std::string operator()(double number) const { return shortest(number); }
    std::string operator()(std::int64_t number) const { return std::to_string(number); }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(const std::string& word) const { return quoted(word); }
    std::string operator()(const NamedNumbers& numbers) const {
      std::string text;
      for (const auto& [name, number] : numbers) text += (text.empty() ? " " : ", ") + name + " = " + shortest(number);
      return "{" + text + " }";
    }
    std::string operator()(const std::vector<NamedNumbers>& list) const {
      std::string text;
      for (const auto& numbers : list) text += (text.empty() ? "" : ", ") + (*this)(numbers);
      return "[" + text + "]";
    }
    std::string operator()(const NamedSettings& settings) const {
      std::string text;
      for (const auto& [name, setting] : settings)
        text += (text.empty() ? " " : ", ") + name + " = " + std::visit(*this, setting);
      return "{" + text + " }";
    }
  };
  return std::visit(Writer{}, value);
}

}  // namespace pkm
