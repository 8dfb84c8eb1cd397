#include "engine/core/options.hpp"

#include <array>
#include <charconv>

#include "engine/core/catalogue.hpp"

namespace pkm {

const OptionSpec* TableSpec::find(const std::string& name) const {
  const OptionSpec* found = find_named(keys, name);
  for (const TableVariant& variant : variants)
    if (!found) found = find_named(variant.keys, name);
  return found;
}

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
    if (std::string_view("\"\\\n\t").find(c) != std::string_view::npos) text += '\\';
    text += c == '\n' ? 'n' : c == '\t' ? 't' : c;
  }
  return text + '"';
}

struct TomlWriter {
  std::string operator()(double number) const { return shortest(number); }
  std::string operator()(std::int64_t number) const { return std::to_string(number); }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(const std::string& word) const { return quoted(word); }
  std::string operator()(const std::vector<NamedNumbers>& list) const { return "[" + join_texts(list, *this) + "]"; }
  std::string operator()(const Setting& setting) const { return std::visit(*this, setting); }
  template <class Value>
  std::string operator()(const std::map<std::string, Value>& table) const {
    const auto entry = [this](const auto& named) { return named.first + " = " + (*this)(named.second); };
    return "{ " + join_texts(table, entry) + (table.empty() ? "}" : " }");
  }
};

}  // namespace

std::string to_text(const OptionValue& value) { return std::visit(TomlWriter{}, value); }

}  // namespace pkm
