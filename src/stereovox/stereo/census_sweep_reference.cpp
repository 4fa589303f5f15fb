#include <algorithm>
#include <cstdlib>

#include "stereovox/stereo/census_sweep.h"
#include "stereovox/stereo/row_kernels.h"

namespace stereovox {
namespace {

constexpr int kFarthest = 255;  // sums end here

using Costs = std::vector<int>;  // of the candidates of one pixel

class Reference {
 public:
  Reference(const RectifiedPair& pair, const SweepParams& params, int first_row, int end_row)
      : left_(pair.left.pixels), params_(params), first_row_(first_row), end_row_(end_row) {
    for (int y = first_row; y < end_row; ++y)
      for (int x = 0; x < left_.cols; ++x)
        for (int c = 0; c < params.candidates; ++c)
          costs_.push_back(matching_cost_reference(pair, x, y, params.max_disparity_px() - c));
  }

  std::vector<WinnerRow> winners() const {
    std::vector<std::vector<Costs>> sums(end_row_ - first_row_,
                                         std::vector<Costs>(left_.cols, Costs(params_.candidates)));
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {0, -1}, {-1, -1}, {1, -1}, {1, 0}})
      add_path(dx, dy, sums);
    std::vector<WinnerRow> rows;
    for (int y = first_row_; y < end_row_; ++y) {
      rows.push_back(winners_of(sums[y - first_row_]));
      const CostAt of_row = [&](int x, int c) { return cost(x, y, c); };
      choose_locally_reference(of_row, params_.candidates, rows.back());
      doubt_repetitions_reference(of_row, params_.candidates, rows.back());
    }
    return rows;
  }

 private:
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
        const int step =
            std::abs(nearest_pixel(left_, x, y) - nearest_pixel(left_, x + dx, y + dy));
        path[y - first_row_][x] =
            next_on_path(before, x, y, dy < 0 ? params_.nearer_penalty : params_.small_penalty,
                         params_.large_penalty[std::min(step, kPenaltySteps - 1)]);
        for (int c = 0; c < params_.candidates; ++c)
          sums[y - first_row_][x][c] += path[y - first_row_][x][c];
      }
  }

  // The recursion of semi-global matching, eq. (13) of Hirschmueller (PAMI 2008).
  Costs next_on_path(const Costs& before, int x, int y, int nearer_penalty,
                     int large_penalty) const {
    const int smallest = std::ranges::min(before), count = params_.candidates;
    Costs next(count);
    for (int c = 0; c < count; ++c) {
      int best = std::min(before[c], smallest + large_penalty);
      if (c > 0) best = std::min(best, before[c - 1] + params_.small_penalty);
      if (c + 1 < count) best = std::min(best, before[c + 1] + nearer_penalty);
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

  const cv::Mat1b left_;
  const SweepParams params_;
  const int first_row_, end_row_;
  std::vector<int> costs_;  // of each pixel's candidates
};

int local_cost(const CostAt& cost, int x, int candidate, int width_px, int candidates) {
  if (candidate < 0 || candidate >= candidates) return kNoLocalCost;
  int sum = 0;
  for (int dx = -kLocalWidth_px / 2; dx <= kLocalWidth_px / 2; ++dx)
    sum += cost(std::clamp(x + dx, 0, width_px - 1), candidate);
  return sum;
}

}  // namespace

void choose_locally_reference(const CostAt& cost, int candidates, WinnerRow& row) {
  const int width = static_cast<int>(row.candidate.size());
  for (int x = 0; x < width; ++x) {
    const auto local = [&](int c) { return local_cost(cost, x, c, width, candidates); };
    const int winner = row.candidate[x];
    int best = winner;
    for (const int c : {winner - 1, winner + 1})
      if (local(c) < local(best)) best = c;
    row.candidate[x] = static_cast<std::uint8_t>(best);
    row.local_before[x] = static_cast<std::uint8_t>(local(best - 1));
    row.local[x] = static_cast<std::uint8_t>(local(best));
    row.local_after[x] = static_cast<std::uint8_t>(local(best + 1));
  }
}

void doubt_repetitions_reference(const CostAt& cost, int candidates, WinnerRow& row) {
  const int width = static_cast<int>(row.candidate.size());
  for (int x = 0; x < width; ++x)
    for (int c = 0; c < candidates; ++c)
      if (row.local[x] == 0 && std::abs(c - row.candidate[x]) > kChoiceReach &&
          local_cost(cost, x, c, width, candidates) == 0)
        row.second[x] = row.cost[x];
}

std::vector<WinnerRow> sweep_reference(const RectifiedPair& pair, const SweepParams& params,
                                       int first_row, int end_row) {
  return Reference(pair, params, first_row, end_row).winners();
}

}  // namespace stereovox
