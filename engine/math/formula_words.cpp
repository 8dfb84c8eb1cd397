#include "engine/math/formula_words.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"

namespace pkm::formula {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_start(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// "; known are a, b; did you mean 'a'?"
std::string known_words(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(word, known);
  return "; known are " + join(known) + (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
}

class WordCheck {
 public:
  WordCheck(const std::string& text, const std::vector<std::string>& names)
      : text_(text), prepared_(text), known_(names) {
    known_.emplace_back(kPiName);
  }

  std::string run() {
    for (std::size_t i = 0; i < text_.size(); ++i) {
      if (is_blank(text_[i])) continue;
      const std::size_t start = i;
      i += word_at(start) - 1;
      previous_ = start;
    }
    if (previous_ == text_.size()) refuse(text_, "is empty");
    if (!open_.empty()) refuse(text_, "never closes the " + quote("(", open_.back().place));
    return std::move(prepared_);
  }

 private:
  struct Call {
    const Function* function = nullptr;
    std::size_t place = 0;
  };
  struct Parenthesis {
    std::size_t place;
    Call call;  ///< no function: it only groups
    std::size_t commas = 0;
  };

  /// Checks the word that begins at `i`; its length.
  std::size_t word_at(std::size_t i) {
    const std::string_view rest = std::string_view(text_).substr(i);
    double number = 0;
    if (const std::size_t length = read_number(rest, number)) {
      if (number != number) refuse(text_, "has a number out of range, " + quote(rest.substr(0, length), i));
      return length;
    }
    if (is_name_start(rest[0])) return name_at(i);
    for (const char* pair : {"<=", ">=", "==", "!=", "&&", "||"})
      if (rest.starts_with(pair)) return 2;
    if (rest[0] == '(') {
      open_.push_back({i, call_});
      call_ = {};
    } else if (rest[0] == ')') {
      close(i);
    } else if (rest[0] == ',') {
      if (open_.empty()) refuse(text_, "has a " + quote(",", i) + ", but a formula gives one number");
      if (!open_.back().call.function) refuse(text_, "has a " + quote(",", i) + " outside of a function's arguments");
      ++open_.back().commas;
    } else if (rest[0] == '=') {
      refuse(text_, "has a " + quote("=", i) + ", but a formula changes nothing; compare with '=='");
    } else if (std::string_view("+-*/^<>?:").find(rest[0]) == std::string_view::npos) {
      std::size_t length = 1;  // the further bytes of a character in UTF-8 go with the first
      while (length < rest.size() && (static_cast<unsigned char>(rest[length]) & 0xC0U) == 0x80U) ++length;
      refuse(text_, "has a " + quote(rest.substr(0, length), i) + ", which means nothing in a formula");
    }
    return 1;
  }

  std::size_t name_at(std::size_t i) {
    std::size_t end = i;
    while (end < text_.size() && is_name_part(text_[end])) ++end;
    std::size_t next = end;
    while (next < text_.size() && is_blank(text_[next])) ++next;
    const bool calls = next < text_.size() && text_[next] == '(';

    const std::string word = text_.substr(i, end - i);
    const Function* function = find_named(functions(), word);
    const bool known = std::ranges::find(known_, word) != known_.end();
    if (calls && known) refuse(text_, "calls " + quote(word, i) + ", which is no function; multiply with '*'");
    if (calls && !function)
      refuse(text_, "calls the unknown function " + quote(word, i) + known_words(word, names_of(functions())));
    if (!calls && function) refuse(text_, "lacks the arguments of " + quote(word, i) + ", in parentheses");
    if (!calls && !known) refuse(text_, "has the unknown name " + quote(word, i) + known_words(word, known_));
    if (calls) {
      call_ = {function, i};
      const auto begin = prepared_.begin();
      std::rotate(begin + static_cast<std::ptrdiff_t>(i), begin + static_cast<std::ptrdiff_t>(end),
                  begin + static_cast<std::ptrdiff_t>(next));
    }
    return end - i;
  }

  void close(std::size_t i) {
    if (open_.empty()) refuse(text_, "has a " + quote(")", i) + " without its '('");
    const auto [place, call, commas] = open_.back();
    open_.pop_back();
    if (!call.function) return;
    const std::size_t given = previous_ == place ? 0 : commas + 1, wanted = call.function->arguments;
    if (wanted == 0 ? given >= 2 : given == wanted) return;
    refuse(text_, "gives " + std::to_string(given) + (given == 1 ? " argument" : " arguments") + " to " +
                      quote(call.function->name, call.place) + ", which takes " +
                      (wanted == 0 ? "two or more" : std::to_string(wanted)));
  }

  const std::string& text_;
  std::string prepared_;
  std::vector<std::string> known_;
  std::vector<Parenthesis> open_;
  Call call_;                            ///< of the name just read
  std::size_t previous_ = text_.size();  ///< where the word before began
};

}  // namespace

const std::vector<Function>& functions() {
  static const std::vector<Function> list = {
      {"sin", 1, Operation::sine},
      {"cos", 1, Operation::cosine},
      {"tan", 1, Operation::tangent},
      {"asin", 1, Operation::arcsine},
      {"acos", 1, Operation::arccosine},
      {"atan", 1, Operation::arctangent},
      {"atan2", 2, Operation::arctangent_2},
      {"sinh", 1, Operation::hyperbolic_sine},
      {"cosh", 1, Operation::hyperbolic_cosine},
      {"tanh", 1, Operation::hyperbolic_tangent},
      {"exp", 1, Operation::exponential},
      {"log", 1, Operation::logarithm},
      {"log10", 1, Operation::logarithm_10},
      {"sqrt", 1, Operation::root},
      {"abs", 1, Operation::magnitude},
      {"sign", 1, Operation::sign},
      {"min", 0, Operation::least},
      {"max", 0, Operation::greatest},
  };
  return list;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_name_part(char c) { return is_name_start(c) || is_digit(c); }

bool may_be_name(const std::string& name) {
  return !name.empty() && is_name_start(name[0]) && std::ranges::all_of(name, is_name_part) && name != kPiName &&
         !find_named(functions(), name);
}

std::size_t read_number(std::string_view text, double& value) {
  const std::size_t first = text.starts_with('.') ? 1 : 0;
  if (text.size() <= first || !is_digit(text[first])) return 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) value = std::numeric_limits<double>::quiet_NaN();
  return static_cast<std::size_t>(end - text.data());
}

void refuse(const std::string& text, const std::string& sentence) {
  constexpr std::size_t kShown = 60;
  std::string shown = text.size() > kShown ? text.substr(0, kShown - 3) + "..." : text;
  std::ranges::replace_if(shown, is_blank, ' ');
  throw std::invalid_argument("the formula \"" + shown + "\" " + sentence);
}

std::string quote(std::string_view word, std::size_t place) {
  return "'" + std::string(word) + "' at character " + std::to_string(place + 1);
}

std::string check_words(const std::string& text, const std::vector<std::string>& names) {
  return WordCheck(text, names).run();
}

}  // namespace pkm::formula
