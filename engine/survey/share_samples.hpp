// Samples of one survey, found by several threads.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/core/team.hpp"
#include "engine/mechanism/survey.hpp"

namespace pkm {

/// Calls fill(piece, survey, worker) for every piece in [0, pieces), which is to add the piece's samples, its feasible
/// cells and whether they touch the box: in order, or, where this thread has a team, shared out among it. The
/// samples are the same, in the same order.
/// @param worker  < workers(): pieces at work at once have different ones
template <class S, class Fill>
void share_samples(std::size_t pieces, Survey<S>& survey, const Fill& fill) {
  if (!has_team()) {
    for (std::size_t piece = 0; piece < pieces; ++piece) fill(piece, survey, std::size_t{0});
    return;
  }
  std::vector<Survey<S>> parts(pieces);
  for (Survey<S>& part : parts)
    for (const auto& field : survey.fields) part.fields[field.first];
  share_pieces(pieces, [&](std::size_t piece, std::size_t end, std::size_t worker) {
    for (; piece < end; ++piece) fill(piece, parts[piece], worker);
  });
  for (const Survey<S>& part : parts) {
    append_samples(part, survey);
    survey.feasible_cells += part.feasible_cells;
    survey.touches_box = survey.touches_box || part.touches_box;
  }
}

}  // namespace pkm
