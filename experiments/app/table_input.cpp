#include "experiments/app/table_input.hpp"

#include <algorithm>
#include <iostream>

#include "engine/config/text_file.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/storage/safe_file.hpp"

namespace pkm {

void expect_table(const TableJob& job, const std::string& option) {
  if (job.input.empty() && !job.csv.empty())
    throw ConfigError({"", 0, "-o"}, "'" + job.csv + "'", option + " with a table; -o writes its results");
}

CsvColumns read_table(const TableJob& job, const std::vector<Assignable>& known, bool needs_all,
                      const std::string& program) {
  constexpr std::size_t kLargestTable = std::size_t{1} << 30;  // maximum size of a table file in bytes
  const std::string names = join(names_of(known));
  if (!job.csv.empty()) check_outputs({job.csv}, {job.input}, if_forced(job.force));
  const std::string text = read_text_file(job.input, "a table (CSV) with the columns " + names, kLargestTable);
  CsvColumns table = read_csv_columns(text, job.input, known);
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!table.values[i]) missing.push_back(known[i].name);
  if (missing.size() == known.size() || (needs_all && !missing.empty()))
    throw ConfigError(
        {job.input, 1, ""},
        "no column " + missing.front() + (table.others.empty() ? "" : " (but " + join(table.others) + ")"),
        needs_all ? "the columns " + names : "some of the columns " + names);
  if (table.rows == 0) throw ConfigError({job.input, 2, ""}, "no rows", "at least one");
  if (!table.others.empty())
    std::cerr << program << ": note: " << job.input << ": columns that are not read: " << join(table.others) << '\n';
  return table;
}

void report_table(const TableJob& job, const CsvTable& table, std::vector<Json> objects, const std::string& summary,
                  Printout& out) {
  if (!job.csv.empty()) {
    write_table(job, table);
    out.text = job.csv + ": " + summary + '\n';
  } else {
    out.text = table.text();
  }
  out.json_lines = std::move(objects);
}

}  // namespace pkm
