#include "stereovox/stereo/speckles.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

namespace stereovox {
namespace {

// Neighbouring pixels of a row that belong together.
struct Run {
  int begin, end;
};

// Union-find over runs.
class Islands {
 public:
  void add_run(int count) {
    parent_.push_back(static_cast<int>(parent_.size()));
    count_.push_back(count);
  }

  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    if (count_[a] < count_[b]) std::swap(a, b);
    parent_[b] = a;
    count_[a] += count_[b];
  }
  int count(int run) { return count_[root(run)]; }

 private:
  int root(int run) {
    while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
    return run;
  }

  std::vector<int> parent_, count_;
};

class Speckles {
 public:
  Speckles(cv::Mat1s& disparity, const cv::Mat1b& counts, int max_step)
      : disparity_(disparity), counts_(counts), max_step_(max_step), ends_(disparity.cols + 1) {}

  void remove(int min_count) {
    std::size_t first_above = 0, first_here = 0;
    for (int v = 0; v < disparity_.rows; ++v) {
      add_runs(v);
      if (v > 0) join_rows(v, first_above, first_here);
      first_above = first_here;
      first_here = runs_.size();
      row_ends_.push_back(first_here);
    }
    std::size_t i = 0;
    for (int v = 0; v < disparity_.rows; ++v)
      for (; i < row_ends_[v]; ++i)
        if (islands_.count(static_cast<int>(i)) < min_count)
          std::fill(disparity_[v] + runs_[i].begin, disparity_[v] + runs_[i].end, std::int16_t{0});
  }

 private:
  void add_runs(int v) {
    const std::int16_t* const row = disparity_[v];
    const std::uint8_t* const counts = counts_[v];
    const int width = disparity_.cols;
    for (int u = 1; u < width; ++u)
      ends_[u] = static_cast<char>((std::abs(row[u] - row[u - 1]) > max_step_) |
                                   ((row[u] > 0) != (row[u - 1] > 0)));
    ends_[width] = 1;
    for (int begin = 0, end = 0; begin < width; begin = end) {
      const void* const next = std::memchr(&ends_[begin + 1], 1, width - begin);
      end = static_cast<int>(static_cast<const char*>(next) - ends_.data());
      if (row[begin] <= 0) continue;
      runs_.push_back({begin, end});
      int count = 0;
      for (int u = begin; u < end; ++u) count += counts[u] != 0 ? 1 : 0;
      islands_.add_run(count);
    }
  }

  // Row v has the runs from `here` on, the row above those from `above` to `here`.
  void join_rows(int v, std::size_t above, std::size_t here) {
    const std::size_t end_above = here;
    while (above < end_above && here < runs_.size()) {
      const Run &a = runs_[above], &b = runs_[here];
      if (touch(v, std::max(a.begin, b.begin), std::min(a.end, b.end)))
        islands_.join(static_cast<int>(above), static_cast<int>(here));
      ++(a.end < b.end ? above : here);
    }
  }

  bool touch(int v, int begin, int end) const {
    const std::int16_t *const above = disparity_[v - 1], *const here = disparity_[v];
    for (int u = begin; u < end; ++u)
      if (std::abs(above[u] - here[u]) <= max_step_) return true;
    return false;
  }

  cv::Mat1s& disparity_;
  const cv::Mat1b& counts_;
  const int max_step_;
  std::vector<char> ends_;  // 1 where a run has ended before this pixel
  std::vector<Run> runs_;
  std::vector<std::size_t> row_ends_;  // of each row's runs
  Islands islands_;
};

}  // namespace

void remove_speckles(cv::Mat1s& disparity, const cv::Mat1b& counts, int min_count, int max_step) {
  Speckles(disparity, counts, max_step).remove(min_count);
}

}  // namespace stereovox
