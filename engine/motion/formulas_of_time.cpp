#include "engine/core/error.hpp"
#include "engine/math/taylor.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {
namespace {

class FormulasOfTime final : public Motion {
 public:
  FormulasOfTime(const std::array<Formula, 4>& coordinates, double duration)
      : coordinates_(coordinates), duration_(duration) {}

  double duration() const override { return duration_; }
  MotionSample at(double time) const override {
    const Taylor t = Taylor::variable(time);
    MotionSample sample;
    sample.time = time;
    for (std::size_t i = 0; i < 4; ++i) {
      const Taylor x = coordinates_[i].value(std::span<const Taylor>(&t, 1));
      sample.pose[i] = x.a;
      sample.velocity[i] = x.d;
      sample.acceleration[i] = x.dd;
    }
    return sample;
  }

 private:
  std::array<Formula, 4> coordinates_;
  double duration_;
};

}  // namespace

std::shared_ptr<const Motion> formulas_of_time(const std::array<Formula, 4>& coordinates, double duration) {
  PKM_EXPECTS(duration > 0);
  return std::make_shared<FormulasOfTime>(coordinates, duration);
}

}  // namespace pkm
