// Minimum of a function of one variable: golden-section search.
//
// Reference: W. H. Press et al., "Numerical Recipes", 3rd ed., 2007, section 10.2.
#pragma once

namespace pkm {

/// Position of a local minimum of f between low and high. The value of f there is accurate to rounding errors, the
/// position only to about the square root of the relative rounding error.
/// @param width  absolute width of the bracket at which the search stops
/// @return the one of the two points inside the final bracket at which f is smaller
template <class F>
double golden_section(const F& f, double low, double high, double width) {
  constexpr double kGolden = 0.3819660112501051;  // (3 - sqrt 5) / 2
  constexpr int kMaxSteps = 200;                  // reduces any bracket of doubles by 41 decades
  double a = low + kGolden * (high - low), b = high - kGolden * (high - low);
  double f_a = f(a), f_b = f(b);
  for (int step = 0; step < kMaxSteps && high - low > width; ++step) {
    if (f_a < f_b) {
      high = b;
      b = a;
      f_b = f_a;
      a = low + kGolden * (high - low);
      f_a = f(a);
    } else {
      low = a;
      a = b;
      f_a = f_b;
      b = high - kGolden * (high - low);
      f_b = f(b);
    }
  }
  return f_a < f_b ? a : b;
}

}  // namespace pkm
