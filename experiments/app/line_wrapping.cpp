#include "experiments/app/line_wrapping.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>

namespace pkm {
namespace {

using Text = std::string_view;

// Minimum width of a wrapped sentence [columns]; with less space, sentences are not wrapped.
constexpr std::size_t kMinSentenceWidth = 24;

/// Length of the colour escape sequence with which the text begins; 0 if there is none.
std::size_t escape_length(Text text) { return text.starts_with("\x1b[") ? text.find('m') + 1 : 0; }

/// Width of the text on the terminal: its number of bytes without escape sequences and UTF-8 continuation bytes.
std::size_t display_width(Text text) {
  std::size_t width = 0;
  while (!text.empty()) {
    const std::size_t escape = escape_length(text);
    width += escape == 0 && (static_cast<unsigned char>(text[0]) & 0xC0U) != 0x80U;
    text.remove_prefix(std::max<std::size_t>(escape, 1));
  }
  return width;
}

/// Offset of the last cell of a table row; 0 if the line is not a table row, or if this cell is not a sentence.
std::size_t sentence_offset(Text line) {
  const std::size_t first = line.find_first_not_of(' '), gap = line.rfind("  ");
  if (first < 2 || gap == Text::npos || gap < first || line[first] == '"') return 0;
  const Text last = line.substr(gap + 2);
  const Text words = last.substr(escape_length(last));
  const bool sentence = !words.empty() && std::isalpha(static_cast<unsigned char>(words[0])) != 0;
  return sentence && std::ranges::count(words, ' ') > 1 ? gap + 2 : 0;
}

/// The line; if it is a table row wider than `columns`, its last cell, a sentence, is wrapped.
std::string wrapped_row(Text line, std::size_t columns) {
  const std::size_t begin = sentence_offset(line), indent = display_width(line.substr(0, begin));
  if (begin == 0 || display_width(line) <= columns || indent + kMinSentenceWidth > columns) return std::string(line);
  std::string text(line.substr(0, begin));
  std::size_t at = indent;
  for (Text rest = line.substr(begin); !rest.empty();) {
    const Text word = rest.substr(0, rest.find(' '));
    const std::size_t width = display_width(word);
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

std::size_t terminal_width(int descriptor) {
  winsize size{};
  return ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

std::string wrap_table_rows(Text lines, std::size_t columns) {
  if (columns == 0) return std::string(lines);
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    text += wrapped_row(lines.substr(0, end), columns);
    if (end != Text::npos) text += '\n';
    lines.remove_prefix(end == Text::npos ? lines.size() : end + 1);
  }
  return text;
}

}  // namespace pkm
