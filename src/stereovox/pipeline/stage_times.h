// How long the stages take, frame by frame.
#pragma once

#include <array>
#include <chrono>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace stereovox {

// In the order in which a frame passes through them.
inline constexpr std::array<const char*, 6> kStages = {"rectify", "disparity", "odometry",
                                                       "store",   "occupancy", "navmap"};

struct Duration {
  double wall_ms = 0.0, cpu_ms = 0.0;  // cpu: of the calling thread
};

class Stopwatch {
 public:
  Stopwatch();
  Duration elapsed() const;

 private:
  std::chrono::steady_clock::time_point start_;
  double cpu_start_ms_;
};

// Calls `work`, adds the time it took to `duration`, and returns what it returned.
template <class Work>
auto timed(Duration& duration, Work&& work) {
  const Stopwatch watch;
  auto result = std::forward<Work>(work)();
  const Duration elapsed = watch.elapsed();
  duration.wall_ms += elapsed.wall_ms;
  duration.cpu_ms += elapsed.cpu_ms;
  return result;
}

struct StageSummary {
  double median_ms = 0.0, p95_ms = 0.0, cpu_ms = 0.0;  // per frame; cpu is the mean
  std::size_t calls = 0;
};

class StageTimes {
 public:
  void add(const std::string& stage, const Duration& duration) {
    times_[stage].push_back(duration);
  }
  StageSummary summary(const std::string& stage) const;

 private:
  std::map<std::string, std::vector<Duration>> times_;
};

}  // namespace stereovox
