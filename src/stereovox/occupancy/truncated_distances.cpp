#include "stereovox/occupancy/truncated_distances.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "stereovox/core/parallel.h"

namespace stereovox {
namespace {

constexpr int kSide = kTileSide * kBlockSide;  // of a tile, in voxels
// More than any distance that counts, and sums of three of them fit.
constexpr std::uint16_t kFar = 20'000;
static_assert(kFar > TruncatedDistances::kMaxLimit_voxels * TruncatedDistances::kMaxLimit_voxels);

std::uint16_t square(int steps) { return static_cast<std::uint16_t>(steps * steps); }

// In place: from 0 at members and kFar elsewhere to the squared distance along the row.
void measure_row(std::uint16_t* row, int count) {
  int steps = kFar;
  for (int i = 0; i < count; ++i) {
    steps = row[i] == 0 ? 0 : std::min<int>(steps + 1, kFar);
    row[i] = static_cast<std::uint16_t>(steps);
  }
  steps = kFar;
  for (int i = count - 1; i >= 0; --i) {
    steps = row[i] == 0 ? 0 : std::min<int>(steps + 1, kFar);
    const int nearer = std::min<int>(steps, row[i]);
    row[i] = nearer > TruncatedDistances::kMaxLimit_voxels ? kFar : square(nearer);
  }
}

// out[i] = min(out[i], in[i] + added), for a run of values that no other thread sees.
void join(const std::uint16_t* in, std::uint16_t added, int count, std::uint16_t* out) {
  for (int i = 0; i < count; ++i) {
    const auto sum = static_cast<std::uint16_t>(in[i] + added);
    out[i] = sum < out[i] ? sum : out[i];
  }
}

// The pass along an axis: `planes` output planes of `size` values, each the least of the input
// planes within the margin and the squared steps to them.
void pass(const std::uint16_t* in, int planes, int margin, int size, std::uint16_t* out) {
  std::fill(out, out + planes * size, kFar);
  for (int p = 0; p < planes; ++p)
    for (int step = -margin; step <= margin; ++step)
      join(in + (p + margin + step) * size, square(step), size, out + p * size);
}

}  // namespace

TruncatedDistances::TruncatedDistances(double limit_voxels, Extent extent) : extent_(extent) {
  if (!(limit_voxels > 0.0 && limit_voxels <= kMaxLimit_voxels))
    throw std::logic_error("TruncatedDistances: the limit is outside (0, 100] voxels");
  margin_ = static_cast<int>(std::floor(limit_voxels));
  largest_squared_ = static_cast<std::uint16_t>(std::floor(limit_voxels * limit_voxels));
}

void TruncatedDistances::update(const std::vector<BlockOfSet>& blocks, int threads) {
  std::vector<Eigen::Vector3i> changed;
  for (const BlockOfSet& block : blocks) {
    if (block.members.is_empty() && member_index_.find(block.index) == BlockIndex::kNone) continue;
    const auto number = static_cast<std::size_t>(member_index_.find_or_insert(block.index));
    if (number == members_.size()) members_.push_back({block.index, {}});
    if (members_[number].members.words == block.members.words) continue;
    members_[number].members = block.members;
    changed.push_back(block.index);
  }
  const std::vector<Eigen::Vector3i> tiles = tiles_near(changed);
  for (const Eigen::Vector3i& tile : tiles)
    for (std::size_t i = 0; i < kBlocksPerTile; ++i) {
      const Eigen::Vector3i block = block_at(tile, i);
      if (extent_ == Extent::plane && block.z() != 0) continue;
      const auto number = static_cast<std::size_t>(distance_index_.find_or_insert(block));
      if (number == distances_.size()) distances_.emplace_back().fill(kBeyond);
    }
  parallel_for(0, static_cast<int>(tiles.size()), threads,
               [&](int i) { compute(tiles[static_cast<std::size_t>(i)]); });
}

std::vector<Eigen::Vector3i> TruncatedDistances::tiles_near(
    const std::vector<Eigen::Vector3i>& blocks) const {
  std::set<Eigen::Vector3i, LatticeOrder> tiles;
  for (const Eigen::Vector3i& block : blocks) {
    const Eigen::Vector3i low = block * kBlockSide;
    const auto tile_at = [&](int offset) {
      return tile_of(block_of((low.array() + offset).matrix()));
    };
    const Eigen::Vector3i first = tile_at(-margin_), last = tile_at(kBlockSide - 1 + margin_);
    for (int x = first.x(); x <= last.x(); ++x)
      for (int y = first.y(); y <= last.y(); ++y)
        for (int z = first.z(); z <= last.z(); ++z)
          if (extent_ == Extent::space || z == 0) tiles.insert({x, y, z});
  }
  return {tiles.begin(), tiles.end()};
}

// Lays out values with x fastest, then y, then z; each pass shrinks one axis from the tile and its
// margins to the tile.
void TruncatedDistances::compute(const Eigen::Vector3i& tile) {
  const bool is_plane = extent_ == Extent::plane;
  const int wide = kSide + 2 * margin_;
  const int deep = is_plane ? 1 : wide, layers = is_plane ? 1 : kSide;
  const Eigen::Vector3i first =
      tile * kSide - Eigen::Vector3i(margin_, margin_, is_plane ? 0 : margin_);
  const auto cells = [](int x, int y, int z) { return static_cast<std::size_t>(x * y * z); };

  std::vector<std::uint16_t> rows(cells(wide, wide, deep), kFar);
  std::vector<std::uint16_t> squared(cells(kSide, kSide, layers), kFar);
  if (fill_rows(first, rows)) {
    std::vector<std::uint16_t> along_x(cells(kSide, wide, deep));
    for (int row = 0; row < wide * deep; ++row) {
      measure_row(rows.data() + row * wide, wide);
      std::copy_n(rows.data() + row * wide + margin_, kSide, along_x.data() + row * kSide);
    }
    std::vector<std::uint16_t> along_y(cells(kSide, kSide, deep));
    for (int z = 0; z < deep; ++z)
      pass(along_x.data() + z * wide * kSide, kSide, margin_, kSide,
           along_y.data() + z * kSide * kSide);
    if (is_plane)
      squared = along_y;
    else
      pass(along_y.data(), kSide, margin_, kSide * kSide, squared.data());
  }
  keep(tile, squared);
}

// Whether there is a member; rows hold 0 at members.
bool TruncatedDistances::fill_rows(const Eigen::Vector3i& first,
                                   std::vector<std::uint16_t>& rows) const {
  const int wide = kSide + 2 * margin_;
  const int deep = extent_ == Extent::plane ? 1 : wide;
  const Eigen::Vector3i low = block_of(first);
  const Eigen::Vector3i high = block_of(first + Eigen::Vector3i(wide - 1, wide - 1, deep - 1));
  bool is_any = false;
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z) {
        const int number = member_index_.find({x, y, z});
        if (number == BlockIndex::kNone) continue;
        const BlockOfSet& block = members_[static_cast<std::size_t>(number)];
        is_any = is_any || !block.members.is_empty();
        mark_members(block, first, rows);
      }
  return is_any;
}

void TruncatedDistances::mark_members(const BlockOfSet& block, const Eigen::Vector3i& first,
                                      std::vector<std::uint16_t>& rows) const {
  const int wide = kSide + 2 * margin_;
  const int deep = extent_ == Extent::plane ? 1 : wide;
  for_each_in(block.members, [&](int i) {
    const Eigen::Vector3i at = voxel_at(block.index, i) - first;
    if ((at.array() < 0).any() || at.x() >= wide || at.y() >= wide || at.z() >= deep) return;
    rows[static_cast<std::size_t>((at.z() * wide + at.y()) * wide + at.x())] = 0;
  });
}

void TruncatedDistances::keep(const Eigen::Vector3i& tile,
                              const std::vector<std::uint16_t>& squared) {
  for (std::size_t b = 0; b < kBlocksPerTile; ++b) {
    const Eigen::Vector3i block = block_at(tile, b);
    const int number = distance_index_.find(block);
    if (number == BlockIndex::kNone) continue;
    BlockDistances& out = distances_[static_cast<std::size_t>(number)];
    for (int i = 0; i < kVoxelsPerBlock; ++i) {
      const Eigen::Vector3i at = voxel_at(block, i) - tile * kSide;
      if (extent_ == Extent::plane && at.z() > 0) break;  // positions go by layers
      const std::uint16_t value =
          squared[static_cast<std::size_t>((at.z() * kSide + at.y()) * kSide + at.x())];
      out[static_cast<std::size_t>(i)] = value <= largest_squared_ ? value : kBeyond;
    }
  }
}

std::uint16_t TruncatedDistances::squared_at(const Eigen::Vector3i& voxel) const {
  const Eigen::Vector3i block = block_of(voxel);
  if (block.cwiseAbs().maxCoeff() > kMaxBlockCoordinate) return kBeyond;
  const int number = distance_index_.find(block);
  if (number == BlockIndex::kNone) return kBeyond;
  return distances_[static_cast<std::size_t>(number)]
                   [static_cast<std::size_t>(position_in_block(voxel))];
}

std::size_t TruncatedDistances::memory_bytes() const {
  return members_.size() * sizeof(BlockOfSet) + distances_.size() * sizeof(BlockDistances) +
         member_index_.memory_bytes() + distance_index_.memory_bytes();
}

}  // namespace stereovox
