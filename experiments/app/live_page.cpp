#include "experiments/app/live_page.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "engine/core/error.hpp"
#include "engine/core/formatted.hpp"
#include "engine/export/xml_text.hpp"
#include "engine/report/thinning.hpp"
#include "engine/results/active_constraints.hpp"
#include "engine/runner/machine.hpp"
#include "engine/storage/checkpoint_clock.hpp"
#include "engine/storage/safe_file.hpp"

namespace pkm {
namespace {

constexpr double kMinInterval = 2;       // time between two writes [s]
constexpr double kLiveShare = 0.005;     // share of the run time spent on the page
constexpr int kReloadSeconds = 5;        // time after which the browser reloads the page
constexpr std::size_t kMaxPoints = 400;  // maximum number of points of a curve

constexpr const char* kLiveStyle = R"(
:root { color-scheme: light dark; --ground: #f6f7f8; --box: #fff; --ink: #1b2530; --muted: #5a6675; --line: #dde2e8;
  --accent: #0b62a8; --worse: #b04a00; --better: #00724f; }
@media (prefers-color-scheme: dark) { :root { --ground: #12161b; --box: #1a2027; --ink: #e7ebf0; --muted: #9aa7b5;
  --line: #303943; --accent: #6ab7f5; --worse: #f0a35e; --better: #4fc79c; } }
body { margin: 0 auto; padding: 24px; max-width: 1100px; background: var(--ground); color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", Roboto, "Liberation Sans", sans-serif; }
h1 { font-size: 26px; margin: 0 0 4px; overflow-wrap: anywhere; }
h2 { font-size: 16px; margin: 0 0 8px; }
section { background: var(--box); border: 1px solid var(--line); border-radius: 10px; padding: 14px 18px; margin-top: 16px; }
.state { font-size: 13px; font-weight: 600; padding: 1px 9px; border: 1px solid currentColor; border-radius: 10px; }
.finished { color: var(--better); }
.running { color: var(--accent); }
.interrupted, .failed { color: var(--worse); }
.muted { color: var(--muted); }
.bar { height: 12px; border-radius: 6px; background: var(--line); overflow: hidden; margin: 8px 0; }
.bar i { display: block; height: 100%; background: var(--accent); }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 3px 18px 3px 0; font-weight: 400; vertical-align: top; }
th { color: var(--muted); }
.columns { display: grid; gap: 16px; grid-template-columns: repeat(auto-fit, minmax(300px, 1fr)); }
svg { width: 100%; height: auto; display: block; }
svg text { fill: var(--muted); font-size: 12px; }
svg path { fill: none; stroke: var(--accent); stroke-width: 2; vector-effect: non-scaling-stroke; }
svg line { stroke: var(--line); }
code { font: .92em ui-monospace, Menlo, Consolas, "Liberation Mono", monospace; overflow-wrap: anywhere; }
a { color: var(--accent); }
)";

/// A number in the unit that people use: mm for lengths.
std::string shown_number(double value, const std::string& unit) {
  return std::isnan(value) ? "–" : formatted("%.4g", unit == "m" ? 1e3 * value : value);
}
/// The unit in which shown_number() shows values with this SI unit; "" for numbers without a unit.
std::string shown_unit(const std::string& unit) {
  if (unit == "m") return "mm";
  std::string text;
  for (std::size_t i = 0; unit != "1" && i < unit.size(); ++i) {
    const bool is_power = unit[i] == '^' && i + 1 < unit.size() && (unit[i + 1] == '2' || unit[i + 1] == '3');
    text += is_power ? (unit[++i] == '2' ? "²" : "³") : std::string(1, unit[i]);
  }
  return text;
}
std::string shown_value(double value, const std::string& unit) {
  const std::string name = shown_unit(unit);
  return shown_number(value, unit) + (name.empty() ? "" : " " + name);
}

std::string row(const std::string& name, const std::string& value) {
  return "<tr><th>" + xml_text(name) + "</th><td>" + xml_text(value) + "</td></tr>\n";
}

/// A curve over the generations of all stages.
struct Curve {
  std::string title, unit;
  std::string note;                         ///< text that is shown after the title
  std::vector<std::vector<double>> stages;  ///< one value per generation of each stage; NaN: none
};

/// The best feasible value of each objective up to each generation of each stage and, with several objectives, the
/// hypervolume of the front.
std::vector<Curve> convergence_curves(const StudyContents& contents) {
  std::vector<Curve> curves;
  const auto& objectives = contents.problem.objectives;
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    Curve curve{objectives[k].name, objectives[k].unit, ", best value", {}};
    const double sign = objectives[k].direction == Direction::maximise ? 1 : -1;
    for (const StageRecord& stage : contents.stages) {
      std::vector<double>& values = curve.stages.emplace_back();
      double best = std::numeric_limits<double>::quiet_NaN();
      std::size_t evaluated = 0;
      for (std::size_t g = 0; g < stage.generations.size(); ++g) {
        for (const std::size_t end = stage.generations.end_of(g, stage.table.size()); evaluated < end; ++evaluated) {
          const double value = stage.table.objective_row(evaluated)[k];
          if (stage.table.status[evaluated] == Status::feasible && !(sign * value <= sign * best)) best = value;
        }
        values.push_back(best);
      }
    }
    curves.push_back(std::move(curve));
  }
  if (std::ranges::any_of(contents.stages, [](const StageRecord& stage) { return stage.has_front(); })) {
    Curve curve{"hypervolume of the front", "1", "", {}};
    for (const StageRecord& stage : contents.stages) {
      curve.stages.push_back(stage.front ? stage.front->hypervolume : std::vector<double>());
      curve.stages.back().resize(stage.generations.size(), std::numeric_limits<double>::quiet_NaN());
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

/// A curve as SVG, with the minimum and the maximum as labels, and lines between the stages.
std::string chart(const Curve& curve) {
  constexpr double kWidth = 640, kHeight = 240, kLeft = 96, kRight = 12, kTop = 12, kBottom = 30;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::size_t generations = 0;
  for (const auto& values : curve.stages) {
    generations += values.size();
    for (const double value : values)
      if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  }
  if (!(low <= high)) return "<p class=\"muted\">No feasible design yet.</p>\n";
  const double range = high > low ? high - low : 1, last = std::max<double>(1, static_cast<double>(generations) - 1);
  const auto x = [&](std::size_t generation) {
    return kLeft + (kWidth - kLeft - kRight) * static_cast<double>(generation) / last;
  };
  const auto y = [&](double value) { return kTop + (kHeight - kTop - kBottom) * (high - value) / range; };
  const auto number = [](double value) { return formatted("%.1f", value); };
  const auto text = [&](double at_x, double at_y, const char* anchor, const std::string& content) {
    return "<text x=\"" + number(at_x) + "\" y=\"" + number(at_y) + "\" text-anchor=\"" + anchor + "\">" +
           xml_text(content) + "</text>\n";
  };
  const auto line = [&](double x0, double y0, double x1, double y1) {
    return "<line x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" + number(x1) + "\" y2=\"" + number(y1) +
           "\"/>\n";
  };
  std::string svg = "<svg viewBox=\"0 0 " + number(kWidth) + " " + number(kHeight) + "\" role=\"img\" aria-label=\"" +
                    xml_text(curve.title) + " over the generations\">\n";
  svg +=
      line(kLeft, kTop, kLeft, kHeight - kBottom) + line(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom);
  svg += text(kLeft - 8, y(high) + 4, "end", shown_number(high, curve.unit));
  if (high > low) svg += text(kLeft - 8, y(low) + 4, "end", shown_number(low, curve.unit));
  svg += text(kLeft, kHeight - 8, "middle", "0") +
         text(kWidth - kRight, kHeight - 8, "end", "generation " + std::to_string(generations - 1));
  std::size_t first = 0;
  for (const auto& values : curve.stages) {
    if (first > 0) svg += line(x(first), kTop, x(first), kHeight - kBottom);
    std::string path;
    for (const std::size_t g : Thinning(values.size(), kMaxPoints).indices) {
      if (!std::isfinite(values[g])) continue;
      path += (path.empty() ? "M" : "L") + number(x(first + g)) + " " + number(y(values[g]));
    }
    if (!path.empty()) svg += "<path stroke-linecap=\"round\" d=\"" + path + "h0\"/>\n";  // h0: a dot for one value
    first += values.size();
  }
  return svg + "</svg>\n";
}

std::string progress_section(const StudyContents& contents, const LivePageState& state) {
  const ProgressReport& r = state.progress;
  if (contents.stages.empty()) return "<section><h2>Progress</h2><p>No generation is complete yet.</p></section>\n";
  const StageRecord& stage = contents.stages.back();
  const double seconds = stage.generations.size() ? stage.generations.seconds.back() : 0;
  std::string rows =
      row("stage", std::to_string(contents.stages.size()) + " of " +
                       std::to_string(std::max(r.stages, contents.stages.size())) + ", " + stage.optimiser);
  if (stage.generations.size()) rows += row("generation", std::to_string(stage.generations.size() - 1));
  rows += row("evaluations of the stage",
              std::to_string(stage.table.size()) +
                  (r.evaluation_limit > 0 ? " of at most " + std::to_string(r.evaluation_limit) : ""));
  rows += row("evaluations of the study", std::to_string(contents.evaluations()));
  const bool is_running = state.state == StudyState::running;
  if (is_running && r.evaluations_per_second > 0)
    rows += row("rate", formatted("%.3g", r.evaluations_per_second) + " evaluations/s");
  if (stage.generations.size())
    rows +=
        row("feasible share of the population", formatted("%.0f %%", 100 * stage.generations.feasible_share.back()));
  rows += row("time so far", duration_text(is_running ? seconds : contents.seconds));
  std::string bar;
  if (is_running && r.left) {
    rows += row("time left, at most", duration_text(*r.left));
    const double share = r.seconds + *r.left > 0 ? 100 * r.seconds / (r.seconds + *r.left) : 0;
    bar = "<div class=\"bar\" title=\"share of the estimated time\"><i style=\"width:" + formatted("%.1f", share) +
          "%\"></i></div>\n";
  }
  return "<section><h2>Progress</h2>\n" + bar + "<table>" + rows + "</table></section>\n";
}

std::string best_section(const StudyContents& contents) {
  if (contents.best.row < 0) return "";
  const ProblemRecord& problem = contents.problem;
  const EvaluationTable& table = contents.best_stage().table;
  const auto best = static_cast<std::size_t>(contents.best.row);
  const bool is_feasible = table.status[best] == Status::feasible;
  std::string values, active;
  for (std::size_t k = 0; k < problem.objectives.size(); ++k)
    values += row(problem.objectives[k].name, shown_value(table.objective_row(best)[k], problem.objectives[k].unit));
  const std::span<const double> design = contents.best_design();
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    std::string value = shown_value(design[i], problem.variables[i].unit);
    std::size_t number = 0;  // number of the catalogue row, from 1
    if (problem.choices)
      for (const ChoiceName& choice : *problem.choices)
        if (choice.variable == static_cast<std::int64_t>(i) &&
            ++number == static_cast<std::size_t>(std::lround(design[i])))
          value = choice.name;
    values += row(problem.variables[i].name, value);
  }
  if (table.status[best] <= Status::infeasible)
    for (const std::string& sentence : active_sentences(problem, design, table.margin_row(best)))
      active += "<li>" + xml_text(sentence) + "</li>\n";
  const std::string status = is_feasible ? "" : " (" + words(table.status[best]) + ")";
  return "<div class=\"columns\"><section><h2>Best design so far" + status + "</h2><table>" + values +
         "</table></section>\n<section><h2>Active constraints of the best design</h2>" +
         (active.empty() ? "<p>No bound and no constraint is active.</p>" : "<ul>" + active + "</ul>") +
         "</section></div>\n";
}

std::string closing_sentence(const LivePageState& state) {
  const std::string file = xml_text(state.study_file);
  if (state.state == StudyState::running)
    return "The page reloads itself every " + std::to_string(kReloadSeconds) +
           " seconds. If the time of this state is old, an evaluation takes long, or the process was killed: "
           "<code>pkmopt resume " +
           file + " --live</code> continues the study from its last checkpoint.";
  if (!state.failure.empty())
    return "The run ended with an error: " + xml_text(state.failure) + ". <code>pkmopt resume " + file +
           " --live</code> continues the study from its last checkpoint, if there is one.";
  if (state.state == StudyState::interrupted)
    return "The run was stopped" + (state.stopped.empty() ? "" : " by " + xml_text(state.stopped)) +
           ". <code>pkmopt resume " + file + " --live</code> continues it.";
  if (state.report.empty()) return "The study is finished. <code>pkmopt report " + file + "</code> writes the report.";
  return "The study is finished: <a href=\"" + xml_text(state.report) + "\">report</a>.";
}

}  // namespace

std::string live_page_text(const StudyContents& contents, const LivePageState& state) {
  const std::string name = xml_text(contents.name), word = state.failure.empty() ? words(state.state) : "failed";
  std::string page =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; img-src data:\">\n";
  if (state.state == StudyState::running)
    page += "<meta http-equiv=\"refresh\" content=\"" + std::to_string(kReloadSeconds) + "\">\n";
  page += "<title>" + word + ": " + name + "</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>" + kLiveStyle +
          "</style>\n</head>\n<body>\n<h1>" + name + "</h1>\n<p><span class=\"state " + word + "\">" + word +
          "</span> " + xml_text(contents.problem.mechanism) + "<span class=\"muted\"> · state of " +
          xml_text(state.updated) + "</span></p>\n<p>" + closing_sentence(state) + "</p>\n";
  page += progress_section(contents, state) + best_section(contents);
  if (!contents.stages.empty())
    for (const Curve& curve : convergence_curves(contents)) {
      const std::string unit = shown_unit(curve.unit);
      page += "<section><h2>" + xml_text(curve.title + (unit.empty() ? "" : " [" + unit + "]")) + curve.note +
              " over the generations</h2>\n" + chart(curve) + "</section>\n";
    }
  return page + "</body>\n</html>\n";
}

LivePage::LivePage(std::string path, const std::string& study_file, const StudyContents& contents,
                   std::function<double()> now)
    : path_(std::move(path)), now_(now ? std::move(now) : steady_seconds) {
  state_.study_file = std::filesystem::path(study_file).filename().string();
  write(contents);
}

void LivePage::write(const StudyContents& contents) {
  const double begin = now_();
  state_.updated = utc_now();
  write_file(path_, live_page_text(contents, state_), Existing::replaced);
  const double end = now_();
  next_ = end + std::max(kMinInterval, (end - begin) / kLiveShare);
}

void LivePage::update(const StudyContents& contents, const ProgressReport& progress) {
  if (now_() < next_) return;
  state_.progress = progress;
  try {
    write(contents);
  } catch (const StorageError&) {
    next_ = now_() + 1 / kLiveShare;  // the disk may be full: try again after some minutes
  }
}

void LivePage::finish(const StudyContents& contents, const std::string& stopped, const std::string& report) {
  state_.state = stopped.empty() ? StudyState::finished : StudyState::interrupted;
  state_.stopped = stopped;
  state_.report = report.empty() ? "" : std::filesystem::path(report).filename().string();
  write(contents);
}

void LivePage::fail(const StudyContents& contents, const std::string& error) {
  state_.state = StudyState::interrupted;
  state_.failure = error;
  try {
    write(contents);
  } catch (const StorageError&) {
  }
}

std::string live_page_file(const std::string& study_file) {
  return std::filesystem::path(study_file).replace_extension(".live.html").string();
}

}  // namespace pkm
