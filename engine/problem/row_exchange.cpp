#include "engine/problem/row_exchange.hpp"

#include <bit>
#include <cstring>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/math/hash.hpp"

namespace pkm {
namespace {

/// Calls part(array, width) for each array of results.
template <class Table, class Part>
void each_part(Table& table, const Part& part) {
  const EvaluationShape shape = table.shape();
  part(table.seconds, 1);
  part(table.status, 1);
  part(table.objectives, shape.objectives);
  part(table.margins, shape.margins);
  part(table.reports, shape.reports);
  part(table.slopes, shape.slopes());
}

}  // namespace

void pack_rows(const EvaluationTable& table, std::size_t first, std::size_t count, std::string& bytes) {
  const std::uint64_t rows[2] = {first, count};
  bytes.append(reinterpret_cast<const char*>(rows), sizeof rows);
  each_part(table, [&](const auto& values, std::size_t width) {
    const auto* const begin = values.data() + first * width;
    bytes.append(reinterpret_cast<const char*>(begin), count * width * sizeof *begin);
  });
}

std::size_t unpack_rows(const std::string& bytes, std::size_t& at, EvaluationTable& table) {
  const auto take = [&](void* to, std::size_t size) {
    PKM_EXPECTS(size <= bytes.size() - at);
    if (size > 0) std::memcpy(to, bytes.data() + at, size);
    at += size;
  };
  std::uint64_t rows[2];
  take(rows, sizeof rows);
  const std::size_t first = rows[0], count = rows[1];
  PKM_EXPECTS(first + count <= table.size());
  each_part(table, [&](auto& values, std::size_t width) {
    auto* const begin = values.data() + first * width;
    take(begin, count * width * sizeof *begin);
  });
  return count;
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
  add(table.slopes, shape.slopes());
  for (std::size_t row = first; row < end; ++row) hash.add(static_cast<std::uint64_t>(table.status[row]));
  return hash.value();
}

}  // namespace pkm
