#include "stereovox/navmap/thin_walls.h"

#include <array>

#include "stereovox/core/grid_geometry.h"

namespace stereovox {
namespace {

// A cell with less is not what the points near its border speak of.
constexpr float kMinReachedState = 0.2F;

bool is_inside(const GridGeometry& geometry, const Eigen::Vector2i& cell) {
  return cell.x() >= 0 && cell.y() >= 0 && cell.x() < geometry.width && cell.y() < geometry.height;
}

// A cell with free space before it and an obstacle behind it; `step` leads to the free space.
struct Front {
  Eigen::Vector2i cell, step;
};

bool is_front(const OccupancyGrid2D& map, const Front& front) {
  const Eigen::Vector2i before = front.cell + front.step, behind = front.cell - front.step;
  return is_inside(map.geometry, before) && is_inside(map.geometry, behind) &&
         map.label_at(before) == CellLabel::free && map.label_at(behind) == CellLabel::occupied;
}

// `reach_m`: how far the surface reaches into the cell.
CellLabel label_by_face(CellLabel label, double state, double reach_m, const NavmapParams& params) {
  const bool is_occupied = label == CellLabel::occupied;
  const bool is_doubtful = is_occupied ? state < params.sure_state : state > kMinReachedState;
  if (!is_doubtful) return label;
  if (reach_m > 0.0) return CellLabel::occupied;
  if (reach_m > -params.face_bias_m) return CellLabel::unknown;
  return is_occupied ? CellLabel::free : label;
}

CellLabel label_of(const OccupancyGrid2D& map, const Front& front, const WallFaces& faces,
                   const NavmapParams& params) {
  const CellLabel label = map.label_at(front.cell);
  const double state = map.states[map.position_of(front.cell)];
  const Eigen::Vector2i first_cell =
      (map.geometry.origin_m / map.geometry.cell_size_m).array().round().cast<int>();
  const auto reach_m = faces.reach_m(first_cell + front.cell, front.step);
  if (reach_m) return label_by_face(label, state, *reach_m, params);
  const double behind = map.states[map.position_of(front.cell - front.step)];
  const bool is_spread = label == CellLabel::occupied && behind > state + params.wall_contrast;
  return is_spread ? CellLabel::free : label;
}

}  // namespace

void thin_walls(OccupancyGrid2D& map, const WallFaces& faces, const NavmapParams& params) {
  static const std::array<Eigen::Vector2i, 4> kSteps = {
      Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0), Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)};
  std::vector<CellLabel> labels = map.labels;
  for (int y = 0; y < map.geometry.height; ++y)
    for (int x = 0; x < map.geometry.width; ++x)
      for (const Eigen::Vector2i& step : kSteps) {
        const Front front{{x, y}, step};
        if (!is_front(map, front)) continue;
        const CellLabel label = label_of(map, front, faces, params);
        if (label != map.label_at(front.cell)) labels[map.position_of(front.cell)] = label;
      }
  map.labels = std::move(labels);
}

}  // namespace stereovox
