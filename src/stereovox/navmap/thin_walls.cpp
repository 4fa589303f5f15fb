#include "stereovox/navmap/thin_walls.h"

#include <array>
#include <optional>

#include "stereovox/core/grid_geometry.h"

namespace stereovox {
namespace {

// A cell with less is not what the points near its border speak of.
constexpr float kMinReachedState = 0.2F;

bool is_inside(const GridGeometry& geometry, const Eigen::Vector2i& cell) {
  return cell.x() >= 0 && cell.y() >= 0 && cell.x() < geometry.width && cell.y() < geometry.height;
}

constexpr std::array<std::array<int, 2>, 4> kSteps = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

// A cell with free space before it, to which `step` leads, and none behind it.
struct Front {
  Eigen::Vector2i cell, step;

  Eigen::Vector2i before() const { return cell + step; }
  Eigen::Vector2i behind() const { return cell - step; }
};

class ThinWalls {
 public:
  ThinWalls(OccupancyGrid2D& map, const WallFaces& faces, const NavmapParams& params)
      : map_(map), faces_(faces), params_(params), labels_(map.labels), states_(map.states) {}

  // Nothing that was changed is looked at again: the cells of the map change in `finish`.
  void look_at(const Front& front) {
    if (!is_front(front)) return;
    const auto reach_m = reach_into(front);
    if (!reach_m)
      judge_by_contrast(front);
    else if (is(front.cell, CellLabel::occupied))
      judge_occupied(front, *reach_m);
    else
      judge_other(front, *reach_m);
  }

  std::vector<std::size_t> finish() {
    map_.labels = std::move(labels_);
    map_.states = std::move(states_);
    return std::move(doubtful_);
  }

 private:
  bool is(const Eigen::Vector2i& cell, CellLabel label) const {
    return map_.label_at(cell) == label;
  }
  double state_of(const Eigen::Vector2i& cell) const { return map_.states[map_.position_of(cell)]; }
  // As the cell `like` is.
  void set(const Eigen::Vector2i& cell, CellLabel label, const Eigen::Vector2i& like) {
    labels_[map_.position_of(cell)] = label;
    states_[map_.position_of(cell)] = map_.states[map_.position_of(like)];
  }
  void free_in_doubt(const Front& front) {
    set(front.cell, CellLabel::free, front.before());
    doubtful_.push_back(map_.position_of(front.cell));
  }
  std::optional<double> reach_into(const Front& front) const {
    const GridGeometry& geometry = map_.geometry;
    const Eigen::Vector2i first_cell =
        (geometry.origin_m / geometry.cell_size_m).array().round().cast<int>();
    return faces_.reach_m(first_cell + front.cell, front.step);
  }
  double min_reach_m() const { return params_.min_reach * map_.geometry.cell_size_m; }

  bool is_front(const Front& front) const {
    return is_inside(map_.geometry, front.before()) && is_inside(map_.geometry, front.behind()) &&
           is(front.before(), CellLabel::free) && !is(front.behind(), CellLabel::free);
  }

  // Whether the free space behind sees the same border before it: a thin wall stands on it.
  bool is_seen_from_behind(const Front& front) const {
    const Front opposite = {front.behind(), -front.step};
    if (!is_front(opposite) || !is(opposite.cell, CellLabel::occupied)) return false;
    const auto reach_m = reach_into(opposite);
    return reach_m && *reach_m <= min_reach_m();
  }

  void judge_occupied(const Front& front, double reach_m) {
    if (reach_m > min_reach_m() || is_seen_from_behind(front)) return;
    if (reach_m > 0.0)
      free_in_doubt(front);
    else
      set(front.cell, CellLabel::free, front.before());
    const bool was_occupied = is(front.behind(), CellLabel::occupied);
    set(front.behind(), CellLabel::occupied, was_occupied ? front.behind() : front.cell);
  }

  void judge_other(const Front& front, double reach_m) {
    if (state_of(front.cell) <= kMinReachedState || !is(front.behind(), CellLabel::occupied))
      return;
    if (reach_m > min_reach_m())
      set(front.cell, CellLabel::occupied, front.behind());
    else if (reach_m > -params_.face_bias_m)
      set(front.cell, CellLabel::unknown, front.cell);
  }

  void judge_by_contrast(const Front& front) {
    if (is(front.cell, CellLabel::occupied) && is(front.behind(), CellLabel::occupied) &&
        state_of(front.behind()) > state_of(front.cell) + params_.wall_contrast)
      free_in_doubt(front);
  }

  OccupancyGrid2D& map_;
  const WallFaces& faces_;
  const NavmapParams& params_;
  std::vector<CellLabel> labels_;
  std::vector<float> states_;
  std::vector<std::size_t> doubtful_;
};

}  // namespace

std::vector<std::size_t> thin_walls(OccupancyGrid2D& map, const WallFaces& faces,
                                    const NavmapParams& params) {
  ThinWalls walls(map, faces, params);
  for (int y = 0; y < map.geometry.height; ++y)
    for (int x = 0; x < map.geometry.width; ++x)
      for (const auto& [dx, dy] : kSteps) walls.look_at({{x, y}, {dx, dy}});
  return walls.finish();
}

}  // namespace stereovox
