#include "stereovox/evaluation/error_statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace stereovox {
namespace {

TEST(ErrorStatistics, AreThoseOfAListWorkedOutByHand) {
  const ErrorStatistics s = statistics_of(std::array{4.0, 1.0, 3.0, 2.0});
  EXPECT_EQ(s.count, 4);
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 4.0);
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.sse, 30.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
}

TEST(ErrorStatistics, TheMedianOfAnOddCountIsItsMiddle) {
  EXPECT_DOUBLE_EQ(statistics_of(std::array{9.0, 1.0, 2.0}).median, 2.0);
}

TEST(ErrorStatistics, OfNothingCountNothing) { EXPECT_EQ(statistics_of({}).count, 0); }

}  // namespace
}  // namespace stereovox
