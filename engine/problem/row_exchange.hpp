// Results of evaluations on their way between ranks: bytes that name the rows they belong to.
#pragma once

#include <cstdint>
#include <string>

#include "engine/problem/start_outcome.hpp"

namespace pkm {

/// Adds what the rows [first, first + count) hold beside their designs.
void pack_rows(const EvaluationTable& table, std::size_t first, std::size_t count, std::string& bytes);

/// Puts what pack_rows() has packed, from byte `at` on, into a table of the same shape. Returns how many rows came, the
/// last byte's end in `at`.
std::size_t unpack_rows(const std::string& bytes, std::size_t& at, EvaluationTable& table);

/// A start with its designs.
void pack_start(const StartAhead& start, std::string& bytes);
/// What pack_start() has packed, from byte `at` on; `at` is moved behind it.
StartAhead unpack_start(const std::string& bytes, std::size_t& at, const EvaluationShape& shape);

/// Of the rows [first, end), with their designs and results, and without their times.
std::uint64_t hash_of_rows(const EvaluationTable& table, std::size_t first, std::size_t end);

}  // namespace pkm
