#include <algorithm>
#include <bit>
#include <cstdlib>

#include "stereovox/stereo/census_sweep.h"

namespace stereovox {
namespace {

constexpr int kFarthest = 255;  // sums end here

int pixel(const cv::Mat1b& image, int x, int y) {
  return image(std::clamp(y, 0, image.rows - 1), std::clamp(x, 0, image.cols - 1));
}

// A pixel outside the image has the census of the nearest one inside.
std::uint32_t census(const cv::Mat1b& image, int x, int y) {
  x = std::clamp(x, 0, image.cols - 1);
  std::uint32_t word = 0;
  int k = 0;
  for (int dy = -kCensusHalfHeight_px; dy <= 0; ++dy)
    for (int dx = -kCensusHalfWidth_px; dx <= kCensusHalfWidth_px; ++dx) {
      if (dy == 0 && dx >= 0) break;
      const bool is_set = pixel(image, x + dx, y + dy) >= pixel(image, x - dx, y - dy);
      word |= static_cast<std::uint32_t>(is_set) << k++;
    }
  return word;
}

int mean(int a, int b) { return (a + b + 1) / 2; }

// Clipped change of brightness along the row, smoothed across it.
int slope(const cv::Mat1b& image, int x, int y) {
  x = std::clamp(x, 0, image.cols - 1);
  const auto smooth = [&](int column) {
    return mean(pixel(image, column, y),
                mean(pixel(image, column, y - 1), pixel(image, column, y + 1)));
  };
  return std::clamp(smooth(x + 1) - smooth(x - 1), -kMaxSlope_gray, kMaxSlope_gray);
}

using Costs = std::vector<int>;  // of the candidates of one pixel

class Reference {
 public:
  Reference(const RectifiedPair& pair, const SweepParams& params, int first_row, int end_row)
      : left_(pair.left.pixels),
        right_(pair.right.pixels),
        params_(params),
        first_row_(first_row),
        end_row_(end_row) {
    for (int y = first_row; y < end_row; ++y)
      for (int x = 0; x < left_.cols; ++x)
        for (int c = 0; c < params.candidates; ++c) costs_.push_back(matching_cost(x, y, c));
  }

  std::vector<WinnerRow> winners() const {
    std::vector<std::vector<Costs>> sums(end_row_ - first_row_,
                                         std::vector<Costs>(left_.cols, Costs(params_.candidates)));
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {0, -1}, {-1, -1}, {1, -1}, {1, 0}})
      add_path(dx, dy, sums);
    std::vector<WinnerRow> rows;
    for (int y = first_row_; y < end_row_; ++y) {
      rows.push_back(winners_of(sums[y - first_row_]));
      for (int x = 0; x < left_.cols; ++x) choose_locally(x, y, rows.back());
    }
    return rows;
  }

 private:
  int matching_cost(int x, int y, int candidate) const {
    const int x_right = x - params_.max_disparity_px() + candidate;
    const int ones = std::popcount(census(left_, x, y) ^ census(right_, x_right, y));
    const int slopes = std::abs(slope(left_, x, y) - slope(right_, x_right, y));
    return mean(ones, std::min(kSlopeWeight * slopes, kMaxSlopeCost));
  }

  int cost(int x, int y, int candidate) const {
    return costs_[((y - first_row_) * left_.cols + x) * params_.candidates + candidate];
  }

  // Each pixel's path comes from (x + dx, y + dy).
  void add_path(int dx, int dy, std::vector<std::vector<Costs>>& sums) const {
    std::vector<std::vector<Costs>> path(sums.size(), std::vector<Costs>(left_.cols));
    for (int y = first_row_; y < end_row_; ++y)
      for (int i = 0; i < left_.cols; ++i) {
        const int x = dx > 0 && dy == 0 ? left_.cols - 1 - i : i;
        const bool starts = x + dx < 0 || x + dx >= left_.cols || y + dy < first_row_;
        const Costs before =
            starts ? Costs(params_.candidates, 0) : path[y + dy - first_row_][x + dx];
        const int step = std::abs(pixel(left_, x, y) - pixel(left_, x + dx, y + dy));
        path[y - first_row_][x] = next_on_path(before, x, y, params_.large_penalty[step]);
        for (int c = 0; c < params_.candidates; ++c)
          sums[y - first_row_][x][c] += path[y - first_row_][x][c];
      }
  }

  // The recursion of semi-global matching, eq. (13) of Hirschmueller (PAMI 2008).
  Costs next_on_path(const Costs& before, int x, int y, int large_penalty) const {
    const int smallest = std::ranges::min(before), count = params_.candidates;
    Costs next(count);
    for (int c = 0; c < count; ++c) {
      int best = std::min(before[c], smallest + large_penalty);
      if (c > 0) best = std::min(best, before[c - 1] + params_.small_penalty);
      if (c + 1 < count) best = std::min(best, before[c + 1] + params_.small_penalty);
      next[c] = cost(x, y, c) + best - smallest;
    }
    return next;
  }

  WinnerRow winners_of(const std::vector<Costs>& sums) const {
    WinnerRow row(left_.cols);
    const auto limited = [](int sum) {
      return static_cast<std::uint8_t>(std::min(sum, kFarthest));
    };
    for (int x = 0; x < left_.cols; ++x) {
      Costs sum = sums[x];
      for (int& s : sum) s = limited(s);
      const int count = params_.candidates;
      const int best = static_cast<int>(std::ranges::min_element(sum) - sum.begin());
      int second = kFarthest;
      for (int c = 0; c < count; ++c)
        if (std::abs(c - best) > 1) second = std::min(second, sum[c]);
      row.candidate[x] = static_cast<std::uint8_t>(best);
      row.cost[x] = limited(sum[best]);
      row.second[x] = limited(second);
    }
    return row;
  }

  int local_cost(int x, int y, int candidate) const {
    if (candidate < 0 || candidate >= params_.candidates) return kNoLocalCost;
    int sum = 0;
    for (int dx = -kLocalWidth_px / 2; dx <= kLocalWidth_px / 2; ++dx)
      sum += cost(std::clamp(x + dx, 0, left_.cols - 1), y, candidate);
    return sum;
  }

  void choose_locally(int x, int y, WinnerRow& row) const {
    const int winner = row.candidate[x];
    int best = winner;
    for (const int c : {winner - 1, winner + 1})
      if (local_cost(x, y, c) < local_cost(x, y, best)) best = c;
    row.candidate[x] = static_cast<std::uint8_t>(best);
    row.local_before[x] = static_cast<std::uint8_t>(local_cost(x, y, best - 1));
    row.local[x] = static_cast<std::uint8_t>(local_cost(x, y, best));
    row.local_after[x] = static_cast<std::uint8_t>(local_cost(x, y, best + 1));
  }

  const cv::Mat1b left_, right_;
  const SweepParams params_;
  const int first_row_, end_row_;
  std::vector<int> costs_;  // of each pixel's candidates
};

}  // namespace

std::vector<WinnerRow> sweep_reference(const RectifiedPair& pair, const SweepParams& params,
                                       int first_row, int end_row) {
  return Reference(pair, params, first_row, end_row).winners();
}

}  // namespace stereovox
