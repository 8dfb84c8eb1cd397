// Serialisation of evaluation results for MPI messages: byte strings that contain the row numbers with the results.
#pragma once

#include <cstdint>
#include <string>

#include "engine/problem/start_outcome.hpp"

namespace pkm {

/// Appends the results of `count` rows from row `first` on, without their designs, to `bytes`.
void pack_rows(const EvaluationTable& table, std::size_t first, std::size_t count, std::string& bytes);

/// Reads rows written by pack_rows(), from byte `at` on, into an evaluation table of the same shape. Returns the number
/// of rows and advances `at` past them.
std::size_t unpack_rows(const std::string& bytes, std::size_t& at, EvaluationTable& table);

/// Appends a multistart run with its designs to `bytes`.
void pack_unmerged_run(const UnmergedRun& start, std::string& bytes);
/// Reads a run written by pack_unmerged_run() from the byte `offset` on and advances `offset` past it.
UnmergedRun unpack_unmerged_run(const std::string& bytes, std::size_t& offset, const EvaluationShape& shape);

/// Hash of the designs and results of rows [first, end), without their times.
std::uint64_t hash_of_rows(const EvaluationTable& table, std::size_t first, std::size_t end);

}  // namespace pkm
