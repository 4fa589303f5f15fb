#include "stereovox/navmap/distance_field.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>

namespace stereovox {
namespace {

constexpr int kNoRow = -1;

// For each cell the row of the nearest site in its column, or kNoRow.
std::vector<int> nearest_rows(const CellMask& sites) {
  const int width = sites.geometry.width, height = sites.geometry.height;
  std::vector<int> rows(sites.cells.size(), kNoRow);
  const auto row = [&](int x, int y) -> int& {
    return rows[static_cast<std::size_t>(y * width + x)];
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      row(x, y) = sites.has(y * width + x) ? y : y > 0 ? row(x, y - 1) : kNoRow;
  for (int y = height - 2; y >= 0; --y)
    for (int x = 0; x < width; ++x) {
      const int above = row(x, y + 1);
      if (above != kNoRow && (row(x, y) == kNoRow || above - y < y - row(x, y))) row(x, y) = above;
    }
  return rows;
}

std::int64_t floor_quotient(std::int64_t a, std::int64_t positive) {
  return a >= 0 ? a / positive : -((-a + positive - 1) / positive);
}

// A site of the row's lower envelope: it is nearest from cell `begin` on.
struct Reign {
  std::int64_t x = 0, squared_rows = 0, begin = 0;
};

// The first cell that is nearer to `later` than to `earlier`, which lies to its left.
std::int64_t takeover(const Reign& earlier, const Reign& later) {
  const std::int64_t difference =
      later.x * later.x - earlier.x * earlier.x + later.squared_rows - earlier.squared_rows;
  return floor_quotient(difference, 2 * (later.x - earlier.x)) + 1;
}

std::vector<Reign> envelope_of(std::span<const int> nearest_row, int y) {
  std::vector<Reign> reigns;
  for (std::size_t x = 0; x < nearest_row.size(); ++x) {
    if (nearest_row[x] == kNoRow) continue;
    const std::int64_t rows = nearest_row[x] - y;
    Reign next{static_cast<std::int64_t>(x), rows * rows, 0};
    while (!reigns.empty() && takeover(reigns.back(), next) <= reigns.back().begin)
      reigns.pop_back();
    if (!reigns.empty()) next.begin = takeover(reigns.back(), next);
    if (next.begin < static_cast<std::int64_t>(nearest_row.size())) reigns.push_back(next);
  }
  return reigns;
}

void fill_row(std::span<const int> nearest_row, int y, DistanceField2D& field) {
  const int width = field.geometry.width;
  const std::vector<Reign> reigns = envelope_of(nearest_row, y);
  if (reigns.empty()) return;
  std::size_t reign = 0;
  for (int x = 0; x < width; ++x) {
    while (reign + 1 < reigns.size() && reigns[reign + 1].begin <= x) ++reign;
    const auto& [site_x, squared_rows, begin] = reigns[reign];
    const auto i = static_cast<std::size_t>(y * width + x);
    field.nearest[i] =
        nearest_row[static_cast<std::size_t>(site_x)] * width + static_cast<int>(site_x);
    field.distance_m[i] =
        field.geometry.cell_size_m *
        std::sqrt(static_cast<double>((site_x - x) * (site_x - x) + squared_rows));
  }
}

}  // namespace

DistanceField2D distance_field(const CellMask& sites) {
  const std::size_t count = sites.cells.size();
  DistanceField2D field{sites.geometry, std::vector(count, std::numeric_limits<double>::infinity()),
                        std::vector(count, kNoCell)};
  const std::vector<int> rows = nearest_rows(sites);
  const auto width = static_cast<std::size_t>(sites.geometry.width);
  for (int y = 0; y < sites.geometry.height; ++y)
    fill_row(std::span(rows).subspan(static_cast<std::size_t>(y) * width, width), y, field);
  return field;
}

}  // namespace stereovox
