#include "engine/runner/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace pkm {
namespace {

template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, arguments...);
  return text;
}

std::string bar(double share, int width) {
  const int full = static_cast<int>(std::lround(width * std::clamp(share, 0.0, 1.0)));
  return '[' + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(width - full), '.') + "] ";
}

/// Share of the stage's evaluation limit that has been used; 0 if there is no limit.
double completed_share(const ProgressReport& r) {
  return r.evaluation_limit > 0 ? double(r.evaluations) / double(r.evaluation_limit) : 0;
}

/// Items of a progress line that are omitted or shortened, in this order, if the line is too long.
enum Cut { kEvaluations = 1, kLongBar, kWords, kBar, kShare, kRate, kStage, kLeft };

/// Text of a progress line.
/// @param cuts  number of items that are omitted or shortened, from the beginning of Cut
std::string line(const ProgressReport& r, bool with_bar, int cuts) {
  const auto shows = [&](Cut item) { return cuts < item; };
  const bool full_words = shows(kWords);
  std::string text = with_bar && shows(kBar) ? bar(completed_share(r), shows(kLongBar) ? 20 : 8) : "";
  if (shows(kStage) && r.stages > 1)
    text += "stage " + std::to_string(r.stage + 1) + " of " + std::to_string(r.stages) + ": ";
  text += (full_words ? r.optimiser + " " : "") + "generation " + std::to_string(r.generation);
  if (shows(kEvaluations)) text += ", " + std::to_string(r.evaluations) + " evaluations";
  if (shows(kRate) && r.evaluations_per_second > 0) text += format(", %.3g/s", r.evaluations_per_second);
  if (r.front > 0)
    text += format(", front %zu", r.front) +
            (std::isnan(r.hypervolume) ? "" : format(full_words ? ", hypervolume %.6g" : ", hv %.4g", r.hypervolume));
  else if (r.has_best)
    text += full_words ? ", " + r.objective + format(" %.8g", r.best) : format(", best %.6g", r.best);
  else if (!r.objective.empty())
    text += format(", nothing feasible yet (violation %.3g)", r.violation);
  if (shows(kShare)) text += format(", %.0f %% feasible", 100 * r.feasible_share);
  if (shows(kLeft) && r.left) text += std::string(full_words ? ", at most " : ", ") + duration_text(*r.left) + " left";
  return text;
}

std::size_t terminal_width(std::FILE* out) {
  constexpr std::size_t kDefaultWidth = 80;
  winsize size{};
  return ::ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kDefaultWidth;
}

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 1e-3) return format("%.3g us", 1e6 * seconds);
  if (seconds < 1) return format("%.3g ms", 1000 * seconds);
  if (seconds < 60) return format("%.1f s", seconds);
  const long whole = std::lround(seconds);
  if (whole < 3600) return format("%ld min %02ld s", whole / 60, whole % 60);
  return format("%ld h %02ld min", whole / 3600, whole / 60 % 60);
}

std::string progress_line(const ProgressReport& r) { return line(r, false, 0); }

std::string progress_bar_line(const ProgressReport& r, std::size_t width) {
  std::string text = line(r, true, 0);
  for (int cuts = 1; cuts <= kLeft && text.size() > width; ++cuts) text = line(r, true, cuts);
  if (text.size() > width) text.resize(width);
  return text;
}

ScreenProgress::ScreenProgress(std::FILE* out) : out_(out), terminal_(isatty(fileno(out)) == 1) {}

ScreenProgress::~ScreenProgress() { ScreenProgress::finish(); }

void ScreenProgress::generation(const ProgressReport& r) {
  const double interval = terminal_ ? 0.1 : 10;
  if (last_ < 0 && !terminal_) last_ = 0;
  if (last_ >= 0 && r.seconds - last_ < interval) return;
  last_ = r.seconds;
  if (terminal_) {
    // The last column is left free, because some terminals start a new line as soon as it is written. The width is
    // queried each time, because the window may have been resized.
    std::fprintf(out_, "\r\033[K%s", progress_bar_line(r, terminal_width(out_) - 1).c_str());
    open_ = true;
  } else {
    std::fprintf(out_, "%s\n", progress_line(r).c_str());
  }
  std::fflush(out_);
}

void ScreenProgress::step(const std::string& description) {
  const std::string text = "final step: " + description;
  if (terminal_)
    std::fprintf(out_, "\r\033[K%s", text.substr(0, terminal_width(out_) - 1).c_str());
  else
    std::fprintf(out_, "%s\n", text.c_str());
  open_ = terminal_;
  std::fflush(out_);
}

void ScreenProgress::finish() {
  if (open_) std::fprintf(out_, "\r\033[K");
  open_ = false;
  std::fflush(out_);
}

}  // namespace pkm
