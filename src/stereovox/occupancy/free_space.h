// The space that a frame shows to be free, read from its image instead of walked ray by ray. A
// voxel is crossed when its near side lies before the free end of a ray that passes near its centre
// c:
//
//   |c| - 1/2 <= free end of some sample (pixel of the ray grid) in the window around c,
//
// lengths in voxels, c as seen from the camera. The image is cut into cells of 2^L x 2^L samples;
// the window is the four cells around the corner of cells that is nearest to c, with the largest L
// for which a cell is not wider than half the voxel's face at that depth, so that the window is
// about as large as the face. Where samples are farther apart than that, it is the one sample
// nearest to c. A centre beside the image counts with the nearest place in it as long as the face
// reaches into the image. Voxels less than a quarter of a voxel before the camera, or whose centres
// lie outside the height limits, are not crossed.
//
// Lengths and places are single precision relative to the camera, which is where the definition
// rounds; crossed_blocks() gives exactly the voxels of is_crossed().
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "stereovox/occupancy/frame_view.h"
#include "stereovox/occupancy/vector_target.h"
#include "stereovox/occupancy/voxel_mask.h"

namespace stereovox {

// Samples and, in levels, the largest and the smallest of 2^L x 2^L of them.
class ReachPyramid {
 public:
  static constexpr int kLevels = 8;

  ReachPyramid(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  // The square of how far from the camera the near half of a voxel is free, in voxels; negative:
  // nothing is. To be set before build().
  float* row(int v) { return largest_.get() + place(0, 0, v); }
  void build();

  struct Range {
    float smallest, largest;
  };
  // Of the samples [u0, u1] x [v0, v1], or of a few more.
  Range range_of(int u0, int v0, int u1, int v1) const;

  // Where cell (u, v) of a level is. The samples stand to the left; to their right, the levels from
  // 1 on, one below the other.
  const float* cells() const { return largest_.get(); }
  [[gnu::always_inline]] static int place(int width, int rows, int level, int u, int v) {
    const int above = rows - (2 * rows >> level);
    const int left = level > 0 ? width : 0;
    return ((above > 0 ? above : 0) + v) * stride_of(width) + left + u;
  }
  static constexpr int stride_of(int width) { return width + (width + 1) / 2; }
  int rows() const { return rows_; }

 private:
  std::size_t place(int level, int u, int v) const {
    return static_cast<std::size_t>(place(width_, rows_, level, u, v));
  }
  void build_level(int level);

  // The smallest have no samples to the left.
  std::size_t place_of_smallest(int level, int u, int v) const {
    const int stride = (width_ + 1) / 2;
    const int place = (rows_ - (2 * rows_ >> level) + v) * stride + u;
    return static_cast<std::size_t>(place);
  }

  int width_, height_, rows_;  // rows: of the array, a multiple of the largest cell
  std::unique_ptr<float[]> largest_, smallest_;
};

// The frame as seen by voxels: camera and lattice in single precision, lengths in voxels.
struct FreeSpaceView {
  std::array<float, 9> R_camera_world{};  // by rows
  std::array<float, 3> center_offset{};   // of voxel `camera_voxel` from the camera
  float focal_x = 0, focal_y = 0, center_x = 0, center_y = 0;  // in samples
  Eigen::Vector3i camera_voxel = Eigen::Vector3i::Zero();
  int first_layer = 0, last_layer = 0;  // along z, within the height limits
};

FreeSpaceView free_space_view(const FrameView& frame);

// Takes the place of a free end in metres, as row() of the pyramid holds it.
inline float reach_of(float free_end_m, double voxel_size_m) {
  constexpr float kHalfVoxel = 0.5F;
  const float reach = free_end_m / static_cast<float>(voxel_size_m) + kHalfVoxel;
  return free_end_m > 0.0F ? reach * reach : -1.0F;
}

bool is_crossed(const FreeSpaceView& view, const ReachPyramid& reach, const Eigen::Vector3i& voxel);

struct CrossedBlock {
  Eigen::Vector3i index;
  VoxelMask voxels;
};

// All blocks with crossed voxels, in an order that does not depend on the threads.
std::vector<CrossedBlock> crossed_blocks(const FreeSpaceView& view, const ReachPyramid& reach,
                                         int threads, VectorTarget target = best_target());

}  // namespace stereovox
