#include "engine/math/quadratic_program.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/eigen_solvers.hpp"

namespace pkm {
namespace {

/// Largest step in (0, 1] along `change` that keeps `value` nonnegative.
double max_step(const Eigen::VectorXd& value, const Eigen::VectorXd& change) {
  double step = 1;
  for (Eigen::Index i = 0; i < value.size(); ++i)
    if (change[i] < 0) step = std::min(step, -value[i] / change[i]);
  return step;
}

}  // namespace

QuadraticSolution solve(const QuadraticProgram& program) {
  constexpr int kMaxIterations = 60;
  // Upper limits of the mean complementarity product and of the residuals at the solution; most programs reach them in
  // 10 to 25 iterations.
  constexpr double kGap = 1e-17, kResidual = 1e-14;
  const Eigen::MatrixXd &B = program.B, &A = program.A;
  const Eigen::VectorXd &c = program.c, &b = program.b;
  const Eigen::Index n = c.size(), m = b.size();
  if (m == 0) return {B.ldlt().solve(-c), {}};
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n), slack = (-b).cwiseMax(1), multipliers = Eigen::VectorXd::Ones(m);
  QuadraticSolution best;
  double min_error = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Eigen::VectorXd dual = B * x + c - A.transpose() * multipliers, primal = A * x - slack - b;
    const double gap = slack.dot(multipliers) / static_cast<double>(m);
    const double residual = std::max(dual.lpNorm<Eigen::Infinity>(), primal.lpNorm<Eigen::Infinity>());
    if (const double error = std::max(gap, residual); error < min_error) {
      min_error = error;
      best = {x, multipliers};
    } else if (gap < kGap) {
      break;  // stop, because from here on rounding errors only increase the error of the iterates
    }
    if (gap < kGap && residual < kResidual) break;
    const Eigen::VectorXd ratio = multipliers.cwiseQuotient(slack);
    // lazyProduct() avoids the blocking that Eigen uses for large matrices, because these matrices are small.
    const Eigen::LDLT<Eigen::MatrixXd> matrix((B + A.transpose().lazyProduct((ratio.asDiagonal() * A).eval())).eval());
    Eigen::VectorXd dx, dslack, dmultipliers;
    const auto step_for = [&](const Eigen::VectorXd& complementarity) {
      dx = matrix.solve(-dual - A.transpose() *
                                    (complementarity + multipliers.cwiseProduct(primal)).cwiseQuotient(slack).eval());
      dslack = A * dx + primal;
      dmultipliers = -(complementarity + multipliers.cwiseProduct(dslack)).cwiseQuotient(slack);
    };
    const Eigen::VectorXd product = slack.cwiseProduct(multipliers);
    step_for(product);
    const double predicted = std::min(max_step(slack, dslack), max_step(multipliers, dmultipliers));
    const double gap_after =
        (slack + predicted * dslack).dot(multipliers + predicted * dmultipliers) / static_cast<double>(m);
    const double centring = std::pow(gap_after / gap, 3);
    step_for(product + dslack.cwiseProduct(dmultipliers) - Eigen::VectorXd::Constant(m, centring * gap));
    if (!dx.allFinite() || !dmultipliers.allFinite()) break;
    constexpr double kFraction = 0.995;  // fraction of the step at which the first slack or multiplier would become 0
    const double step = kFraction * std::min(max_step(slack, dslack), max_step(multipliers, dmultipliers));
    x += step * dx;
    slack += step * dslack;
    multipliers += step * dmultipliers;
  }
  return best;
}

}  // namespace pkm
