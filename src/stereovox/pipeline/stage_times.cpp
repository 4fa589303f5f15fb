#include "stereovox/pipeline/stage_times.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace stereovox {
namespace {

double thread_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double quantile(const std::vector<double>& sorted, double fraction) {
  const double position = fraction * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(position))];
}

}  // namespace

Stopwatch::Stopwatch() : start_(std::chrono::steady_clock::now()), cpu_start_ms_(thread_cpu_ms()) {}

Duration Stopwatch::elapsed() const {
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start_;
  return {wall.count(), thread_cpu_ms() - cpu_start_ms_};
}

StageSummary StageTimes::summary(const std::string& stage) const {
  const auto found = times_.find(stage);
  if (found == times_.end()) return {};
  std::vector<double> wall_ms;
  double cpu_ms = 0.0;
  for (const Duration& duration : found->second) {
    wall_ms.push_back(duration.wall_ms);
    cpu_ms += duration.cpu_ms;
  }
  std::ranges::sort(wall_ms);
  return {quantile(wall_ms, 0.5), quantile(wall_ms, 0.95),
          cpu_ms / static_cast<double>(wall_ms.size()), wall_ms.size()};
}

}  // namespace stereovox
