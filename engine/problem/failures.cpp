#include "engine/problem/failures.hpp"

#include <algorithm>
#include <cctype>
#include <map>

namespace pkm {
namespace {

constexpr std::size_t kMaxExamined = 64;
// Evaluating failed designs again ends once their recorded evaluation times add up to more than this [s].
constexpr double kMaxSeconds = 1;

/// Replaces each number in the reason of a failure by "#", except numbers within names ("l_11").
std::string mask_numbers(const std::string& reason) {
  const std::string digits = "0123456789";
  std::string text;
  for (std::size_t i = 0; i < reason.size(); ++i) {
    const bool in_name = !text.empty() && (std::isalnum(static_cast<unsigned char>(text.back())) || text.back() == '_');
    const bool is_number = (digits.find(reason[i]) != std::string::npos) && !in_name;
    text += is_number ? '#' : reason[i];
    if (is_number) i = std::min(reason.find_first_not_of(digits + ".e+-", i), reason.size()) - 1;
  }
  return text;
}

}  // namespace

Failures collect_failures(const std::vector<const EvaluationTable*>& tables, const DesignProblem* problem) {
  Failures found;
  std::vector<std::pair<const EvaluationTable*, std::size_t>> failed;
  for (const EvaluationTable* const table : tables) {
    found.evaluations += table->size();
    for (std::size_t row = 0; row < table->size(); ++row)
      if (table->status[row] == Status::failed) failed.emplace_back(table, row);
  }
  found.failed = failed.size();
  if (!problem) return found;
  const std::size_t most = std::min(kMaxExamined, failed.size());
  std::map<std::string, FailureReason> by_kind;
  double seconds = 0;
  for (std::size_t k = 0; k < most && (k == 0 || seconds <= kMaxSeconds); ++k) {
    const auto& [table, row] = failed[k * failed.size() / most];
    seconds += table->seconds[row];
    const std::string reason = problem->failure_reason(table->design(row), table->shape().detail);
    FailureReason& kind = by_kind[mask_numbers(reason)];
    if (kind.count++ == 0) kind.example = reason;
    ++found.examined;
  }
  for (auto& [kind, reason] : by_kind) found.reasons.push_back(std::move(reason));
  std::ranges::stable_sort(found.reasons, std::ranges::greater(), &FailureReason::count);
  return found;
}

std::string failures_text(const Failures& failures) {
  if (failures.failed == 0) return "";
  std::string text =
      std::to_string(failures.failed) + " of " + std::to_string(failures.evaluations) + " evaluations failed";
  if (failures.reasons.empty()) return text;
  text += failures.examined < failures.failed ? ", of which " + std::to_string(failures.examined) + " were examined: "
                                              : std::string(": ");
  for (const FailureReason& reason : failures.reasons) {
    if (&reason != failures.reasons.data()) text += "; ";
    text +=
        std::to_string(reason.count) + (reason.count == 1 ? " because " : " because, for example, ") + reason.example;
  }
  return text;
}

}  // namespace pkm
