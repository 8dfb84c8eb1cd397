#include "engine/results/design_table.hpp"

#include <algorithm>
#include <cmath>

namespace pkm {
namespace {

std::vector<DesignTable::Column> design_columns(const StudyContents& contents) {
  if (!contents.final || !contents.final->best) {
    if (const auto best = best_so_far(contents)) return {{"best so far", best, {}}};
    return {};
  }
  const FinalRecord& final = *contents.final;
  std::vector<DesignTable::Column> list = {{best_design_label(contents), final.best, final.best_exact}};
  if (final.rounded) list.push_back({"rounded", final.rounded, {}});
  if (final.baseline) list.push_back({"baseline", final.baseline, final.baseline_exact});
  return list;
}

}  // namespace

DesignTable design_table(const StudyContents& contents, const std::vector<Reference>& references) {
  DesignTable table{design_columns(contents), {}};
  if (table.columns.empty()) return table;
  const auto add = [&](DesignTable::Line line, bool exact, std::optional<Direction> direction, const auto& value_of,
                       const auto& published) {
    for (const DesignTable::Column& column : table.columns) {
      const auto& record = exact ? column.exact : column.record;
      line.values.push_back(record ? std::optional<double>(value_of(*record)) : std::nullopt);
    }
    const auto best = line.values.front(), baseline = line.values.back();
    if (direction && table.has_baseline() && best && baseline) line.gain = gain_over(*baseline, *best, *direction);
    for (const Reference& r : references) line.published.push_back(exact ? std::nullopt : published(r));
    if (exact) line.name += ", exact";
    table.lines.push_back(std::move(line));
  };
  const ProblemRecord& problem = contents.problem;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const ParameterRecord& p = problem.parameters[i];
    const auto published = [v = static_cast<std::size_t>(p.variable)](const Reference& r) {
      return r.design.empty() ? std::nullopt : r.design[v];
    };
    const auto value_of = [i](const DesignRecord& r) { return r.parameters[i]; };
    if (p.variable >= 0) add({"variable", p.name, p.unit, "", {}, {}, {}}, false, {}, value_of, published);
  }
  const auto add_all = [&](const char* kind, const auto& infos, std::vector<double> DesignRecord::*values) {
    const bool is_margin = values == &DesignRecord::margins;
    for (std::size_t i = 0; i < infos.size(); ++i) {
      const auto& info = infos[i];
      std::optional<Direction> direction;
      if constexpr (requires { info.direction; }) direction = info.direction;
      const auto value_of = [values, i](const DesignRecord& r) { return (r.*values)[i]; };
      const auto published = [&](const Reference& r) -> std::optional<double> {
        const auto known = std::ranges::find(r.values, info.name, [](const auto& named) { return named.first; });
        return is_margin || known == r.values.end() ? std::nullopt : std::optional(known->second);
      };
      const bool has_exact = !is_margin && std::ranges::any_of(table.columns, [&](const DesignTable::Column& column) {
        return column.exact && !std::isnan(value_of(*column.exact));
      });
      for (const bool exact : {false, true})
        if (!exact || has_exact)
          add({kind, info.name, info.unit, info.meaning, {}, {}, {}}, exact, direction, value_of, published);
    }
  };
  add_all("objective", problem.objectives, &DesignRecord::objectives);
  add_all("output", problem.reports, &DesignRecord::reports);
  add_all("constraint", problem.margins, &DesignRecord::margins);
  const auto is_certified = [](const DesignTable::Column& column) { return column.record->certified.has_value(); };
  if (std::ranges::none_of(table.columns, is_certified)) return table;
  const std::string& unit = contents.final->volume_unit;
  const auto add_volume = [&](const char* name, const char* meaning, const auto& value) {
    add({"certified", name, unit, meaning, {}, {}, {}}, false, {}, value,
        [](const Reference&) { return std::nullopt; });
  };
  const auto bound = [](double VolumeBounds::*end) {
    return [end](const DesignRecord& r) -> std::optional<double> {
      return r.certified ? std::optional((*r.certified).*end) : std::nullopt;
    };
  };
  add_volume("volume", "by cylindrical decomposition (method columns)", [](const DesignRecord& r) { return r.volume; });
  add_volume("volume, at least", "certified bound (interval arithmetic)", bound(&VolumeBounds::lower));
  add_volume("volume, at most", "certified bound (interval arithmetic)", bound(&VolumeBounds::upper));
  return table;
}

}  // namespace pkm
