#include "engine/expression/formula_lexer.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "engine/core/catalogue.hpp"

namespace pkm::expression {
namespace {

constexpr const char* kPiName = "pi";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_start(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name_part(char c) { return is_name_start(c) || is_digit(c); }
/// True if `name` is that of a part of a vector (x, y, z) or of a frame (origin, R); see part_of().
bool is_part(const std::string& name) {
  return name == "x" || name == "y" || name == "z" || name == "origin" || name == "R";
}

/// Second half of a message about an unknown name, for example: "; expected one of a, b; did you mean 'a'?"
std::string expected_names(const std::string& name, const std::vector<std::string>& known) {
  return "; expected one of " + join(known) + did_you_mean(name, known);
}

class Lexer {
 public:
  Lexer(const std::string& text, const Names& names) : text_(text), names_(names) {}

  std::vector<Token> run() {
    for (std::size_t i = 0; i < text_.size();)
      if (is_blank(text_[i])) {
        ++i;
      } else {
        tokens_.push_back(token_at(i));
        i += tokens_.back().text.size();
      }
    if (tokens_.empty()) refuse(text_, "is empty");
    if (!open_.empty()) {
      const Token& open = tokens_[open_.back().token];
      refuse(text_, "does not close the " + quote(open.text, open.position));
    }
    return std::move(tokens_);
  }

 private:
  /// A parenthesis or bracket that is not closed yet.
  struct Open {
    std::size_t token;  ///< index of the token
    bool is_list;       ///< true: the arguments of a function, or the elements of a vector; false: groups a term
    std::size_t commas = 0;
  };

  Token token_at(std::size_t i) {
    const std::string_view rest = std::string_view(text_).substr(i);
    if (is_digit(rest[0]) || (rest[0] == '.' && rest.size() > 1 && is_digit(rest[1]))) return number_at(i);
    if (is_name_start(rest[0])) return name_at(i);
    if (rest[0] == '.' && rest.size() > 1 && is_name_start(rest[1])) return part_at(i);
    std::size_t length = 1;
    for (const char* pair : {"<=", ">=", "==", "!=", "&&", "||"})
      if (rest.starts_with(pair)) length = 2;
    if (length == 2) return {.text = text_.substr(i, length), .position = i};
    if (rest[0] == '(') {
      open_.push_back(
          {tokens_.size(), !tokens_.empty() && (tokens_.back().function || tokens_.back().vector_function)});
    } else if (rest[0] == '[') {
      open_.push_back({tokens_.size(), true});
    } else if (rest[0] == ')' || rest[0] == ']') {
      close(i);
    } else if (rest[0] == ',') {
      if (open_.empty()) refuse(text_, "has a " + quote(",", i) + "; a formula has one value");
      if (!open_.back().is_list) refuse(text_, "has a " + quote(",", i) + " outside of a function's arguments");
      ++open_.back().commas;
    } else if (rest[0] == '=') {
      refuse(text_, "has a " + quote("=", i) + "; formulas have no assignment, compare with '=='");
    } else if (std::string_view("+-*/^<>?:").find(rest[0]) == std::string_view::npos) {
      // If the character is not ASCII, include all bytes of its UTF-8 encoding.
      while (length < rest.size() && (static_cast<unsigned char>(rest[length]) & 0xC0U) == 0x80U) ++length;
      refuse(text_, "has a " + quote(rest.substr(0, length), i) + ", which is not allowed in formulas");
    }
    return {.text = text_.substr(i, 1), .position = i};
  }

  /// The number that begins at character i. std::from_chars is used because it does not depend on the locale.
  Token number_at(std::size_t i) const {
    double number = 0;
    const auto [end, error] = std::from_chars(text_.data() + i, text_.data() + text_.size(), number);
    const std::string word(text_.data() + i, end);
    if (error != std::errc{}) refuse(text_, "has a number out of range: " + quote(word, i));
    return {.text = word, .position = i, .number = number};
  }

  /// The end of the name that begins at `begin`, without dots.
  std::string::const_iterator end_of_word(std::string::const_iterator begin) const {
    return std::find_if_not(begin, text_.end(), is_name_part);
  }

  Token part_at(std::size_t i) const {
    const auto begin = text_.begin() + static_cast<std::ptrdiff_t>(i);
    const std::string part(begin + 1, end_of_word(begin + 1));
    return {.text = "." + part, .position = i, .part = part};
  }

  Token name_at(std::size_t i) const {
    const auto begin = text_.begin() + static_cast<std::ptrdiff_t>(i);
    auto end = end_of_word(begin);
    const auto next = std::find_if_not(end, text_.end(), is_blank);
    const bool calls = next != text_.end() && *next == '(';

    std::string word(begin, end);
    const Operation* const function = find_named(functions(), word);
    const VectorFunction* const vector_function = calls ? find_named(vector_functions(), word) : nullptr;
    if (vector_function) return {.text = word, .position = i, .vector_function = vector_function};
    auto index = names_.find(word);
    const bool known = index || word == kPiName;
    if (calls && known) refuse(text_, "calls " + quote(word, i) + ", which is not a function; multiply with '*'");
    if (calls && !function) {
      std::vector<std::string> all = names_of(functions());
      for (const VectorFunction& each : vector_functions()) all.push_back(each.name);
      refuse(text_, "calls the unknown function " + quote(word, i) + expected_names(word, all));
    }
    if (calls) return {.text = word, .position = i, .function = function};
    if (function) refuse(text_, "has no arguments in parentheses after the function " + quote(word, i));
    // Choose the longest known name: arm1.C rather than arm1. A word after a further dot denotes a part of the
    // variable's value, such as x in arm1.C.x.
    while (end + 1 < text_.end() && *end == '.' && is_name_start(end[1])) {
      const auto longer = end_of_word(end + 1);
      const auto longer_index = names_.find({begin, longer});
      if (!longer_index && index && is_part(std::string(end + 1, longer))) break;
      end = longer;
      word.assign(begin, end);
      index = longer_index;
    }
    if (!index && word != kPiName) refuse_unknown(word, i);
    if (!index) return {.text = word, .position = i, .number = kPi};
    return {.text = word, .position = i, .name = index};
  }

  /// Reports an unknown name and lists the known names. For a name with a dot, "arm1.D", these are the names of the
  /// same object or, if there are none, all names with a dot.
  [[noreturn]] void refuse_unknown(const std::string& word, std::size_t i) const {
    const std::string message = "has the unknown name " + quote(word, i), object = word.substr(0, word.find('.'));
    const bool has_dot = object.size() < word.size();
    std::vector<std::string> plain, dotted, of_object;
    for (const std::string& name : names_.listed()) {
      (name.find('.') == std::string::npos ? plain : dotted).push_back(name);
      if (has_dot && name.starts_with(object + ".")) of_object.push_back(name);
    }
    plain.emplace_back(kPiName);
    if (!of_object.empty()) refuse(text_, message + expected_names(word, of_object));
    if (has_dot && names_.find(object)) {
      const std::vector<std::string> parts = {"x", "y", "z", "origin", "R"};
      refuse(text_, message + "; the parts of a vector are x, y and z, those of a frame origin and R" +
                        did_you_mean(word.substr(object.size() + 1), parts));
    }
    if (has_dot && !dotted.empty()) refuse(text_, message + expected_names(word, dotted));
    refuse(text_, message + expected_names(object, plain));
  }

  void close(std::size_t i) {
    const std::string with = text_.substr(i, 1), opened_by = with == ")" ? "(" : "[";
    if (open_.empty()) refuse(text_, "has a " + quote(with, i) + " without its '" + opened_by + "'");
    const auto [token, is_list, commas] = open_.back();
    const Token& open = tokens_[token];
    if (open.text != opened_by)
      refuse(text_, "closes the " + quote(open.text, open.position) + " by a " + quote(with, i));
    open_.pop_back();
    if (!is_list) return;
    const std::size_t given = token + 1 == tokens_.size() ? 0 : commas + 1;
    if (with == "]") {
      if (given != 3)
        refuse(text_, "has a vector of " + std::to_string(given) + (given == 1 ? " element" : " elements") + ", " +
                          quote("[", open.position) + "; expected three: [x, y, z]");
      return;
    }
    const Token& call = tokens_[token - 1];
    const std::size_t wanted = call.function ? call.function->arguments : call.vector_function->arguments.size();
    if (wanted == 0 ? given >= 2 : given == wanted) return;
    refuse(text_, "gives " + std::to_string(given) + (given == 1 ? " argument" : " arguments") + " to " +
                      quote(call.text, call.position) + ", which takes " +
                      (wanted == 0 ? "two or more" : std::to_string(wanted)));
  }

  const std::string& text_;
  const Names& names_;
  std::vector<Token> tokens_;
  std::vector<Open> open_;
};

}  // namespace

bool may_be_name(const std::string& name) {
  return !name.empty() && is_name_start(name[0]) && std::ranges::all_of(name, is_name_part) && name != kPiName &&
         !find_named(functions(), name);
}

void refuse(const std::string& text, const std::string& error) {
  constexpr std::size_t kMaxShown = 60;  // maximum length of the formula's text in the message, in characters
  std::string shown = text.size() > kMaxShown ? text.substr(0, kMaxShown - 3) + "..." : text;
  std::ranges::replace_if(shown, is_blank, ' ');
  throw std::invalid_argument("the formula \"" + shown + "\" " + error);
}

std::string quote(std::string_view token, std::size_t position) {
  return "'" + std::string(token) + "' at character " + std::to_string(position + 1);
}

std::vector<Token> tokenize(const std::string& text, const Names& names) { return Lexer(text, names).run(); }

}  // namespace pkm::expression
