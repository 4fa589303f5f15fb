#include <algorithm>
#include <array>
#include <cstdlib>

#include "stereovox/stereo/window_sweep.h"

namespace stereovox {
namespace {

int median_about(const cv::Mat1b& image, int x, int y) {
  std::array<int, 9> values = {};
  for (int i = 0; i < 9; ++i) values[i] = nearest_pixel(image, x + i % 3 - 1, y + i / 3 - 1);
  std::ranges::sort(values);
  return values[4];
}

bool is_inside(const cv::Mat1b& image, int x, int y) {
  return x >= 0 && y >= 0 && x < image.cols && y < image.rows;
}

std::uint8_t arm(const cv::Mat1b& calm, int x, int y, int dx, int dy, const ArmParams& params) {
  int reach_px = 0;
  for (int k = 1; k <= params.max_arm_px && is_inside(calm, x + k * dx, y + k * dy); ++k) {
    const int step = std::abs(calm(y + k * dy, x + k * dx) - calm(y, x));
    if (step > params.contrast_gray) break;
    reach_px = k;
  }
  if (reach_px == 0 && is_inside(calm, x + dx, y + dy)) reach_px = 1;
  return static_cast<std::uint8_t>(reach_px);
}

using Costs = std::vector<int>;  // of the candidates of one pixel

struct Window {
  Costs sums;
  int area = 0;
};

Window window_at(const std::vector<std::vector<Costs>>& costs, const Arms& arms, int x, int y) {
  Window window{Costs(costs[0][0].size()), 0};
  for (int v = y - arms.up(y, x); v <= y + arms.down(y, x); ++v)
    for (int u = x - arms.left(v, x); u <= x + arms.right(v, x); ++u) {
      for (std::size_t c = 0; c < window.sums.size(); ++c) window.sums[c] += costs[v][u][c];
      ++window.area;
    }
  return window;
}

void write_winner(const Window& window, int x, WinnerRow& out) {
  const Costs& sums = window.sums;
  const int count = static_cast<int>(sums.size());
  const int best = static_cast<int>(std::ranges::min_element(sums) - sums.begin());
  const auto mean = [&](int c) {
    return static_cast<std::uint8_t>((sums[c] * kMeanCostSteps + window.area / 2) / window.area);
  };
  int second = -1;
  for (int c = 0; c < count; ++c)
    if (std::abs(c - best) > 1 && (second < 0 || sums[c] < sums[second])) second = c;
  out.candidate[x] = static_cast<std::uint8_t>(best);
  out.cost[x] = mean(best);
  out.second[x] = mean(second);
}

}  // namespace

Arms arms_reference(const cv::Mat1b& image, const ArmParams& params) {
  const cv::Size size = image.size();
  cv::Mat1b calm(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      calm(y, x) = static_cast<std::uint8_t>(median_about(image, x, y));
  Arms arms{cv::Mat1b(size), cv::Mat1b(size), cv::Mat1b(size), cv::Mat1b(size), params.max_arm_px};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      arms.left(y, x) = arm(calm, x, y, -1, 0, params);
      arms.right(y, x) = arm(calm, x, y, 1, 0, params);
      arms.up(y, x) = arm(calm, x, y, 0, -1, params);
      arms.down(y, x) = arm(calm, x, y, 0, 1, params);
    }
  return arms;
}

std::vector<WinnerRow> windows_reference(const RectifiedPair& pair, const Arms& arms,
                                         int min_disparity_px, int candidates, int first_row,
                                         int end_row) {
  const cv::Size size = pair.left.pixels.size();
  std::vector<std::vector<Costs>> costs(size.height,
                                        std::vector<Costs>(size.width, Costs(candidates)));
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      for (int c = 0; c < candidates; ++c)
        costs[y][x][c] = matching_cost_reference(pair, x, y, min_disparity_px + candidates - 1 - c);
  std::vector<WinnerRow> rows;
  for (int y = first_row; y < end_row; ++y) {
    rows.emplace_back(size.width);
    for (int x = 0; x < size.width; ++x) write_winner(window_at(costs, arms, x, y), x, rows.back());
    choose_locally_reference([&](int x, int c) { return costs[y][x][c]; }, candidates, rows.back());
  }
  return rows;
}

}  // namespace stereovox
