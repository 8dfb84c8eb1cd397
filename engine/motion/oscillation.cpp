#include "engine/core/error.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {
namespace {

class Oscillation final : public Motion {
 public:
  Oscillation(const Vector<double, 4>& centre, double amplitude, double period, double cycles)
      : centre_(centre), amplitude_(amplitude), rate_(2 * kPi / period), end_(cycles * period) {}

  double duration() const override { return end_; }
  MotionSample at(double time) const override {
    const auto [s, c] = sincos(rate_ * time);
    const double A = amplitude_, v = A * rate_, a = v * rate_;
    return {time,
            centre_ + Vector<double, 4>{{A * s, A * c, A * s, 0}},
            {{v * c, -v * s, v * c, 0}},
            {{-a * s, -a * c, -a * s, 0}}};
  }

 private:
  Vector<double, 4> centre_;
  double amplitude_, rate_, end_;
};

}  // namespace

std::shared_ptr<const Motion> oscillation(const Vector<double, 4>& centre, double amplitude, double period,
                                          double cycles) {
  PKM_EXPECTS(period > 0 && cycles > 0);
  return std::make_shared<Oscillation>(centre, amplitude, period, cycles);
}

}  // namespace pkm
