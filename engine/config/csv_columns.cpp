#include "engine/config/csv_columns.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/core/options.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

/// Splits the text of a file with comma-separated values into rows, and rows into cells.
class Rows {
 public:
  Rows(const std::string& text, const std::string& file_name) : text_(text), file_(file_name) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // the byte order mark that spreadsheets write
  }
  /// Reads the next row that is not blank. @return false at the end of the text
  bool next(std::vector<std::string>& cells) {
    while (at_ < text_.size()) {
      line_ = next_line_;
      cells.clear();
      bool has_more = true;
      while (has_more) has_more = read_cell(cells);
      if (cells.size() > 1 || !cells.front().empty()) return true;
    }
    return false;
  }
  int line() const { return line_; }  ///< line number in the file of the row that was read last

 private:
  /// Reads the next cell and appends it to `cells`. @return false if the cell is the last one of its row
  bool read_cell(std::vector<std::string>& cells) {
    std::string& cell = cells.emplace_back();
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    if (at_ < text_.size() && text_[at_] == '"') {
      for (++at_;; ++at_) {
        if (at_ >= text_.size()) throw ConfigError({file_, line_, ""}, "an unclosed quotation mark", "\"..\"");
        if (text_[at_] == '\n') ++next_line_;
        if (text_[at_] == '"' && (at_ + 1 >= text_.size() || text_[++at_] != '"')) break;
        cell += text_[at_];
      }
      if (at_ + 1 == text_.size() && text_[at_] == '"') ++at_;  // the closing quote at the end of the text
    }
    while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n') cell += text_[at_++];
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t' || cell.back() == '\r')) cell.pop_back();
    if (at_ >= text_.size()) return false;
    if (text_[at_++] == ',') return true;
    ++next_line_;
    return false;
  }

  const std::string& text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1, next_line_ = 1;
};

struct Header {
  std::string name, unit;  ///< name and unit in the first line of the file; the unit is empty if it is not given there
};

Header header_of(const std::string& cell) {
  const std::size_t open = cell.find(" [");
  if (open == std::string::npos || cell.back() != ']') return {cell, ""};
  return {cell.substr(0, open), cell.substr(open + 2, cell.size() - open - 3)};
}

}  // namespace

CsvColumns read_csv_columns(const std::string& text, const std::string& file_name,
                            const std::vector<Assignable>& known) {
  Rows rows(text, file_name);
  std::vector<std::string> cells;
  const std::string names = join(names_of(known));
  if (!rows.next(cells)) throw ConfigError({file_name, 1, ""}, "an empty file", "a line with the columns " + names);
  CsvColumns found;
  found.values.resize(known.size());
  std::vector<Header> headers;
  // For each column of the file, the index of its name in `known`; std::nullopt: the name is unknown.
  std::vector<std::optional<std::size_t>> targets;
  for (const std::string& cell : cells) {
    const Header& header = headers.emplace_back(header_of(cell));
    const auto at = std::ranges::find(known, header.name, &Assignable::name);
    if (at == known.end()) {
      found.others.push_back(header.name);
      targets.emplace_back();
      continue;
    }
    auto& values = found.values[targets.emplace_back(static_cast<std::size_t>(at - known.begin())).value()];
    if (values) throw ConfigError({file_name, rows.line(), header.name}, "a second column of this name", "one");
    values.emplace();
    if (!header.unit.empty() && !parse_quantity("1 " + header.unit, at->unit) && header.unit != at->unit)
      throw ConfigError({file_name, rows.line(), header.name}, "the unit '" + header.unit + "'",
                        "a unit of " + kind_of_unit(at->unit));
  }
  const std::size_t columns = headers.size();
  while (rows.next(cells)) {
    if (cells.size() != columns)
      throw ConfigError({file_name, rows.line(), ""}, std::to_string(cells.size()) + " cells",
                        std::to_string(columns) + ", as in the first line");
    for (std::size_t i = 0; i < columns; ++i) {
      if (!targets[i]) continue;
      const Assignable& target = known[*targets[i]];
      const std::string& unit = headers[i].unit;
      auto value = parse_quantity(cells[i], target.unit);
      if (!unit.empty() && unit != target.unit)  // a cell without a unit is in the unit of its column
        value = parse_quantity(cells[i] + " " + unit, target.unit);
      if (!value)
        throw ConfigError(
            {file_name, rows.line(), target.name}, "'" + cells[i] + "'",
            "a number" + (unit.empty() ? ", with or without a unit of " + kind_of_unit(target.unit) : " in " + unit));
      if (!(*value >= target.lower && *value <= target.upper))
        throw ConfigError({file_name, rows.line(), target.name}, with_degrees(*value, target.unit),
                          format_range(target.lower, target.upper, target.unit));
      found.values[*targets[i]]->push_back(*value);
    }
    ++found.rows;
  }
  return found;
}

}  // namespace pkm
