#include "stereovox/stereo/speckles.h"

#include <cmath>
#include <utility>
#include <vector>

namespace stereovox {
namespace {

constexpr int kNoRun = -1;

// Union-find over runs: neighbouring pixels of a row that belong together.
class Islands {
 public:
  int add_run() {
    parent_.push_back(static_cast<int>(parent_.size()));
    size_px_.push_back(0);
    return parent_.back();
  }
  void add_pixels(int run, int count) { size_px_[run] += count; }

  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    if (size_px_[a] < size_px_[b]) std::swap(a, b);
    parent_[b] = a;
    size_px_[a] += size_px_[b];
  }
  int size_px(int run) { return size_px_[root(run)]; }

 private:
  int root(int run) {
    while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
    return run;
  }

  std::vector<int> parent_, size_px_;
};

bool belong_together(float a_px, float b_px, float max_step_px) {
  return a_px > 0.0F && b_px > 0.0F && std::abs(a_px - b_px) <= max_step_px;
}

void find_runs(const float* disparity_px, int width, float max_step_px, int* run_of,
               Islands& islands) {
  int begin = 0;
  for (int u = 1; u <= width; ++u) {
    if (u < width && belong_together(disparity_px[u - 1], disparity_px[u], max_step_px)) continue;
    const bool is_none = !(disparity_px[begin] > 0.0F);
    const int run = is_none ? kNoRun : islands.add_run();
    if (!is_none) islands.add_pixels(run, u - begin);
    std::fill(run_of + begin, run_of + u, run);
    begin = u;
  }
}

void join_rows(const float* above_px, const float* here_px, int width, float max_step_px,
               const int* runs_above, const int* runs_here, Islands& islands) {
  std::pair<int, int> joined = {kNoRun, kNoRun};
  for (int u = 0; u < width; ++u) {
    const std::pair<int, int> runs = {runs_above[u], runs_here[u]};
    if (runs == joined || !belong_together(above_px[u], here_px[u], max_step_px)) continue;
    islands.join(runs.first, runs.second);
    joined = runs;
  }
}

}  // namespace

void remove_speckles(cv::Mat1f& disparity_px, int min_size_px, float max_step_px) {
  const int width = disparity_px.cols;
  cv::Mat1i run_of(disparity_px.size());
  Islands islands;
  for (int v = 0; v < disparity_px.rows; ++v) {
    find_runs(disparity_px[v], width, max_step_px, run_of[v], islands);
    if (v > 0)
      join_rows(disparity_px[v - 1], disparity_px[v], width, max_step_px, run_of[v - 1], run_of[v],
                islands);
  }
  for (int v = 0; v < disparity_px.rows; ++v)
    for (int u = 0, run = kNoRun, size_px = 0; u < width; ++u) {
      if (run_of(v, u) == kNoRun) continue;
      if (std::exchange(run, run_of(v, u)) != run) size_px = islands.size_px(run);
      if (size_px < min_size_px) disparity_px(v, u) = 0.0F;
    }
}

}  // namespace stereovox
