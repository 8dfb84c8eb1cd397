// File images: several of them are open at once, as in a process that runs studies on several threads.
#include "engine/storage/hdf5_image.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace pkm {
namespace {

const Leaf kValues{.path = "/values", .description = "numbers"};

std::string image_of(double value) {
  ImageWriter image(0);
  image.group("/", "a file");
  image.array(kValues, std::vector<double>(3, value), {kAnyRows});
  return image.finish();
}

std::vector<double> values_of(const ImageReader& image) {
  std::vector<double> values;
  image.array(kValues, values, {kAnyRows});
  return values;
}

TEST(Hdf5Image, SeveralAreOpenAtOnce) {
  const ImageReader first(image_of(1), 1), second(image_of(2), 1);
  EXPECT_EQ(image_of(3), image_of(3));
  EXPECT_EQ(values_of(first), std::vector<double>(3, 1));
  EXPECT_EQ(values_of(second), std::vector<double>(3, 2));
}

TEST(Hdf5Image, ThreadsHaveTheirOwn) {
  std::vector<int> wrong(4);
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([i, &wrong] {
        const std::vector<double> expected(3, i);
        for (int round = 0; round < 100; ++round)
          wrong[static_cast<std::size_t>(i)] += values_of(ImageReader(image_of(i), 1)) != expected;
      });
  }
  EXPECT_EQ(wrong, std::vector<int>(4));
}

}  // namespace
}  // namespace pkm
