#include "experiments/app/terminal_colours.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <vector>

#include "engine/core/text_table.hpp"

namespace pkm {
namespace {

using Text = std::string_view;

// Parameters of the control sequence SGR (ECMA-48); terminals map these colours to suit their background.
constexpr Text kPlain, kBold = "1", kFaint = "2", kRed = "31", kGreen = "32", kYellow = "33", kCyan = "36";

std::string styled(Text style, Text text) {
  if (style.empty() || text.empty()) return std::string(text);
  return "\x1b[" + std::string(style) + 'm' + std::string(text) + "\x1b[0m";
}

/// A word at the beginning of a line that is followed by a colon, the style of this label, and the style of the rest of
/// the line.
struct Label {
  Text word, style, rest_style;
};
constexpr Label kLabels[] = {{"active", kYellow, kYellow},
                             {"warning", kYellow, kPlain},
                             {"note", kCyan, kPlain},
                             {"contradiction", kRed, kPlain},
                             {"diagnosis", kRed, kPlain},
                             {"next", kFaint, kBold},
                             {"stopped, exit code 3; resume with", kYellow, kBold}};

/// The line with its label coloured; "" if the line has no label.
std::string coloured_label(Text line) {
  for (const Label& label : kLabels)
    if (line.starts_with(label.word) && line.substr(label.word.size()).starts_with(": ")) {
      const std::size_t end = label.word.size() + 1;
      return styled(label.style, line.substr(0, end)) + styled(label.rest_style, line.substr(end));
    }
  return "";
}

/// A cell of a table with the spaces before it.
struct TableCell {
  Text gap, text;
};

/// Divides a line into cells, which are separated by at least two spaces.
std::vector<TableCell> cells_of(Text line) {
  std::vector<TableCell> cells;
  while (!line.empty()) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t end = std::min(line.find("  ", begin), line.size());
    cells.push_back({line.substr(0, begin), line.substr(begin, end - begin)});
    line.remove_prefix(end);
  }
  return cells;
}

bool is_number(const TableCell& cell) { return decimal_point_index(cell.text).has_value(); }

/// @return true if the line seems to be the header of the row below: it contains no numbers, and either it is indented
/// further than the row, or it has more than two cells and the row contains numbers
bool is_header(const std::vector<TableCell>& line, const std::vector<TableCell>& next) {
  if (next.empty() || next[0].gap.empty() || std::ranges::any_of(line, is_number)) return false;
  return line[0].gap.size() > next[0].gap.size() || (line.size() > 2 && std::ranges::any_of(next, is_number));
}

/// The style of a cell by its content: green for satisfied constraints and gains, red for violated ones and losses.
Text style_of(Text cell) {
  const bool gain = !cell.empty() && (cell[0] == '+' || cell[0] == '-') && decimal_point_index(cell).has_value();
  if (cell == "satisfied" || cell == "yes" || (gain && cell.ends_with('%'))) return kGreen;
  const bool fails = cell == "violated" || cell == "no" || cell.starts_with("no: ");
  if (fails || cell == "nothing feasible" || (gain && cell.ends_with("worse"))) return kRed;
  return kPlain;
}

std::string coloured_row(const std::vector<TableCell>& cells, const std::vector<TableCell>& next) {
  const bool header = is_header(cells, next);
  std::string text;
  for (const TableCell& cell : cells)
    text.append(cell.gap).append(styled(header ? kFaint : style_of(cell.text), cell.text));
  return text;
}

std::string coloured_line(Text line, Text next, Text program) {
  if (line.empty()) return "";
  if (line[0] == ' ') return coloured_row(cells_of(line), cells_of(next));
  if (line.starts_with(program) && line.substr(program.size()).starts_with(": ")) {
    const Text name = line.substr(0, program.size() + 2), sentence = line.substr(name.size());
    const std::string rest = coloured_label(sentence);
    return rest.empty() ? styled(kRed, name) + std::string(sentence) : std::string(name) + rest;
  }
  const std::string found = coloured_label(line);
  if (!found.empty()) return found;
  const bool heading = next.starts_with("  ") && std::isalpha(static_cast<unsigned char>(line[0])) != 0;
  return styled(heading ? kBold : kPlain, line);
}

}  // namespace

bool supports_colours(int descriptor) {
  const char* const no_color = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return (!no_color || !*no_color) && terminal && Text(terminal) != "dumb" && isatty(descriptor) == 1;
}

std::string coloured(Text lines, Text program) {
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    const Text line = lines.substr(0, end);
    lines.remove_prefix(end == Text::npos ? lines.size() : end + 1);
    text += coloured_line(line, lines.substr(0, lines.find('\n')), program);
    if (end != Text::npos) text += '\n';
  }
  return text;
}

}  // namespace pkm
