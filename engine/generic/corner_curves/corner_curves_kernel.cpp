#include "engine/generic/corner_curves/kernels.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::generic::corner_curves {

using L = LanesOf<PKM_INSTRUCTION_SET>;

template <InstructionSet set>
void transform(const double* table, const double* values, double* coefficients) {
  constexpr std::size_t kHalf = kNodes / 2;
  L even[2] = {L(0.0), L(0.0)}, odd[2] = {L(0.0), L(0.0)};
  for (std::size_t n = 0; n < kHalf; ++n) {
    const double* const row = table + n * kNodes;
    const L sum(values[n] + values[kNodes - 1 - n]), difference(values[n] - values[kNodes - 1 - n]);
    for (std::size_t i = 0; i < 2; ++i) {
      even[i] = even[i] + sum * L::load(row + i * kLanes);
      odd[i] = odd[i] + difference * L::load(row + kHalf + i * kLanes);
    }
  }
  double e[kHalf], o[kHalf];
  for (std::size_t i = 0; i < 2; ++i) {
    even[i].store(e + i * kLanes);
    odd[i].store(o + i * kLanes);
  }
  constexpr double kFactor = 2.0 / kNodes;
  for (std::size_t k = 0; k < kHalf; ++k) {
    coefficients[2 * k] = e[k] * kFactor;
    coefficients[2 * k + 1] = o[k] * kFactor;
  }
  coefficients[0] *= 0.5;
}

template <InstructionSet set>
void restrict_to_halves(const double* table, const double* c, std::size_t terms, double* lower, double* upper) {
  double alternating[kLanes];
  for (int j = 0; j < kLanes; ++j) alternating[j] = j % 2 == 0 ? 1 : -1;
  const L signs = L::load(alternating);
  for (std::size_t j = 0; j < terms; j += kLanes) {
    L even(0.0), odd(0.0);
    std::size_t k = j;
    for (; k + 1 < terms; k += 2) {
      even = even + L(c[k]) * L::load(table + k * kNodes + j);
      odd = odd + L(c[k + 1]) * L::load(table + (k + 1) * kNodes + j);
    }
    if (k < terms) even = even + L(c[k]) * L::load(table + k * kNodes + j);
    (even + odd).store(upper + j);
    ((even - odd) * signs).store(lower + j);
  }
}

template <InstructionSet set>
void series_at_points(const double* const* series, std::size_t count, std::size_t terms, const double* points,
                      double* values) {
  const L x[2] = {L::load(points), L::load(points + kLanes)};
  const L twice[2] = {x[0] + x[0], x[1] + x[1]};
  for (std::size_t s = 0; s < count; ++s) {
    const double* const c = series[s];
    L next[2] = {L(0.0), L(0.0)}, after[2] = {L(0.0), L(0.0)};
    for (std::size_t k = terms; k-- > 1;)
      for (std::size_t i = 0; i < 2; ++i) {
        const L here = (L(c[k]) + twice[i] * next[i]) - after[i];
        after[i] = next[i];
        next[i] = here;
      }
    for (std::size_t i = 0; i < 2; ++i)
      ((L(c[0]) + x[i] * next[i]) - after[i]).store(values + s * kPoints + i * kLanes);
  }
}

template <InstructionSet set>
void add_adjoints_of_series(const double* points, std::size_t number_of_points, const double* weights,
                            std::size_t count, std::size_t terms, double* const* coefficients) {
  L polynomials[kNodes / kLanes][kPoints];  // [k / kLanes][q]: T_k at point q, for kLanes successive k
  for (std::size_t q = 0; q < number_of_points; ++q) {
    // T_0 .. T_8, of which eight at a time follow by T_(k+8) = 2 T_8 T_k - T_|k-8|.
    double first[kLanes + 1] = {1, points[q]}, reversed[kLanes];
    for (int k = 2; k <= kLanes; ++k) first[k] = 2 * points[q] * first[k - 1] - first[k - 2];
    for (int k = 0; k < kLanes; ++k) reversed[k] = first[kLanes - k];
    const L twice(2 * first[kLanes]);
    L before = L::load(reversed), now = L::load(first);
    for (std::size_t k = 0; k < terms / kLanes; ++k) {
      polynomials[k][q] = now;
      const L next = twice * now - before;
      before = now;
      now = next;
    }
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < terms / kLanes; ++k) {
      double* const to = coefficients[i] + k * kLanes;
      L total = L::load(to);
      for (std::size_t q = 0; q < number_of_points; ++q)
        total = total + polynomials[k][q] * L(weights[i * kPoints + q]);
      total.store(to);
    }
}

template <InstructionSet set>
void combine_rows(const double* table, const double* factors, std::size_t size, double* values) {
  for (std::size_t n = 0; n < size; n += kLanes) {
    L even(0.0), odd(0.0);
    for (std::size_t k = 0; k < size; k += 2) {
      even = even + L(factors[k]) * L::load(table + k * kNodes + n);
      odd = odd + L(factors[k + 1]) * L::load(table + (k + 1) * kNodes + n);
    }
    (even + odd).store(values + n);
  }
}

template <InstructionSet set>
double concurrence_at_nodes(const ConcurrenceArguments& curves, double* values) {
  const L second(curves.second_share), third(curves.third_share);
  L largest(0.0);
  for (std::size_t n = 0; n < kNodes; n += kLanes) {
    const L ox = L::load(curves.first[0] + n), oy = L::load(curves.first[1] + n), oc = L::load(curves.first[2] + n);
    const L fx = second * ox - L::load(curves.second[0] + n), fy = second * oy - L::load(curves.second[1] + n),
            fc = second * oc - L::load(curves.second[2] + n);
    const L gx = third * ox - L::load(curves.third[0] + n), gy = third * oy - L::load(curves.third[1] + n),
            gc = third * oc - L::load(curves.third[2] + n);
    // (x, y)/d is the radical centre of the three curves: the intersection of the lines through the crossings of the
    // first curve with each of the others.
    const L x = fy * gc - gy * fc, y = fc * gx - gc * fx, d = fx * gy - gx * fy;
    (x * x + y * y + d * (ox * x + oy * y + d * oc)).store(values + n);
    for (const L& each : {x, y, d}) largest = greater(largest, greater(each, -each));
  }
  double all[kLanes], result = 0;
  largest.store(all);
  for (const double each : all) result = each > result ? each : result;
  return result;
}

template void transform<PKM_INSTRUCTION_SET>(const double*, const double*, double*);
template void restrict_to_halves<PKM_INSTRUCTION_SET>(const double*, const double*, std::size_t, double*, double*);
template void series_at_points<PKM_INSTRUCTION_SET>(const double* const*, std::size_t, std::size_t, const double*,
                                                    double*);
template void add_adjoints_of_series<PKM_INSTRUCTION_SET>(const double*, std::size_t, const double*, std::size_t,
                                                          std::size_t, double* const*);
template void combine_rows<PKM_INSTRUCTION_SET>(const double*, const double*, std::size_t, double*);
template double concurrence_at_nodes<PKM_INSTRUCTION_SET>(const ConcurrenceArguments&, double*);

}  // namespace pkm::generic::corner_curves
