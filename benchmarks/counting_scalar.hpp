// A scalar type that counts floating-point operations, to determine how many a kernel performs.
#pragma once

#include <cmath>
#include <cstdint>

#include "engine/math/scalar.hpp"

namespace pkm::benchmarks {

/// Numbers of operations: additions and subtractions, multiplications, divisions, square roots. Comparisons and
/// selections are not counted.
struct Operations {
  std::int64_t sums = 0, products = 0, quotients = 0, roots = 0;
  std::int64_t all() const { return sums + products + quotients + roots; }
  friend Operations operator*(std::int64_t times, const Operations& each) {
    return {times * each.sums, times * each.products, times * each.quotients, times * each.roots};
  }
  friend Operations operator+(const Operations& a, const Operations& b) {
    return {a.sums + b.sums, a.products + b.products, a.quotients + b.quotients, a.roots + b.roots};
  }
};
inline Operations operations;  ///< since the last call of count()

struct Counted {
  double a = 0;
  Counted() = default;
  Counted(double value) : a(value) {}
  Counted& operator+=(const Counted& y) { return *this = Counted(counted(operations.sums, a + y.a)); }
  Counted& operator-=(const Counted& y) { return *this = Counted(counted(operations.sums, a - y.a)); }
  Counted& operator*=(const Counted& y) { return *this = Counted(counted(operations.products, a * y.a)); }
  friend Counted operator-(const Counted& x) { return {-x.a}; }
  friend Counted operator+(const Counted& x, const Counted& y) { return counted(operations.sums, x.a + y.a); }
  friend Counted operator-(const Counted& x, const Counted& y) { return counted(operations.sums, x.a - y.a); }
  friend Counted operator*(const Counted& x, const Counted& y) { return counted(operations.products, x.a * y.a); }
  friend Counted operator/(const Counted& x, const Counted& y) { return counted(operations.quotients, x.a / y.a); }
  friend bool operator<(const Counted& x, const Counted& y) { return x.a < y.a; }
  friend bool operator>(const Counted& x, const Counted& y) { return x.a > y.a; }
  friend bool operator<=(const Counted& x, const Counted& y) { return x.a <= y.a; }
  friend bool operator>=(const Counted& x, const Counted& y) { return x.a >= y.a; }

 private:
  static double counted(std::int64_t& kind, double value) {
    ++kind;
    return value;
  }
};

inline double value_of(const Counted& x) { return x.a; }
inline Counted sqrt(const Counted& x) {
  ++operations.roots;
  return {std::sqrt(x.a)};
}
// Portable functions count the operations of their power series (portable.hpp).
inline SinCosOf<Counted> sincos(const Counted& x) {
  operations.sums += 20;
  operations.products += 22;
  const auto [s, c] = portable::sincos(x.a);
  return {{s}, {c}};
}
inline Counted atan2(const Counted& y, const Counted& x) {
  operations.sums += 14;
  operations.products += 14;
  operations.quotients += 3;
  return {portable::atan2(y.a, x.a)};
}
inline Counted asin(const Counted& x) { return atan2(x, sqrt((1.0 - x) * (1.0 + x))); }
inline Counted acos(const Counted& x) { return atan2(sqrt((1.0 - x) * (1.0 + x)), x); }

/// Counts the operations of work().
template <class Work>
Operations count(const Work& work) {
  operations = {};
  work();
  return operations;
}

}  // namespace pkm::benchmarks
