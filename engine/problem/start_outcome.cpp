#include "engine/problem/start_outcome.hpp"

namespace pkm {

std::string_view words(StopReason reason) {
  switch (reason) {
    case StopReason::generations:
      return "generation limit";
    case StopReason::evaluations:
      return "evaluation limit";
    case StopReason::target:
      return "target reached";
    case StopReason::stall:
      return "no further improvement";
    case StopReason::tolerance:
      return "converged";
    case StopReason::exhausted:
      return "every design evaluated";
    case StopReason::interrupted:
      return "interrupted";
    case StopReason::time:
      return "time limit";
    case StopReason::failed:
      return "failed";
    case StopReason::starts:
      return "every start has ended";
  }
  return "";
}

}  // namespace pkm
