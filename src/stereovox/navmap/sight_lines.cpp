#include "stereovox/navmap/sight_lines.h"

#include <fmt/format.h>

#include <algorithm>

#include "stereovox/core/error.h"
#include "stereovox/navmap/cell_line.h"

namespace stereovox {
namespace {

constexpr std::string_view kSightLinesMagic = "sight lines 1\n";

using Cells = std::vector<Eigen::Vector2i>;

// One bit for each occupied column of a tile.
std::uint64_t occupied_bits(const ColumnTile& columns, std::uint64_t held,
                            const NavmapParams& params) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (is_occupied(columns[i], (held >> i & 1U) != 0, params)) bits |= std::uint64_t{1} << i;
  return bits;
}

std::uint64_t bits_of(const CellSet& set, const TileIndex& tile) {
  const auto found = set.tiles().find(tile);
  return found == set.tiles().end() ? 0 : found->second;
}

// The tiles that the lines of one frame meet: states are looked up once a tile, at first use.
class FrameTiles {
 public:
  FrameTiles(const VoxelMap& map, const NavmapParams& params, const CellSet& held)
      : reader_(map, params), params_(params), held_(held) {}

  bool is_occupied(const Eigen::Vector2i& cell) { return (tile(cell).occupied & bit(cell)) != 0; }
  void mark(const Eigen::Vector2i& cell) { tile(cell).marked |= bit(cell); }
  void merge_marks_into(CellSet& set) const {
    for (const auto& [index, tile] : tiles_) set.insert(index, tile.marked);
  }

 private:
  struct Tile {
    std::uint64_t occupied = 0, marked = 0;
  };

  static std::uint64_t bit(const Eigen::Vector2i& cell) {
    return std::uint64_t{1} << position_in_tile(cell);
  }
  Tile& tile(const Eigen::Vector2i& cell);

  ColumnReader reader_;
  const NavmapParams& params_;
  const CellSet& held_;
  std::map<TileIndex, Tile> tiles_;
  std::pair<const TileIndex, Tile>* last_ = nullptr;  // successive cells mostly share a tile
};

FrameTiles::Tile& FrameTiles::tile(const Eigen::Vector2i& cell) {
  const TileIndex index = tile_of(cell);
  if (last_ != nullptr && last_->first == index) return last_->second;
  const auto [found, is_new] = tiles_.try_emplace(index);
  if (is_new)
    found->second.occupied = occupied_bits(reader_.read(index), bits_of(held_, index), params_);
  last_ = &*found;
  return last_->second;
}

void sort_unique(Cells& cells) {
  const auto order = [](const Eigen::Vector2i& a, const Eigen::Vector2i& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  };
  std::ranges::sort(cells, order);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

// The distinct cells below the voxels that lie in the layers above them.
Cells cells_below(std::span<const Eigen::Vector3i> voxels, ColumnLayers layers) {
  Cells cells;
  for (const Eigen::Vector3i& voxel : voxels)
    if (layers.above(voxel.head<2>()).contains(voxel.z()) &&
        (cells.empty() || cells.back() != voxel.head<2>()))
      cells.emplace_back(voxel.head<2>());
  sort_unique(cells);
  return cells;
}

Cells occupied_cells(const VoxelMap& map, const CellSet& held, const NavmapParams& params) {
  Cells cells;
  for_each_column_tile(map, params, [&](const TileIndex& index, const ColumnTile& columns) {
    const std::uint64_t bits = occupied_bits(columns, bits_of(held, index), params);
    for (int i = 0; i < kCellsPerTile; ++i)
      if (bits >> i & 1U) cells.push_back(cell_at(index, i));
  });
  return cells;
}

// Marks the cells on the way from the robot to each occupied target.
void mark_lines(const Eigen::Vector2i& robot, const Cells& targets, bool stops_at_occupied,
                FrameTiles& tiles) {
  for (const Eigen::Vector2i& target : targets) {
    if (!tiles.is_occupied(target)) continue;
    for (CellLine line(robot, target); line.cell() != target; line.step()) {
      const bool is_free = !tiles.is_occupied(line.cell());
      if (is_free) tiles.mark(line.cell());
      // The robot itself stands in free space, whatever its cell says.
      if (!is_free && stops_at_occupied && line.cell() != robot) break;
    }
  }
}

// Drops what fell below the hysteresis, adds what the hits raised above the threshold: a state
// rises by hits only.
void update_held(const VoxelMap& map, const Cells& hit_cells, const NavmapParams& params,
                 CellSet& held) {
  ColumnReader reader(map, params);
  CellSet candidates = held;
  for (const Eigen::Vector2i& cell : hit_cells)
    candidates.insert(tile_of(cell), std::uint64_t{1} << position_in_tile(cell));
  for (const auto& [tile, bits] : candidates.tiles()) {
    const std::uint64_t occupied = occupied_bits(reader.read(tile), bits_of(held, tile), params);
    held.erase(tile, ~occupied);
    held.insert(tile, occupied & bits);
  }
}

// Each cell whose centre, moved back, lies in a cell of the set.
CellSet moved(const CellSet& set, const SE3& T_to_from, double cell_size_m) {
  const auto cell_under = [&](const SE3& T, const Eigen::Vector2i& cell) -> Eigen::Vector2i {
    const Eigen::Vector2d center_m = (cell.cast<double>().array() + 0.5) * cell_size_m;
    const Eigen::Vector3d place_m = T * Eigen::Vector3d(center_m.x(), center_m.y(), 0.0);
    return (place_m.head<2>() / cell_size_m).array().floor().cast<int>();
  };
  const SE3 T_from_to = inverse(T_to_from);
  CellSet out;
  for_each_cell(set, [&](const Eigen::Vector2i& cell) {
    const Eigen::Vector2i near = cell_under(T_to_from, cell);
    for (int i = 0; i < 9; ++i) {
      const Eigen::Vector2i place = near + Eigen::Vector2i(i % 3 - 1, i / 3 - 1);
      if (set.contains(cell_under(T_from_to, place)))
        out.insert(tile_of(place), std::uint64_t{1} << position_in_tile(place));
    }
  });
  return out;
}

void insert_all(const CellSet& cells, CellSet& to) {
  for (const auto& [tile, bits] : cells.tiles()) to.insert(tile, bits);
}

}  // namespace

bool is_occupied(const ColumnState& column, bool is_held, const NavmapParams& params) {
  if (!column.is_known) return false;
  if (column.max_state > params.threshold) return true;
  return is_held && column.max_state >= params.threshold - params.hysteresis;
}

void SightLines::observe(const VoxelMap& map, const Eigen::Vector2d& robot_xy_world,
                         std::span<const Eigen::Vector3i> hits, const NavmapParams& params) {
  const Cells hit_cells = cells_below(hits, ColumnLayers(map, params));
  if (params.hysteresis > 0.0) update_held(map, hit_cells, params, held_);

  const bool is_printed = params.label_rule == LabelRule::as_printed;
  const Cells targets = is_printed ? occupied_cells(map, held_, params) : hit_cells;
  const Eigen::Vector2i robot = (robot_xy_world / map.voxel_size_m()).array().floor().cast<int>();
  FrameTiles tiles(map, params, held_);
  mark_lines(robot, targets, !is_printed, tiles);
  tiles.merge_marks_into(free_);
}

void SightLines::merge(const SightLines& other, const SE3& T_map_other, double cell_size_m) {
  insert_all(moved(other.free_, T_map_other, cell_size_m), free_);
  insert_all(moved(other.held_, T_map_other, cell_size_m), held_);
}

void SightLines::keep_seen(const VoxelMap& map, const NavmapParams& params) {
  NavmapParams however_seldom = params;
  however_seldom.min_observations = 1;
  CellSet kept;
  for_each_column_tile(map, however_seldom, [&](const TileIndex& index, const ColumnTile& columns) {
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < columns.size(); ++i)
      seen |= std::uint64_t{columns[i].is_known} << i;
    kept.insert(index, seen & bits_of(free_, index));
  });
  free_ = std::move(kept);
}

SightLines attached_sight_lines(const VoxelMap& map, const std::string& source) {
  const auto blob = map.attachments.find(kSightLinesAttachment);
  return blob == map.attachments.end() ? SightLines{}
                                       : sight_lines_from_bytes(blob->second, source);
}

std::string to_bytes(const SightLines& sight_lines) {
  std::string bytes(kSightLinesMagic);
  append_bytes(sight_lines.free_cells(), bytes);
  append_bytes(sight_lines.held_cells(), bytes);
  return bytes;
}

SightLines sight_lines_from_bytes(std::string_view bytes, const std::string& source) {
  if (!bytes.starts_with(kSightLinesMagic))
    throw Error(fmt::format("{}: the sight lines do not begin with 'sight lines 1'", source));
  bytes.remove_prefix(kSightLinesMagic.size());
  SightLines sight_lines;
  sight_lines.free_ = take_cell_set(bytes, source);
  sight_lines.held_ = take_cell_set(bytes, source);
  if (!bytes.empty())
    throw Error(fmt::format("{}: {} bytes too many after the sight lines", source, bytes.size()));
  return sight_lines;
}

}  // namespace stereovox
