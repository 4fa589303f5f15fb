#include "stereovox/occupancy/frame_visibility.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>

#include "stereovox/core/parallel.h"

namespace stereovox {
namespace {

constexpr int kFaces = 6;

// Face of a voxel or block: axis and direction (-1 or 1).
constexpr std::size_t face_of(int axis, int direction) {
  return static_cast<std::size_t>(2 * axis + (direction > 0 ? 1 : 0));
}

Eigen::Vector3i step_along(int axis, int direction) {
  return direction * Eigen::Vector3i::Unit(axis);
}

int direction_of(int difference) { return difference > 0 ? 1 : -1; }

// What one block needs to see: itself and its face neighbours, in the map and in the frame.
class BlockSurroundings {
 public:
  BlockSurroundings(const FrameObservation& observation, const VoxelMap& map, int number)
      : own_number_(number), index_(observation.blocks[static_cast<std::size_t>(number)].index) {
    own_ = map.find_block(index_);
    for (int axis = 0; axis < 3; ++axis)
      for (const int direction : {-1, 1}) {
        const Eigen::Vector3i place = index_ + step_along(axis, direction);
        near_[face_of(axis, direction)] = map.find_block(place);
        numbers_[face_of(axis, direction)] = observation.index.find(place);
      }
  }

  const Eigen::Vector3i& index() const { return index_; }
  int number() const { return own_number_; }

  // The neighbour of voxel `position`, unknown where there is none.
  Voxel voxel(int position, int axis, int direction) const {
    const VoxelBlock* const block =
        leaves(position, axis, direction) ? near_[face_of(axis, direction)] : own_;
    return block == nullptr ? Voxel{} : block->voxels[wrapped(position, axis, direction)];
  }
  // The number of the block in the frame that holds it, kNone where there is none.
  int number(int position, int axis, int direction) const {
    return leaves(position, axis, direction) ? numbers_[face_of(axis, direction)] : own_number_;
  }
  static std::size_t wrapped(int position, int axis, int direction) {
    return static_cast<std::size_t>(position_in_block(voxel_at(Eigen::Vector3i::Zero(), position) +
                                                      step_along(axis, direction)));
  }

 private:
  static bool leaves(int position, int axis, int direction) {
    const int local = position >> (kBlockSideLog2 * axis) & (kBlockSide - 1);
    return local == (direction > 0 ? kBlockSide - 1 : 0);
  }

  int own_number_;
  Eigen::Vector3i index_;
  const VoxelBlock* own_;
  std::array<const VoxelBlock*, kFaces> near_{};
  std::array<int, kFaces> numbers_{};
};

// The coordinates of a block's voxels along one axis, those nearest to the camera first.
std::array<int, kBlockSide> outward(int block, int camera_voxel) {
  std::array<int, kBlockSide> locals{};
  std::iota(locals.begin(), locals.end(), 0);
  std::ranges::stable_sort(
      locals, {}, [&](int local) { return std::abs(block * kBlockSide + local - camera_voxel); });
  return locals;
}

class VisibilityField {
 public:
  VisibilityField(const VisibilityRule& rule, const FrameView& frame,
                  const FrameObservation& observation, const VoxelMap& map)
      : rule_(rule),
        frame_(frame),
        observation_(observation),
        camera_(voxel_index_of(frame.params.voxel_size_m, frame.T_world_camera.translation)),
        values_(observation.blocks.size()) {
    // Here, not on threads: asking a map for a block may change where it is.
    for (int number = 0; number < static_cast<int>(observation.blocks.size()); ++number)
      surroundings_.emplace_back(observation, map, number);
  }

  // The blocks nearer to the camera must be filled before. Every voxel comes after those that face
  // the camera more.
  void fill(int number) {
    const auto at = static_cast<std::size_t>(number);
    const BlockObservation& block = observation_.blocks[at];
    const BlockSurroundings& near = surroundings_[at];
    values_[at].assign(kVoxelsPerBlock, 0.0F);
    const auto xs = outward(block.index.x(), camera_.x());
    const auto ys = outward(block.index.y(), camera_.y());
    const auto zs = outward(block.index.z(), camera_.z());
    for (const int z : zs)
      for (const int y : ys)
        for (const int x : xs)
          if (const int position = position_in_block({x, y, z}); block.observed.contains(position))
            values_[at][static_cast<std::size_t>(position)] = visibility(near, position);
  }

  // Steps between the block and the camera's.
  int level(int number) const {
    const Eigen::Vector3i& index = observation_.blocks[static_cast<std::size_t>(number)].index;
    return (index - block_of(camera_)).cwiseAbs().sum();
  }

  std::vector<std::vector<float>> take() && { return std::move(values_); }

 private:
  float visibility(const BlockSurroundings& near, int position) const {
    const Eigen::Vector3i voxel = voxel_at(near.index(), position);
    const Eigen::Vector3i to_camera = camera_ - voxel;
    if (to_camera.isZero()) return 1.0F;
    const int axis = entry_axis(frame_, voxel, to_camera);
    const double before = visibility_before(near, position, axis, direction_of(to_camera[axis]));
    return static_cast<float>(rule_.visibility(before, hidden_behind(near, position, to_camera)));
  }

  double visibility_before(const BlockSurroundings& near, int position, int axis,
                           int direction) const {
    const int number = near.number(position, axis, direction);
    if (number == BlockIndex::kNone) return 1.0;
    const auto at = static_cast<std::size_t>(number);
    const std::size_t before = BlockSurroundings::wrapped(position, axis, direction);
    const bool is_observed = observation_.blocks[at].observed.contains(static_cast<int>(before));
    return is_observed ? static_cast<double>(values_[at][before]) : 1.0;
  }

  double hidden_behind(const BlockSurroundings& near, int position,
                       const Eigen::Vector3i& to_camera) const {
    double hidden = 1.0;
    for (int axis = 0; axis < 3; ++axis)
      if (to_camera[axis] != 0)
        hidden = std::min(
            hidden, rule_.occupancy(near.voxel(position, axis, direction_of(to_camera[axis]))));
    return hidden;
  }

  const VisibilityRule& rule_;
  const FrameView& frame_;
  const FrameObservation& observation_;
  Eigen::Vector3i camera_;
  std::vector<BlockSurroundings> surroundings_;
  std::vector<std::vector<float>> values_;
};

}  // namespace

int entry_axis(const FrameView& frame, const Eigen::Vector3i& voxel,
               const Eigen::Vector3i& to_camera) {
  const Eigen::Vector3d apart_m =
      voxel_center_of(frame.params.voxel_size_m, voxel) - frame.T_world_camera.translation;
  int farthest = -1;
  for (int axis = 0; axis < 3; ++axis)
    if (to_camera[axis] != 0 &&
        (farthest < 0 || std::abs(apart_m[axis]) > std::abs(apart_m[farthest])))
      farthest = axis;
  return farthest;
}

std::vector<std::vector<float>> frame_visibility(const VisibilityRule& rule, const FrameView& frame,
                                                 const FrameObservation& observation,
                                                 const VoxelMap& map, int threads) {
  VisibilityField field(rule, frame, observation, map);
  std::vector<std::vector<int>> levels;
  for (int number = 0; number < static_cast<int>(observation.blocks.size()); ++number) {
    const auto level = static_cast<std::size_t>(field.level(number));
    levels.resize(std::max(levels.size(), level + 1));
    levels[level].push_back(number);
  }
  // Blocks of one level do not see each other: a step towards the camera leads to a lower level.
  for (const std::vector<int>& level : levels)
    parallel_for(0, static_cast<int>(level.size()), threads,
                 [&](int i) { field.fill(level[static_cast<std::size_t>(i)]); });
  return std::move(field).take();
}

}  // namespace stereovox
