#include "engine/study/progress.hpp"

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

std::string bar(double share) {
  constexpr int kWidth = 20;
  const int full = static_cast<int>(std::lround(kWidth * std::clamp(share, 0.0, 1.0)));
  return '[' + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(kWidth - full), '.') + ']';
}

std::string state(const ProgressReport& r) {
  std::string text = r.optimiser + " generation " + std::to_string(r.generation) + ", " +
                     std::to_string(r.evaluations) + " evaluations";
  if (r.evaluations_per_second > 0) text += format(" (%.3g/s)", r.evaluations_per_second);
  if (r.has_best)
    text += ", " + r.objective + format(" %.8g", r.best);
  else if (!r.objective.empty())
    text += format(", nothing feasible yet (violation %.3g)", r.violation);
  return text + format(", %.0f %% feasible", 100 * r.feasible_share);
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

ScreenProgress::ScreenProgress(std::FILE* out) : out_(out), terminal_(isatty(fileno(out)) == 1) {}

void ScreenProgress::generation(const ProgressReport& r) {
  const double pause = terminal_ ? 0.1 : 10;
  if (last_ < 0 && !terminal_) last_ = 0;
  if (last_ >= 0 && r.seconds - last_ < pause) return;
  last_ = r.seconds;
  const double share = r.evaluation_limit > 0 ? double(r.evaluations) / double(r.evaluation_limit) : 0;
  std::string line = state(r);
  if (r.stages > 1) line = "stage " + std::to_string(r.stage + 1) + " of " + std::to_string(r.stages) + ": " + line;
  if (share > 0 && share < 1 && r.evaluations_per_second > 0)
    line +=
        ", at most " + duration_text(double(r.evaluation_limit - r.evaluations) / r.evaluations_per_second) + " left";
  if (terminal_) {
    std::fprintf(out_, "\r\033[K%s %s", bar(share).c_str(), line.c_str());
    open_ = true;
  } else {
    std::fprintf(out_, "%s\n", line.c_str());
  }
  std::fflush(out_);
}

void ScreenProgress::finish() {
  if (open_) std::fprintf(out_, "\r\033[K");
  open_ = false;
  std::fflush(out_);
}

}  // namespace pkm
