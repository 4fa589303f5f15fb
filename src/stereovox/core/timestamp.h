// Time stamps are int64 nanoseconds, in names `stamp_ns`; the epoch is the data set's own.
#pragma once

#include <cmath>
#include <cstdint>

namespace stereovox {

inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

inline double seconds_from_ns(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) / static_cast<double>(kNanosecondsPerSecond);
}

inline std::int64_t ns_from_seconds(double duration_s) {
  return std::llround(duration_s * static_cast<double>(kNanosecondsPerSecond));
}

}  // namespace stereovox
