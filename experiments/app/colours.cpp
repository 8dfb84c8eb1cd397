#include "experiments/app/colours.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <vector>

#include "engine/core/text_table.hpp"

namespace pkm {
namespace {

using Text = std::string_view;

// What SGR of ECMA-48 calls them; terminals choose colours that suit their background.
constexpr Text kPlain, kBold = "1", kFaint = "2", kRed = "31", kGreen = "32", kYellow = "33", kCyan = "36";

std::string in(Text ink, Text text) {
  if (ink.empty() || text.empty()) return std::string(text);
  return "\x1b[" + std::string(ink) + 'm' + std::string(text) + "\x1b[0m";
}

/// What lines begin with, before a colon, and how the rest of the line looks.
struct Label {
  Text word, ink, rest;
};
constexpr Label kLabels[] = {
    {"active", kYellow, kYellow},           {"warning", kYellow, kPlain}, {"note", kCyan, kPlain},
    {"contradiction", kRed, kPlain},        {"verdict", kRed, kPlain},    {"next", kFaint, kBold},
    {"stopped; go on with", kYellow, kBold}};

/// The line with its label painted; "": it has none.
std::string labelled(Text line) {
  for (const Label& label : kLabels)
    if (line.starts_with(label.word) && line.substr(label.word.size()).starts_with(": ")) {
      const std::size_t end = label.word.size() + 1;
      return in(label.ink, line.substr(0, end)) + in(label.rest, line.substr(end));
    }
  return "";
}

/// A cell of a table, and the spaces before it.
struct Cell {
  Text gap, text;
};

/// Cells are parted by two spaces or more.
std::vector<Cell> cells_of(Text line) {
  std::vector<Cell> cells;
  while (!line.empty()) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t end = std::min(line.find("  ", begin), line.size());
    cells.push_back({line.substr(0, begin), line.substr(begin, end - begin)});
    line.remove_prefix(end);
  }
  return cells;
}

bool is_number(const Cell& cell) { return point_of_number(cell.text).has_value(); }

/// The line names the columns of the next: it begins further in, or has no number where the next has some.
bool names_columns(const std::vector<Cell>& line, const std::vector<Cell>& next) {
  if (next.empty() || next[0].gap.empty() || std::ranges::any_of(line, is_number)) return false;
  return line[0].gap.size() > next[0].gap.size() || (line.size() > 2 && std::ranges::any_of(next, is_number));
}

Text ink_of(Text cell) {
  const bool gain = !cell.empty() && (cell[0] == '+' || cell[0] == '-') && point_of_number(cell).has_value();
  if (cell == "holds" || cell == "yes" || (gain && cell.ends_with('%'))) return kGreen;
  const bool fails = cell == "broken" || cell == "violated" || cell == "no" || cell.starts_with("no: ");
  if (fails || cell == "nothing feasible" || (gain && cell.ends_with("worse"))) return kRed;
  return kPlain;
}

std::string row(const std::vector<Cell>& cells, const std::vector<Cell>& next) {
  const bool names = names_columns(cells, next);
  std::string text;
  for (const Cell& cell : cells) text.append(cell.gap).append(in(names ? kFaint : ink_of(cell.text), cell.text));
  return text;
}

std::string line_with_colours(Text line, Text next, Text program) {
  if (line.empty()) return "";
  if (line[0] == ' ') return row(cells_of(line), cells_of(next));
  if (line.starts_with(program) && line.substr(program.size()).starts_with(": ")) {
    const Text name = line.substr(0, program.size() + 2), sentence = line.substr(name.size());
    const std::string rest = labelled(sentence);
    return rest.empty() ? in(kRed, name) + std::string(sentence) : std::string(name) + rest;
  }
  const std::string found = labelled(line);
  if (!found.empty()) return found;
  const bool heading = next.starts_with("  ") && std::isalpha(static_cast<unsigned char>(line[0])) != 0;
  return in(heading ? kBold : kPlain, line);
}

}  // namespace

bool shows_colours(int descriptor) {
  const char* const forbidden = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return (!forbidden || !*forbidden) && terminal && Text(terminal) != "dumb" && isatty(descriptor) == 1;
}

std::string painted(Text lines, Text program) {
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    const Text line = lines.substr(0, end);
    lines.remove_prefix(end == Text::npos ? lines.size() : end + 1);
    text += line_with_colours(line, lines.substr(0, lines.find('\n')), program);
    if (end != Text::npos) text += '\n';
  }
  return text;
}

}  // namespace pkm
