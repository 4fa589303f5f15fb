#include "stereovox/evaluation/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stereovox {
namespace {

constexpr double kClip = 0.01;  // one certain error must not decide the mean
constexpr int kBins = 10;

double squared_error(const JudgedCell& cell) {
  const double error = cell.value - (cell.is_occupied ? 1.0 : 0.0);
  return error * error;
}

double log_error(const JudgedCell& cell) {
  const double p = std::clamp(cell.value, kClip, 1.0 - kClip);
  return -std::log(cell.is_occupied ? p : 1.0 - p);
}

template <class Error>
double mean_error(const std::vector<JudgedCell>& cells, const Error& error) {
  double sum = 0.0;
  for (const JudgedCell& cell : cells) sum += error(cell);
  return sum / static_cast<double>(cells.size());
}

// Mann and Whitney's count of pairs in the right order.
std::optional<double> area_under_curve(std::vector<JudgedCell> cells) {
  std::ranges::sort(cells, {}, &JudgedCell::value);
  double free_below = 0.0, ordered_pairs = 0.0, occupied = 0.0;
  for (auto begin = cells.begin(); begin != cells.end();) {
    const auto end =
        std::ranges::upper_bound(begin, cells.end(), begin->value, {}, &JudgedCell::value);
    const auto here = static_cast<double>(
        std::count_if(begin, end, [](const JudgedCell& cell) { return cell.is_occupied; }));
    const double free_here = static_cast<double>(end - begin) - here;
    ordered_pairs += here * (free_below + free_here / 2.0);
    free_below += free_here;
    occupied += here;
    begin = end;
  }
  if (occupied == 0.0 || free_below == 0.0) return std::nullopt;
  return ordered_pairs / (occupied * free_below);
}

double expected_error(const std::vector<JudgedCell>& cells) {
  struct Bin {
    double values = 0, occupied = 0;
  };
  std::array<Bin, kBins> bins = {};
  for (const JudgedCell& cell : cells) {
    const int bin = std::clamp(static_cast<int>(cell.value * kBins), 0, kBins - 1);
    bins[static_cast<std::size_t>(bin)].values += cell.value;
    bins[static_cast<std::size_t>(bin)].occupied += cell.is_occupied ? 1.0 : 0.0;
  }
  double sum = 0.0;
  for (const Bin& bin : bins) sum += std::abs(bin.values - bin.occupied);
  return sum / static_cast<double>(cells.size());
}

}  // namespace

Calibration score_calibration(const std::vector<JudgedCell>& cells) {
  if (cells.empty()) return {};
  return {.cells = static_cast<std::int64_t>(cells.size()),
          .brier = mean_error(cells, squared_error),
          .log_loss = mean_error(cells, log_error),
          .auc = area_under_curve(cells),
          .expected_error = expected_error(cells)};
}

}  // namespace stereovox
