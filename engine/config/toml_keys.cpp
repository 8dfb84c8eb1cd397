#include "engine/config/toml_keys.hpp"

#include <algorithm>

namespace pkm {
namespace {

using Path = std::vector<std::string>;

class KeyScanner {
 public:
  explicit KeyScanner(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  std::vector<TomlKey> scan() {
    for (skip_blank(true); at_ < text_.size(); skip_blank(true)) {
      if (text_[at_] == '[') {
        read_header();
      } else {
        const Path path = read_key(table_);
        if (peek() == '=') ++at_;
        read_value(path);
      }
    }
    return std::move(keys_);
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  /// Skips blanks and, if several lines are allowed, line ends and comments.
  void skip_blank(bool lines) {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == ' ' || c == '\t' || c == '\r') continue;
      if (!lines || (c != '\n' && c != '#')) return;
      if (c == '#')
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
      else
        ++line_;
    }
  }

  void read_header() {
    while (peek() == '[') ++at_;
    table_ = read_key({});
    while (peek() == ']') ++at_;
  }

  /// Reads a dotted key within the table `path`, and the blanks after it. Consumes at least one character.
  Path read_key(Path path) {
    for (;;) {
      skip_blank(false);
      const char quote = peek();
      std::size_t begin = at_, end = at_;
      if (quote == '"' || quote == '\'') {
        begin = at_ + 1;
        skip_string();
        end = std::max(begin, at_ - 1);
      } else {
        constexpr std::string_view kEndsKey = " \t\r\n.=[]{},#\"'";
        at_ = end = std::min(text_.find_first_of(kEndsKey, at_), text_.size());
        if (begin == end && peek() != '.') ++at_;
      }
      path.emplace_back(text_.substr(begin, end - begin));
      keys_.push_back({path, begin, end - begin, line_});
      skip_blank(false);
      if (peek() != '.') return path;
      ++at_;
    }
  }

  /// Skips a string and its closing quotes. A single-line string ends at the end of the line at the latest.
  void skip_string() {
    const char quote = text_[at_];
    const std::string three(3, quote);
    const bool multi_line = text_.substr(at_).starts_with(three);
    at_ += multi_line ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        if (!multi_line) return;
        ++line_;
      } else if (c == '\\' && quote == '"' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n') {
        ++at_;
      } else if (!multi_line && c == quote) {
        ++at_;
        return;
      } else if (multi_line && text_.substr(at_).starts_with(three)) {
        at_ += 3;
        // In a multi-line string, up to two quotes that belong to the text may precede the closing quotes.
        for (int quotes = 0; quotes < 2 && peek() == quote; ++quotes) ++at_;
        return;
      }
    }
  }

  /// Skips the value of the key `path`, and reads the keys of the inline tables in it.
  void read_value(Path path) {
    struct Open {
      bool is_table;
      Path path;
    };
    std::vector<Open> open;  // inline tables and arrays that contain the current position, outermost first
    for (bool at_key = false;;) {
      skip_blank(!open.empty());
      if (at_ >= text_.size()) return;
      const char c = text_[at_];
      if (at_key && c != '}' && c != ',') {
        path = read_key(open.back().path);
        if (peek() == '=') ++at_;
        at_key = false;
        continue;
      }
      if (c == '"' || c == '\'') {
        skip_string();
      } else if (c == '{' || c == '[') {
        open.push_back({c == '{', path});
        at_key = c == '{';
        ++at_;
      } else if (!open.empty() && (c == '}' || c == ']')) {
        path = open.back().path;
        open.pop_back();
        at_key = false;
        ++at_;
      } else if (!open.empty() && c == ',') {
        path = open.back().path;
        at_key = open.back().is_table;
        ++at_;
      } else {
        const std::size_t end = std::min(text_.find_first_of(" \t\r\n,]}#", at_), text_.size());
        at_ = std::max(end, at_ + (c == '\n' || c == '#' ? 0 : 1));
      }
      if (open.empty()) return;
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
  Path table_;  ///< names of the table whose header was read last
  std::vector<TomlKey> keys_;
};

}  // namespace

std::vector<TomlKey> find_toml_keys(std::string_view text) { return KeyScanner(text).scan(); }

}  // namespace pkm
