#include "engine/math/random.hpp"

#include <Random123/philox.h>

#include <cmath>

#include "engine/math/portable.hpp"

namespace pkm {
namespace {
using Philox = r123::Philox4x32;
}

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  const Philox::ctr_type block = Philox()({{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
  return {block[0], block[1], block[2], block[3]};
}

void Stream::refill() {
  const Philox::key_type key = {{static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)}};
  for (std::size_t i = 0; i < words_.size(); i += 4) {
    const Philox::ctr_type block =
        Philox()({{block_++, static_cast<std::uint32_t>(use_), individual_, generation_}}, key);
    for (std::size_t k = 0; k < 4; ++k) words_[i + k] = block[k];
  }
  next_ = 0;
}

double Stream::normal() {
  if (has_second_normal_) {
    has_second_normal_ = false;
    return second_normal_;
  }
  const double radius = std::sqrt(-2.0 * portable::log(1.0 - u01()));
  const auto [sine, cosine] = portable::sincos(2.0 * kPi * u01());
  second_normal_ = radius * sine;
  has_second_normal_ = true;
  return radius * cosine;
}

}  // namespace pkm
