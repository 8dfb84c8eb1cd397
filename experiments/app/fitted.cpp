#include "experiments/app/fitted.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>

namespace pkm {
namespace {

using Text = std::string_view;

constexpr std::size_t kNarrowest = 24;  // columns that are worth breaking a sentence into

/// The escape sequence of a colour that the text begins with.
std::size_t escape_length(Text text) { return text.starts_with("\x1b[") ? text.find('m') + 1 : 0; }

/// Columns that the text takes on the terminal: bytes, but for those that go on with a character of UTF-8.
std::size_t shown_width(Text text) {
  std::size_t width = 0;
  while (!text.empty()) {
    const std::size_t escape = escape_length(text);
    width += escape == 0 && (static_cast<unsigned char>(text[0]) & 0xC0U) != 0x80U;
    text.remove_prefix(std::max<std::size_t>(escape, 1));
  }
  return width;
}

/// Where the last cell of a row begins; 0: the line is no row of several cells, or the last one is no sentence.
std::size_t sentence_of_row(Text line) {
  const std::size_t first = line.find_first_not_of(' '), gap = line.rfind("  ");
  if (first < 2 || gap == Text::npos || gap < first || line[first] == '"') return 0;
  const Text last = line.substr(gap + 2);
  const Text words = last.substr(escape_length(last));
  const bool sentence = !words.empty() && std::isalpha(static_cast<unsigned char>(words[0])) != 0;
  return sentence && std::ranges::count(words, ' ') > 1 ? gap + 2 : 0;
}

std::string fitted_line(Text line, std::size_t columns) {
  const std::size_t begin = sentence_of_row(line), indent = shown_width(line.substr(0, begin));
  if (begin == 0 || shown_width(line) <= columns || indent + kNarrowest > columns) return std::string(line);
  std::string text(line.substr(0, begin));
  std::size_t at = indent;
  for (Text rest = line.substr(begin); !rest.empty();) {
    const Text word = rest.substr(0, rest.find(' '));
    const std::size_t width = shown_width(word);
    if (at > indent && at + 1 + width > columns) {
      text += '\n' + std::string(indent, ' ');
      at = indent;
    }
    if (at > indent) text += ' ';
    at += (at > indent ? 1 : 0) + width;
    text += word;
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
  }
  return text;
}

}  // namespace

std::size_t columns_of_terminal(int descriptor) {
  winsize size{};
  return ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

std::string fitted(Text lines, std::size_t columns) {
  if (columns == 0) return std::string(lines);
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    text += fitted_line(lines.substr(0, end), columns);
    if (end != Text::npos) text += '\n';
    lines.remove_prefix(end == Text::npos ? lines.size() : end + 1);
  }
  return text;
}

}  // namespace pkm
