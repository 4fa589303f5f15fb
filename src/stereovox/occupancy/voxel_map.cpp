#include "stereovox/occupancy/voxel_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/tile_section.h"

namespace stereovox {
namespace {

constexpr double kMinVoxelSize_m = 0.001, kMaxVoxelSize_m = 10.0;

std::string place_text(const Eigen::Vector3i& tile) {
  return fmt::format("({}, {}, {})", tile.x(), tile.y(), tile.z());
}

KnownCounts known_in(const TileBlocks& blocks) {
  KnownCounts counts;
  for (const auto& block : blocks) {
    const std::size_t known = block == nullptr ? 0 : block->voxels.known_count();
    counts += {known > 0 ? 1U : 0U, known};
  }
  return counts;
}

void extend(std::optional<VoxelBounds>& bounds, const VoxelBlock& block) {
  for_each_in(block.voxels.known(), [&](int i) {
    const Eigen::Vector3i voxel = voxel_at(block.index, i);
    if (!bounds) bounds = VoxelBounds{voxel, voxel};
    bounds->min = bounds->min.cwiseMin(voxel);
    bounds->max = bounds->max.cwiseMax(voxel);
  });
}

bool overlaps(const VoxelBounds& box, const Eigen::Vector3i& low, int side) {
  return (box.min.array() < low.array() + side).all() && (box.max.array() >= low.array()).all();
}

}  // namespace

VoxelMap::VoxelMap(double voxel_size_m, double floor_z_m)
    : floor(floor_z_m), voxel_size_m_(voxel_size_m) {
  if (!(voxel_size_m >= kMinVoxelSize_m && voxel_size_m <= kMaxVoxelSize_m))
    throw Error(fmt::format("voxel size is {} m, outside [{}, {}]", voxel_size_m, kMinVoxelSize_m,
                            kMaxVoxelSize_m));
  if (!std::isfinite(floor_z_m)) throw Error(fmt::format("height of the floor is {} m", floor_z_m));
}

VoxelMap::VoxelMap(const VoxelMap& other)
    : epoch_ns(other.epoch_ns),
      frames_integrated(other.frames_integrated),
      attachments(other.attachments),
      floor(other.floor),
      voxel_size_m_(other.voxel_size_m_) {
  other.for_each_block(
      [&](const VoxelBlock& block) { find_or_create_block(block.index).voxels = block.voxels; });
}

VoxelMap& VoxelMap::operator=(const VoxelMap& other) {
  if (this != &other) *this = VoxelMap(other);
  return *this;
}

// ---- changing

VoxelTile& VoxelMap::find_or_create_tile(const Eigen::Vector3i& block_index) {
  VoxelTile& found = table_.find(tile_of(block_index));
  if (TileTable::is_there(found)) return found;
  VoxelTile& created = *tiles_.emplace_back(std::make_unique<VoxelTile>());
  created.index = tile_of(block_index);
  table_.insert(created);
  return created;
}

VoxelBlock& VoxelMap::find_or_create_block(const Eigen::Vector3i& block_index) {
  VoxelTile& tile = find_or_create_tile(block_index);
  if (tile.is_out) bring_back(tile);
  const std::size_t position = position_in_tile(block_index);
  auto& block = tile.blocks[position];
  if (block == nullptr) {
    block = std::make_unique<VoxelBlock>();
    block->index = block_index;
    ++block_count_;
  }
  mark_changed(tile, position);
  return *block;
}

void VoxelMap::set(const Eigen::Vector3i& index, const Voxel& voxel) {
  find_or_create_block(block_of(index))
      .voxels.set(static_cast<std::size_t>(position_in_block(index)), voxel);
}

void VoxelMap::erase_block(const Eigen::Vector3i& block_index) {
  if (find_block(block_index) == nullptr) return;
  VoxelTile& tile = table_.find(tile_of(block_index));
  tile.blocks[position_in_tile(block_index)].reset();
  --block_count_;
  mark_changed(tile, position_in_tile(block_index));
}

void VoxelMap::mark_changed(VoxelTile& tile, std::size_t position) {
  tile.changed_at[position] = tile.used_at = ++changes_;
  measure_later(tile);
}

std::vector<Eigen::Vector3i> VoxelMap::blocks_changed_since(ChangeStamp stamp) const {
  std::vector<Eigen::Vector3i> changed;
  for (const auto& tile : tiles_) {
    if (tile->used_at <= stamp) continue;
    for (std::size_t i = 0; i < tile->changed_at.size(); ++i)
      if (tile->changed_at[i] > stamp) changed.push_back(block_at(tile->index, i));
  }
  std::ranges::sort(changed, LatticeOrder{});
  return changed;
}

// ---- all of it

std::vector<VoxelTile*> VoxelMap::sorted_tiles() const {
  std::vector<VoxelTile*> sorted;
  for (const auto& tile : tiles_) sorted.push_back(tile.get());
  std::ranges::sort(sorted, LatticeOrder{}, &VoxelTile::index);
  return sorted;
}

void VoxelMap::for_each_tile(const VisitTile& visit) const {
  for (const VoxelTile* const tile : sorted_tiles()) {
    const TileBlocks stored = tile->is_out ? read_stored(*tile) : TileBlocks{};
    visit(tile->index, blocks_of(tile->is_out ? stored : tile->blocks));
  }
}

void VoxelMap::for_each_tile_section(
    const std::function<void(std::string_view section)>& visit) const {
  for (const VoxelTile* const tile : sorted_tiles()) {
    const std::string section = tile->is_out ? store_->read(tile->stored)
                                             : encode_tile(tile->index, blocks_of(tile->blocks));
    if (!section.empty()) visit(section);
  }
}

std::vector<const VoxelBlock*> VoxelMap::sorted_blocks() const {
  std::vector<const VoxelBlock*> sorted;
  sorted.reserve(block_count_);
  for (const auto& tile : tiles_) {
    if (tile->is_out) bring_back(*tile);
    std::ranges::copy(blocks_of(tile->blocks), std::back_inserter(sorted));
  }
  std::ranges::sort(sorted, LatticeOrder{}, &VoxelBlock::index);
  return sorted;
}

// Asks for each place of the box, or goes through the tiles when they are fewer.
std::vector<VoxelTile*> VoxelMap::tiles_in(const VoxelBounds& box) const {
  const Eigen::Vector3i low = tile_of(block_of(box.min)), high = tile_of(block_of(box.max));
  const Eigen::Array3d counts = (high - low).cast<double>().array() + 1.0;
  std::vector<VoxelTile*> inside;
  if (counts.prod() > static_cast<double>(tiles_.size())) {
    constexpr int kSide = kTileSide * kBlockSide;
    for (const auto& tile : tiles_)
      if (overlaps(box, tile->index * kSide, kSide)) inside.push_back(tile.get());
    return inside;
  }
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z)
        if (is_within_reach({x * kTileSide, y * kTileSide, z * kTileSide}))
          if (VoxelTile& tile = table_.find({x, y, z}); TileTable::is_there(tile))
            inside.push_back(&tile);
  return inside;
}

std::vector<const VoxelBlock*> VoxelMap::blocks_in(const VoxelBounds& box) const {
  std::vector<const VoxelBlock*> inside;
  for (VoxelTile* const tile : tiles_in(box)) {
    if (tile->is_out) bring_back(*tile);
    for (const VoxelBlock* const block : blocks_of(tile->blocks))
      if (overlaps(box, block->index * kBlockSide, kBlockSide)) inside.push_back(block);
  }
  std::ranges::sort(inside, LatticeOrder{}, &VoxelBlock::index);
  return inside;
}

KnownCounts VoxelMap::known_counts() const {
  KnownCounts counts;
  for (const auto& tile : tiles_)
    counts += tile->is_out ? tile->stored_known : known_in(tile->blocks);
  return counts;
}

std::optional<VoxelBounds> VoxelMap::bounds() const {
  std::optional<VoxelBounds> bounds;
  for_each_block([&](const VoxelBlock& block) { extend(bounds, block); });
  return bounds;
}

// ---- memory and store

void VoxelMap::measure_later(VoxelTile& tile) const {
  if (!tile.is_measured) return;
  tile.is_measured = false;
  unmeasured_.push_back(&tile);
}

void VoxelMap::measure(VoxelTile& tile) const {
  measured_bytes_ -= tile.memory_bytes;
  tile.memory_bytes = 0;
  for (const auto& block : tile.blocks)
    if (block != nullptr) tile.memory_bytes += sizeof(VoxelBlock) + block->voxels.extra_bytes();
  measured_bytes_ += tile.memory_bytes;
  tile.is_measured = true;
}

std::size_t VoxelMap::memory_bytes() const {
  for (VoxelTile* const tile : unmeasured_) measure(*tile);
  unmeasured_.clear();
  return measured_bytes_ + tiles_.size() * sizeof(VoxelTile) + table_.memory_bytes();
}

void VoxelMap::use_store(const std::filesystem::path& folder) {
  if (store_ == nullptr) store_ = std::make_unique<TileStore>(folder);
}

TileBlocks VoxelMap::read_stored(const VoxelTile& tile) const {
  const std::string section = store_->read(tile.stored);
  try {
    return decode_tile(section);
  } catch (const std::logic_error& error) {
    throw ResourceError(
        fmt::format("{}: tile {}: {}", store_->name(), place_text(tile.index), error.what()));
  } catch (const std::runtime_error& error) {
    throw ResourceError(
        fmt::format("{}: tile {}: {}", store_->name(), place_text(tile.index), error.what()));
  }
}

void VoxelMap::bring_back(VoxelTile& tile) const {
  tile.blocks = read_stored(tile);
  tile.is_out = false;
  tile.used_at = changes_;
  --tiles_out_;
  measure_later(tile);
}

void VoxelMap::store(VoxelTile& tile) {
  const std::vector<const VoxelBlock*> blocks = blocks_of(tile.blocks);
  const StoredPlace old = tile.stored;
  const std::string section = encode_tile(tile.index, blocks);
  tile.stored = section.empty() ? StoredPlace{} : store_->write(section);
  if (old.bytes > 0) store_->release(old);
  tile.stored_at = changes_;
  tile.stored_known = known_in(tile.blocks);
}

void VoxelMap::put_out(VoxelTile& tile) {
  const ChangeStamp changed_at = *std::ranges::max_element(tile.changed_at);
  if (tile.stored.bytes == 0 || changed_at > tile.stored_at) store(tile);
  if (tile.stored.bytes == 0) return;  // knows nothing
  for (auto& block : tile.blocks) {
    if (block != nullptr && block->voxels.known_count() == 0) --block_count_;
    block.reset();
  }
  tile.is_out = true;
  ++tiles_out_;
  measure(tile);
}

std::vector<std::string> VoxelMap::forget_unreadable_tiles() {
  std::vector<std::string> errors;
  for (const auto& tile : tiles_) {
    if (!tile->is_out) continue;
    try {
      read_stored(*tile);
    } catch (const ResourceError& error) {
      errors.emplace_back(error.what());
      block_count_ -= tile->stored_known.blocks;
      tile->is_out = false;
      tile->stored = {};
      --tiles_out_;
    }
  }
  return errors;
}

void VoxelMap::keep_within(std::size_t bytes) {
  if (memory_bytes() <= bytes) return;
  if (store_ == nullptr) throw std::logic_error("keep_within: the map has no store");
  constexpr double kMargin = 0.9;
  const auto goal = static_cast<std::size_t>(kMargin * static_cast<double>(bytes));
  std::vector<VoxelTile*> candidates;
  for (const auto& tile : tiles_)
    if (!tile->is_out) candidates.push_back(tile.get());
  std::ranges::sort(candidates, {}, &VoxelTile::used_at);
  for (VoxelTile* const tile : candidates) {
    if (memory_bytes() <= goal) return;
    put_out(*tile);
  }
}

}  // namespace stereovox
