#include "experiments/app/axes.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "engine/core/error.hpp"

namespace pkm {

AxisVector<double> axis_vector(std::span<const double> values) {
  AxisVector<double> vector(values.size());
  std::ranges::copy(values, vector.begin());
  return vector;
}

namespace {

template <class UnitOf>
std::string each_once(const Axes& axes, const UnitOf& unit_of) {
  std::vector<std::string> units;
  for (const AxisInfo& axis : axes)
    if (std::ranges::find(units, unit_of(axis)) == units.end()) units.push_back(unit_of(axis));
  return join(units);
}

}  // namespace

std::string units_of(const Axes& axes, const std::string& behind) {
  return each_once(axes, [&](const AxisInfo& axis) { return axis.unit + behind; });
}

std::string force_units_of(const Axes& joints) { return each_once(joints, force_unit); }

std::string axes_text(const Axes& axes, std::span<const double> values) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < axes.size(); ++i) texts.push_back(axes[i].name + " = " + number(values[i], axes[i].unit));
  return join(texts);
}

Json axes_json(const Axes& axes, const std::optional<AxisVector<double>>& values) {
  return values ? values_by_name(axes, *values) : Json();
}

Json vector_json(std::span<const double> values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(value);
  return list;
}

Json matrix_json(const AxisMatrix<double>& matrix) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < matrix.rows(); ++i)
    rows.push_back(vector_json({matrix.begin() + i * matrix.cols(), matrix.cols()}));
  return rows;
}

void print_matrix(std::ostream& out, const std::string& title, const AxisMatrix<double>& matrix) {
  out << '\n' << title << '\n';
  for (std::size_t i = 0; i < matrix.rows(); ++i) {
    for (std::size_t j = 0; j < matrix.cols(); ++j) {
      std::array<char, 32> cell{};
      std::snprintf(cell.data(), cell.size(), "%18.11g", matrix(i, j));
      out << cell.data();
    }
    out << '\n';
  }
}

}  // namespace pkm
