// The plain tests of what these loops compute stand beside their users; here, that the machine does
// not matter.
#include "stereovox/stereo/row_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace stereovox {
namespace {

constexpr int kPadding = 2 * kSmoothReach_px;

template <class T>
std::vector<T> random_row(int width, unsigned seed, int low, int high) {
  std::mt19937 random(seed);
  std::vector<T> row(width + kPadding);
  for (T& value : row)
    value =
        static_cast<T>(low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1)));
  return row;
}

// Everything that the kernels compute of random rows, one after the other.
std::vector<double> results(const RowKernels& kernels, int width) {
  std::array<std::vector<std::uint8_t>, 6> bytes;
  for (unsigned i = 0; i < bytes.size(); ++i)
    bytes[i] = random_row<std::uint8_t>(width, i, i % 2 == 0 ? 0 : 250, 255);
  std::vector<std::int16_t> disparity(width), low(width + 2), mid(width + 2), high(width + 2),
      median(width), mean(width);
  kernels.disparities({.candidate = bytes[0].data(),
                       .before = bytes[1].data(),
                       .here = bytes[2].data(),
                       .after = bytes[3].data()},
                      width, 300, disparity.data());
  std::vector<std::uint32_t> owner(width + 300);
  std::mt19937 random(9);
  for (std::uint32_t& o : owner) o = static_cast<std::uint32_t>(random() % 20000) + 32768;
  std::vector<std::uint8_t> left_right(width);
  kernels.left_right({.candidate = bytes[0].data(),
                      .disparity = disparity.data(),
                      .owners = owner.data() + 1,
                      .max_disparity_px = 300,
                      .max_difference = 128},
                     width, left_right.data());
  constexpr int kCandidates = 32;
  const auto costs = random_row<std::uint8_t>(width * kCandidates, 10, 0, 255);
  const auto winners = random_row<std::uint8_t>(width, 11, 0, kCandidates - 1);
  std::vector<std::uint16_t> along(2 * kCandidates);
  kernels.along_surface(costs.data(), kCandidates, winners.data(), width, 3, along.data());
  std::array<std::vector<std::int16_t>, kSmoothMembers> rows;
  std::array<const std::int16_t*, kSmoothMembers> members = {};
  for (unsigned i = 0; i < rows.size(); ++i) {
    rows[i] = random_row<std::int16_t>(width, i, -100, 100);
    members[i] = rows[i].data();
  }
  const SortedRows sorted = {low.data(), mid.data(), high.data()};
  kernels.sort_columns(members[0], members[1], disparity.data(), width, sorted);
  kernels.medians(sorted, width, median.data());
  kernels.means(members.data(), width, mean.data());
  std::vector<std::uint32_t> sum(width + kPadding, 3), square_sum(width + kPadding, 1000);
  kernels.moments(members.data(), width, sum.data(), square_sum.data());
  std::vector<float> variance_px2(width);
  kernels.variances(sum.data(), square_sum.data(), width, variance_px2.data());
  std::vector<std::uint8_t> level(width);
  kernels.levels({.log_ratio = bytes[0].data(),
                  .left_right = bytes[2].data(),
                  .local_cost = bytes[4].data(),
                  .variance_px2 = variance_px2.data(),
                  .bias = 80.3F,
                  .of_log_ratio = 0.61F,
                  .of_left_right = -0.37F,
                  .of_local_cost = -0.83F,
                  .of_variance = -7.7F,
                  .max_level = 254},
                 width, level.data());
  std::vector<std::int16_t> passed(width);
  std::vector<std::uint8_t> is_sure(width);
  const std::vector<std::uint8_t> white(width, 255);
  kernels.judge({.disparity = members[0],
                 .gray_above = white.data(),
                 .gray = bytes[3].data(),
                 .gray_below = white.data(),
                 .log_ratio = bytes[0].data(),
                 .left_right = bytes[1].data(),
                 .level = bytes[2].data(),
                 .min_log_ratio = 20,
                 .max_left_right = 200,
                 .min_level = 10,
                 .sure_level = 128},
                width, passed.data(), is_sure.data());
  kernels.keep_seen(width, passed.data());
  std::array<std::vector<std::int16_t>, kMedianSide_px> disparities;
  std::array<std::vector<std::uint8_t>, kMedianSide_px> grays;
  MedianRows square = {.contrast_gray = 200};
  const int padded_width = width + 2 * kMedianReach_px + kMedianSlack;
  for (unsigned i = 0; i < disparities.size(); ++i) {
    disparities[i] = random_row<std::int16_t>(padded_width, i, -100, 800);
    grays[i] = random_row<std::uint8_t>(padded_width, i, 0, 255);
    square.disparity[i] = disparities[i].data();
    square.gray[i] = grays[i].data();
  }
  std::vector<std::int16_t> settled(width);
  kernels.edge_medians(square, width, settled.data());
  std::vector<double> all;
  const auto append = [&](const auto& row) { all.insert(all.end(), row.begin(), row.end()); };
  append(disparity);
  append(left_right);
  append(along);
  append(median);
  append(mean);
  append(settled);
  append(variance_px2);
  append(level);
  append(passed);
  append(is_sure);
  return all;
}

void expect_same_as_portable(const RowKernels* kernels) {
  if (kernels == nullptr) GTEST_SKIP() << "this machine does not have these instructions";
  for (const int width : {1, 2, 15, 16, 17, 63, 640, 1001})
    EXPECT_EQ(results(*kernels, width), results(portable_row_kernels(), width)) << width;
}

TEST(RowKernels, GiveTheSameWithAvx2) { expect_same_as_portable(avx2_row_kernels()); }

TEST(RowKernels, GiveTheSameWithAvx512) { expect_same_as_portable(avx512_row_kernels()); }

}  // namespace
}  // namespace stereovox
