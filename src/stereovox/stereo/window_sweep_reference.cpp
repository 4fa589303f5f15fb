#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>

#include "stereovox/stereo/multiple_windows.h"
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
using CostImage = std::vector<std::vector<Costs>>;

CostImage costs_of(const RectifiedPair& pair, int min_disparity_px, int candidates) {
  const cv::Size size = pair.left.pixels.size();
  CostImage costs(size.height, std::vector<Costs>(size.width, Costs(candidates)));
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      for (int c = 0; c < candidates; ++c)
        costs[y][x][c] = matching_cost_reference(pair, x, y, min_disparity_px + candidates - 1 - c);
  return costs;
}

struct Window {
  Costs sums;
  int area = 0;
};

Window window_at(const CostImage& costs, const Arms& arms, int x, int y) {
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

// The sum of one candidate's costs over the square about the pixel nearest to (x, y).
int box_at(const CostImage& costs, int half_px, int x, int y, int candidate) {
  const int height = static_cast<int>(costs.size()), width = static_cast<int>(costs[0].size());
  const auto inside = [](int i, int size) { return std::clamp(i, 0, size - 1); };
  x = inside(x, width);
  y = inside(y, height);
  int sum = 0;
  for (int dy = -half_px; dy <= half_px; ++dy)
    for (int dx = -half_px; dx <= half_px; ++dx)
      sum += costs[inside(y + dy, height)][inside(x + dx, width)][candidate];
  return sum;
}

Window supported_at(const CostImage& costs, const MultipleWindows& windows, int x, int y) {
  const int reach = windows.half_px, neighbours = number_of(windows.neighbours);
  const std::array<cv::Point, 8> directions = {
      {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {0, -1}, {0, 1}, {-1, 0}, {1, 0}}};
  Window window{Costs(costs[0][0].size()), windows.area()};
  for (int c = 0; c < static_cast<int>(window.sums.size()); ++c) {
    std::vector<int> beside;
    for (int n = 0; n < neighbours; ++n)
      beside.push_back(
          box_at(costs, reach, x + reach * directions[n].x, y + reach * directions[n].y, c));
    std::ranges::sort(beside);
    window.sums[c] = std::accumulate(beside.begin(), beside.begin() + neighbours / 2,
                                     box_at(costs, reach, x, y, c));
  }
  return window;
}

// Window of a pixel: window_of(x, y).
template <class WindowOf>
std::vector<WinnerRow> winners_of(const CostImage& costs, int first_row, int end_row,
                                  const WindowOf& window_of) {
  const int width = static_cast<int>(costs[0].size());
  const int candidates = static_cast<int>(costs[0][0].size());
  std::vector<WinnerRow> rows;
  for (int y = first_row; y < end_row; ++y) {
    rows.emplace_back(width);
    for (int x = 0; x < width; ++x) write_winner(window_of(x, y), x, rows.back());
    choose_locally_reference([&](int x, int c) { return costs[y][x][c]; }, candidates, rows.back());
  }
  return rows;
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
  const CostImage costs = costs_of(pair, min_disparity_px, candidates);
  return winners_of(costs, first_row, end_row,
                    [&](int x, int y) { return window_at(costs, arms, x, y); });
}

std::vector<WinnerRow> multiple_windows_reference(const RectifiedPair& pair,
                                                  const MultipleWindows& windows,
                                                  int min_disparity_px, int candidates,
                                                  int first_row, int end_row) {
  const CostImage costs = costs_of(pair, min_disparity_px, candidates);
  return winners_of(costs, first_row, end_row,
                    [&](int x, int y) { return supported_at(costs, windows, x, y); });
}

}  // namespace stereovox
