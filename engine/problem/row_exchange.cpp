#include "engine/problem/row_exchange.hpp"

#include <bit>
#include <cstring>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/math/hash.hpp"

namespace pkm {
namespace {

void read_bytes(const std::string& bytes, std::size_t& at, void* to, std::size_t size) {
  PKM_EXPECTS(size <= bytes.size() - at);
  if (size > 0) std::memcpy(to, bytes.data() + at, size);
  at += size;
}

template <class Number>
void pack_number(Number value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class Number>
void read_number(const std::string& bytes, std::size_t& at, Number& value) {
  read_bytes(bytes, at, &value, sizeof value);
}

void pack_text(const std::string& text, std::string& bytes) {
  pack_number(std::uint64_t{text.size()}, bytes);
  bytes += text;
}
void read_text(const std::string& bytes, std::size_t& at, std::string& text) {
  std::uint64_t size = 0;
  read_number(bytes, at, size);
  PKM_EXPECTS(size <= bytes.size() - at);
  text = bytes.substr(at, size);
  at += size;
}

/// Calls action(array, count) for each array of results of an evaluation table, where `count` is the number of elements
/// per row.
template <class Table, class Action>
void for_each_result(Table& table, const Action& action) {
  const EvaluationShape shape = table.shape();
  action(table.seconds, 1);
  action(table.status, 1);
  action(table.objectives, shape.objectives);
  action(table.margins, shape.margins);
  action(table.reports, shape.reports);
  action(table.derivatives, shape.derivatives());
}

}  // namespace

void pack_rows(const EvaluationTable& table, std::size_t first, std::size_t count, std::string& bytes) {
  const std::uint64_t rows[2] = {first, count};
  bytes.append(reinterpret_cast<const char*>(rows), sizeof rows);
  for_each_result(table, [&](const auto& values, std::size_t width) {
    const auto* const begin = values.data() + first * width;
    bytes.append(reinterpret_cast<const char*>(begin), count * width * sizeof *begin);
  });
}

std::size_t unpack_rows(const std::string& bytes, std::size_t& at, EvaluationTable& table) {
  std::uint64_t rows[2];
  read_bytes(bytes, at, rows, sizeof rows);
  const std::size_t first = rows[0], count = rows[1];
  PKM_EXPECTS(first + count <= table.size());
  for_each_result(table, [&](auto& values, std::size_t width) {
    auto* const begin = values.data() + first * width;
    read_bytes(bytes, at, begin, count * width * sizeof *begin);
  });
  return count;
}

void pack_unmerged_run(const UnmergedRun& start, std::string& bytes) {
  pack_number(start.number, bytes);
  pack_number(std::uint64_t{start.table.size()}, bytes);
  bytes.append(reinterpret_cast<const char*>(start.table.designs.data()), start.table.designs.size() * sizeof(double));
  pack_rows(start.table, 0, start.table.size(), bytes);
  pack_number(start.outcome.has_value(), bytes);
  if (!start.outcome) return;
  const StartOutcome& end = *start.outcome;
  for (const std::string* text : {&end.origin, &end.stop, &end.message}) pack_text(*text, bytes);
  for (const std::int64_t number : {end.first_row, end.rows, end.end_row}) pack_number(number, bytes);
  pack_number(end.optimality, bytes);
}

UnmergedRun unpack_unmerged_run(const std::string& bytes, std::size_t& offset, const EvaluationShape& shape) {
  UnmergedRun start{0, EvaluationTable(shape), {}};
  std::uint64_t rows = 0;
  read_number(bytes, offset, start.number);
  read_number(bytes, offset, rows);
  PKM_EXPECTS(rows <= bytes.size() - offset);
  start.table.extend(rows);
  read_bytes(bytes, offset, start.table.designs.data(), start.table.designs.size() * sizeof(double));
  unpack_rows(bytes, offset, start.table);
  bool ended = false;
  read_number(bytes, offset, ended);
  if (!ended) return start;
  StartOutcome& end = start.outcome.emplace();
  for (std::string* text : {&end.origin, &end.stop, &end.message}) read_text(bytes, offset, *text);
  for (std::int64_t* number : {&end.first_row, &end.rows, &end.end_row}) read_number(bytes, offset, *number);
  read_number(bytes, offset, end.optimality);
  return start;
}

std::uint64_t hash_of_rows(const EvaluationTable& table, std::size_t first, std::size_t end) {
  Fnv1a hash;
  const EvaluationShape shape = table.shape();
  const auto add = [&](const std::vector<double>& values, std::size_t width) {
    for (std::size_t i = first * width; i < end * width; ++i) hash.add(std::bit_cast<std::uint64_t>(values[i]));
  };
  add(table.designs, shape.variables);
  add(table.objectives, shape.objectives);
  add(table.margins, shape.margins);
  add(table.reports, shape.reports);
  add(table.derivatives, shape.derivatives());
  for (std::size_t row = first; row < end; ++row) hash.add(static_cast<std::uint64_t>(table.status[row]));
  return hash.value();
}

}  // namespace pkm
