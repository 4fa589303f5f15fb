// The two small maps on which the figures of the benchmark were worked out by hand, and the
// figures.
#pragma once

#include "stereovox/evaluation/ideal_map.h"
#include "stereovox/navmap/drawn_map_for_test.h"
#include "stereovox/occupancy/vectors_for_test.h"

namespace stereovox::benchmark {

// The vectors write 1, 0, U for the drawings' '#', '.', '?'.
inline OccupancyGrid2D map_of(const nlohmann::json& rows, double cell_size_m = 1.0) {
  Drawing drawing;
  for (std::string row : rows) {
    for (char& c : row) c = c == '1' ? '#' : c == '0' ? '.' : '?';
    drawing.push_back(row);
  }
  return drawn_grid(drawing, cell_size_m);
}

inline nlohmann::json figures() { return vectors::section("benchmark"); }
inline OccupancyGrid2D plan() { return map_of(figures().at("ideal")); }
inline OccupancyGrid2D generated() { return map_of(figures().at("generated")); }
inline IdealMap ideal() { return make_ideal(plan(), std::nullopt); }

}  // namespace stereovox::benchmark
