#include "stereovox/core/parallel.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace stereovox {
namespace {

TEST(ParallelFor, VisitsEachItemOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3, 8}) {
    std::vector<int> visits(1000, 0);
    parallel_for(10, 1000, threads, [&](int i) { ++visits[static_cast<std::size_t>(i)]; });
    EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), 0), 990) << threads << " threads";
    EXPECT_EQ(visits[9], 0);
    EXPECT_EQ(visits[10], 1);
  }
}

TEST(ParallelFor, PassesExceptionsOn) {
  EXPECT_THROW(parallel_for(0, 4, 2, [](int) { throw std::runtime_error("x"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace stereovox
