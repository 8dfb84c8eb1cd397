#include "engine/graph/formula_words.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "engine/core/catalogue.hpp"

namespace pkm::graph {
namespace {

constexpr const char* kPiName = "pi";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_start(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name_part(char c) { return is_name_start(c) || is_digit(c); }

/// "; known are a, b; did you mean 'a'?"
std::string known_words(const std::string& word, const std::vector<std::string>& known) {
  return "; known are " + join(known) + did_you_mean(word, known);
}

class WordCheck {
 public:
  WordCheck(const std::string& text, const Names& names) : text_(text), names_(names) {}

  std::vector<Word> run() {
    for (std::size_t i = 0; i < text_.size();)
      if (is_blank(text_[i])) {
        ++i;
      } else {
        words_.push_back(word_at(i));
        i += words_.back().text.size();
      }
    if (words_.empty()) refuse(text_, "is empty");
    if (!open_.empty()) refuse(text_, "never closes the " + quote("(", words_[open_.back().word].place));
    return std::move(words_);
  }

 private:
  struct Parenthesis {
    std::size_t word;
    bool calls;  ///< the word before it; else it only groups
    std::size_t commas = 0;
  };

  Word word_at(std::size_t i) {
    const std::string_view rest = std::string_view(text_).substr(i);
    if (is_digit(rest[0]) || (rest[0] == '.' && rest.size() > 1 && is_digit(rest[1]))) return number_at(i);
    if (is_name_start(rest[0])) return name_at(i);
    std::size_t length = 1;
    for (const char* pair : {"<=", ">=", "==", "!=", "&&", "||"})
      if (rest.starts_with(pair)) length = 2;
    if (length == 2) return {.text = text_.substr(i, length), .place = i};
    if (rest[0] == '(') {
      open_.push_back({words_.size(), !words_.empty() && words_.back().function});
    } else if (rest[0] == ')') {
      close(i);
    } else if (rest[0] == ',') {
      if (open_.empty()) refuse(text_, "has a " + quote(",", i) + ", but a formula gives one number");
      if (!open_.back().calls) refuse(text_, "has a " + quote(",", i) + " outside of a function's arguments");
      ++open_.back().commas;
    } else if (rest[0] == '=') {
      refuse(text_, "has a " + quote("=", i) + ", but a formula changes nothing; compare with '=='");
    } else if (std::string_view("+-*/^<>?:").find(rest[0]) == std::string_view::npos) {
      // the further bytes of a character in UTF-8 go with the first
      while (length < rest.size() && (static_cast<unsigned char>(rest[length]) & 0xC0U) == 0x80U) ++length;
      refuse(text_, "has a " + quote(rest.substr(0, length), i) + ", which means nothing in a formula");
    }
    return {.text = text_.substr(i, 1), .place = i};
  }

  /// Does not depend on the locale.
  Word number_at(std::size_t i) const {
    double number = 0;
    const auto [end, error] = std::from_chars(text_.data() + i, text_.data() + text_.size(), number);
    const std::string word(text_.data() + i, end);
    if (error != std::errc{}) refuse(text_, "has a number out of range, " + quote(word, i));
    return {.text = word, .place = i, .number = number};
  }

  Word name_at(std::size_t i) const {
    const auto begin = text_.begin() + static_cast<std::ptrdiff_t>(i);
    const auto end = std::find_if_not(begin, text_.end(), is_name_part);
    const auto next = std::find_if_not(end, text_.end(), is_blank);
    const bool calls = next != text_.end() && *next == '(';

    const std::string word(begin, end);
    const Operation* function = find_named(functions(), word);
    const auto position = names_.find(word);
    const bool known = position || word == kPiName;
    if (calls && known) refuse(text_, "calls " + quote(word, i) + ", which is no function; multiply with '*'");
    if (calls && !function)
      refuse(text_, "calls the unknown function " + quote(word, i) + known_words(word, names_of(functions())));
    if (!calls && function) refuse(text_, "lacks the arguments of " + quote(word, i) + ", in parentheses");
    if (!calls && !known) {
      std::vector<std::string> names = names_.all();
      names.emplace_back(kPiName);
      refuse(text_, "has the unknown name " + quote(word, i) + known_words(word, names));
    }
    if (calls) return {.text = word, .place = i, .function = function};
    if (word == kPiName) return {.text = word, .place = i, .number = kPi};
    return {.text = word, .place = i, .name = position};
  }

  void close(std::size_t i) {
    if (open_.empty()) refuse(text_, "has a " + quote(")", i) + " without its '('");
    const auto [word, calls, commas] = open_.back();
    open_.pop_back();
    if (!calls) return;
    const Word& call = words_[word - 1];
    const std::size_t given = word + 1 == words_.size() ? 0 : commas + 1, wanted = call.function->arguments;
    if (wanted == 0 ? given >= 2 : given == wanted) return;
    refuse(text_, "gives " + std::to_string(given) + (given == 1 ? " argument" : " arguments") + " to " +
                      quote(call.text, call.place) + ", which takes " +
                      (wanted == 0 ? "two or more" : std::to_string(wanted)));
  }

  const std::string& text_;
  const Names& names_;
  std::vector<Word> words_;
  std::vector<Parenthesis> open_;
};

}  // namespace

bool may_be_name(const std::string& name) {
  return !name.empty() && is_name_start(name[0]) && std::ranges::all_of(name, is_name_part) && name != kPiName &&
         !find_named(functions(), name);
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

std::vector<Word> words_of(const std::string& text, const Names& names) { return WordCheck(text, names).run(); }

}  // namespace pkm::graph
