// Times of repeated runs and their quantiles, for all benchmarks.
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace stereovox::bench {

inline double clock_ms(clockid_t clock) {
  constexpr double kMsPerS = 1e3, kMsPerNs = 1e-6;
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) * kMsPerS + static_cast<double>(now.tv_nsec) * kMsPerNs;
}

// Of all threads of this process.
inline double cpu_ms() { return clock_ms(CLOCK_PROCESS_CPUTIME_ID); }

inline double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * double(values.size())))];
}

inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

// Of each run of one body.
struct Times {
  std::vector<double> cpu_ms, wall_ms;
};

template <class Body>
void time(Times& times, Body body) {
  const double cpu = cpu_ms(), wall = clock_ms(CLOCK_MONOTONIC);
  body();
  times.cpu_ms.push_back(cpu_ms() - cpu);
  times.wall_ms.push_back(clock_ms(CLOCK_MONOTONIC) - wall);
}

}  // namespace stereovox::bench
