#include "stereovox/evaluation/doorways.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "stereovox/core/error.h"
#include "stereovox/io/yaml_file.h"
#include "stereovox/navmap/connected_cells.h"
#include "stereovox/navmap/inflate.h"

namespace stereovox {
namespace {

constexpr double kNarrowest_m = 0.01;  // a door of less is a slip of the pen

Doorway doorway_from(const YAML::Node& node, const std::string& source) {
  if (!node.IsMap()) throw Error(source + ": is not {name, a, b}");
  const std::vector<double> a_m = yaml_numbers(node, "a", 2, source);
  const std::vector<double> b_m = yaml_numbers(node, "b", 2, source);
  Doorway doorway{yaml_text(node, "name", source), {a_m[0], a_m[1]}, {b_m[0], b_m[1]}};
  const double width_m = (doorway.b_m - doorway.a_m).norm();
  if (!(width_m >= kNarrowest_m))
    throw Error(fmt::format("{}: doorway '{}' is {:g} m wide, less than {} m", source, doorway.name,
                            width_m, kNarrowest_m));
  return doorway;
}

// A place in the doorway's frame, its origin the middle of the opening.
struct DoorPlace {
  double along_m, across_m;
};

struct DoorFrame {
  Eigen::Vector2d middle_m, along;
  double half_width_m;

  explicit DoorFrame(const Doorway& door)
      : middle_m((door.a_m + door.b_m) / 2.0),
        along((door.b_m - door.a_m).normalized()),
        half_width_m((door.b_m - door.a_m).norm() / 2.0) {}
  DoorPlace place_of(const Eigen::Vector2d& p_m) const {
    const Eigen::Vector2d d_m = p_m - middle_m;
    return {d_m.dot(along), along.x() * d_m.y() - along.y() * d_m.x()};
  }
};

enum class Side { before, inside, behind, outside };

// A window of one robot diameter on both sides ends in strips of one cell's diagonal, so that a
// strip holds a chain of cells whatever the door's direction.
Side side_of(const DoorPlace& place, const DoorFrame& frame, double diameter_m, double strip_m) {
  if (std::abs(place.along_m) > frame.half_width_m ||
      std::abs(place.across_m) > diameter_m + strip_m)
    return Side::outside;
  if (std::abs(place.across_m) < diameter_m) return Side::inside;
  return place.across_m < 0.0 ? Side::before : Side::behind;
}

// Whether any cell of the way that is_open asks for is known.
bool is_seen(const Doorway& doorway, const OccupancyGrid2D& map, double robot_radius_m) {
  const DoorFrame frame(doorway);
  for (int i = 0; i < cell_count(map.geometry); ++i) {
    const Eigen::Vector2i cell = cell_in(map.geometry, i);
    if (map.label_at(cell) == CellLabel::unknown) continue;
    const DoorPlace place = frame.place_of(center_of(map.geometry, cell));
    if (side_of(place, frame, 2.0 * robot_radius_m, 0.0) != Side::outside) return true;
  }
  return false;
}

}  // namespace

std::vector<Doorway> read_doorways(const std::filesystem::path& path) {
  const YAML::Node yaml = load_yaml(path);
  if (!yaml.IsMap()) throw Error(path.string() + ": 'doorways' is missing");
  const YAML::Node list = yaml_value(yaml, "doorways", path.string());
  if (!list.IsSequence()) throw Error(path.string() + ": 'doorways' is not a list");
  std::vector<Doorway> doorways;
  for (const YAML::Node& node : list) doorways.push_back(doorway_from(node, path.string()));
  return doorways;
}

bool is_open(const Doorway& doorway, const OccupancyGrid2D& map, double robot_radius_m) {
  const DoorFrame frame(doorway);
  const double strip_m = std::numbers::sqrt2 * map.geometry.cell_size_m;
  const auto side = [&](int i) {
    const Eigen::Vector2d center_m = center_of(map.geometry, cell_in(map.geometry, i));
    return side_of(frame.place_of(center_m), frame, 2.0 * robot_radius_m, strip_m);
  };
  CellMask window = cells_labelled(inflate(map, robot_radius_m), CellLabel::free);
  for (int i = 0; i < cell_count(map.geometry); ++i)
    if (window.has(i) && side(i) == Side::outside) window.set(i, false);
  const ConnectedCells pieces = connected_cells(window);
  std::vector<bool> begins(pieces.sizes.size()), ends(pieces.sizes.size());
  for (int i = 0; i < cell_count(map.geometry); ++i) {
    if (!window.has(i)) continue;
    const auto piece = static_cast<std::size_t>(pieces.piece_of[static_cast<std::size_t>(i)]);
    if (side(i) == Side::before) begins[piece] = true;
    if (side(i) == Side::behind) ends[piece] = true;
  }
  for (std::size_t piece = 0; piece < begins.size(); ++piece)
    if (begins[piece] && ends[piece]) return true;
  return false;
}

DoorScore score_doors(const std::vector<Doorway>& doorways, const OccupancyGrid2D& ideal,
                      const OccupancyGrid2D& generated, double robot_radius_m) {
  DoorScore score;
  for (const Doorway& doorway : doorways) {
    if (!is_open(doorway, ideal, robot_radius_m)) continue;
    ++score.doors;
    if (is_open(doorway, generated, robot_radius_m)) {
      ++score.open_doors;
      continue;
    }
    score.closed.push_back(doorway.name);
    if (!is_seen(doorway, generated, robot_radius_m)) score.unseen.push_back(doorway.name);
  }
  return score;
}

}  // namespace stereovox
