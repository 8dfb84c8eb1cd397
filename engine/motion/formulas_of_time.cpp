#include "engine/core/error.hpp"
#include "engine/math/taylor.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {
namespace {

/// The value of a formula at a time, with its derivatives.
Taylor at_time(const Formula& formula, double time) {
  const Taylor t = Taylor::variable(time);
  return formula.value(std::span<const Taylor>(&t, 1));
}

class FormulasOfTime final : public Motion {
 public:
  FormulasOfTime(std::vector<Formula> coordinates, double duration)
      : coordinates_(std::move(coordinates)), duration_(duration) {}

  double duration() const override { return duration_; }
  MotionSample at(double time) const override {
    MotionSample sample;
    sample.time = time;
    sample.pose = sample.velocity = sample.acceleration = AxisVector<double>(coordinates_.size());
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const Taylor x = at_time(coordinates_[i], time);
      sample.pose[i] = x.a;
      sample.velocity[i] = x.d;
      sample.acceleration[i] = x.dd;
    }
    return sample;
  }

 private:
  std::vector<Formula> coordinates_;
  double duration_;
};

class WithInput final : public Motion {
 public:
  WithInput(std::shared_ptr<const Motion> motion, const Formula& input) : motion_(std::move(motion)), input_(input) {}

  double duration() const override { return motion_->duration(); }
  MotionSample at(double time) const override {
    MotionSample sample = motion_->at(time);
    const Taylor input = at_time(input_, time);
    sample.input = {input.a, input.d, input.dd};
    return sample;
  }

 private:
  std::shared_ptr<const Motion> motion_;
  Formula input_;
};

}  // namespace

std::shared_ptr<const Motion> with_input(std::shared_ptr<const Motion> motion, const Formula& input) {
  return std::make_shared<WithInput>(std::move(motion), input);
}

std::shared_ptr<const Motion> formulas_of_time(std::vector<Formula> coordinates, double duration) {
  PKM_EXPECTS(duration > 0);
  return std::make_shared<FormulasOfTime>(std::move(coordinates), duration);
}

}  // namespace pkm
