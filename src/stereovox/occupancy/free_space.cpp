#include "stereovox/occupancy/free_space.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "stereovox/core/parallel.h"

namespace stereovox {
namespace {

constexpr float kNearest_voxels = 0.25F;
constexpr float kHalf = 0.5F;
constexpr float kLargestCell = static_cast<float>(1 << (ReachPyramid::kLevels - 1));

// What one voxel asks of the pyramid: it is crossed when one of four cells reaches `distance2` and
// more.
struct Question {
  float distance2;         // infinite when nothing can reach it
  int place, right, down;  // of the first cell, and from there to the others
};

[[gnu::always_inline]] inline float answer(const float* cells, int place, int right, int down) {
  const float* const first = cells + place;
  return std::max(std::max(first[0], first[right]), std::max(first[down], first[right + down]));
}

// The size of the pyramid, in the ways that the questions need it.
struct PyramidShape {
  int width, rows;
  float last_u, last_v;
};

PyramidShape shape_of(const ReachPyramid& reach) {
  return {reach.width(), reach.rows(), static_cast<float>(reach.width() - 1),
          static_cast<float>(reach.height() - 1)};
}

[[gnu::always_inline]] inline float clamped(float value, float low, float high) {
  const float not_below = value > low ? value : low;
  return not_below < high ? not_below : high;
}

struct Pair {
  int first, second;
};

// The two cells on both sides of the border between cells that is nearest to a place, or the one
// sample nearest to it when samples are farther apart than the face's half.
[[gnu::always_inline]] inline Pair cells_around(float place, float cells_per_sample,
                                                float half_face, float last) {
  const int last_cell = static_cast<int>(last * cells_per_sample);
  const int sample = static_cast<int>(place + kHalf);
  const int border = static_cast<int>((place + kHalf) * cells_per_sample + kHalf);
  const int low = border > 0 ? border - 1 : 0, high = border < last_cell ? border : last_cell;
  return {half_face < 1.0F ? sample : low, half_face < 1.0F ? sample : high};
}

// `x`, `y`, `z`: the voxel's centre relative to the camera along the axes of the world.
[[gnu::always_inline]] inline Question question_of(const FreeSpaceView& view,
                                                   const PyramidShape& shape, float x, float y,
                                                   float z) {
  const auto& R = view.R_camera_world;
  const float right = R[0] * x + (R[1] * y + R[2] * z);
  const float down = R[3] * x + (R[4] * y + R[5] * z);
  const float depth = R[6] * x + (R[7] * y + R[8] * z);
  const float inverse = 1.0F / (depth > kNearest_voxels ? depth : kNearest_voxels);
  const float u = (view.focal_x * right) * inverse + view.center_x;
  const float v = (view.focal_y * down) * inverse + view.center_y;
  const float half_face = (kHalf * view.focal_x) * inverse;

  const float u_inside = clamped(u, 0.0F, shape.last_u), v_inside = clamped(v, 0.0F, shape.last_v);
  const float margin = half_face > kHalf ? half_face : kHalf;
  const bool is_seen = (depth >= kNearest_voxels) & (std::abs(u - u_inside) <= margin) &
                       (std::abs(v - v_inside) <= margin);
  // The exponent of a single precision number is the logarithm that is asked for.
  constexpr int kMantissaBits = 23, kExponentOfOne = 127;
  const int level = (std::bit_cast<int>(clamped(half_face, 1.0F, kLargestCell)) >> kMantissaBits) -
                    kExponentOfOne;
  const float cells_per_sample = std::bit_cast<float>((kExponentOfOne - level) << kMantissaBits);
  const Pair across = cells_around(u_inside, cells_per_sample, half_face, shape.last_u);
  const Pair along = cells_around(v_inside, cells_per_sample, half_face, shape.last_v);
  const float distance2 = x * x + (y * y + z * z);
  return {is_seen ? distance2 : std::numeric_limits<float>::infinity(),
          ReachPyramid::place(shape.width, shape.rows, level, across.first, along.first),
          across.second - across.first,
          (along.second - along.first) * ReachPyramid::stride_of(shape.width)};
}

[[gnu::always_inline]] inline float center_of(const FreeSpaceView& view, int axis, int voxel) {
  return static_cast<float>(voxel - view.camera_voxel[axis]) +
         view.center_offset[static_cast<std::size_t>(axis)];
}

// Blocks are asked by their eighths, of which few are as mixed as the whole.
constexpr int kOctants = 8;
constexpr int kOctantSideLog2 = kBlockSideLog2 - 1, kOctantSide = 1 << kOctantSideLog2;
constexpr std::size_t kOctantVoxels = 1 << 3 * kOctantSideLog2;

Eigen::Vector3i first_of_octant(const Eigen::Vector3i& block, int octant) {
  return block * kBlockSide +
         kOctantSide * Eigen::Vector3i(octant & 1, octant >> 1 & 1, octant >> 2);
}

struct OctantQuestions {
  std::array<float, kOctantVoxels> distance2;
  std::array<int, kOctantVoxels> place, right, down;
};

struct AskOctant {
  [[gnu::always_inline]] void operator()(const FreeSpaceView& view, const PyramidShape& shape,
                                         const Eigen::Vector3i& first, OctantQuestions& out) const {
    // NOLINTNEXTLINE(performance-unnecessary-copy-initialization): else `out` might change it
    const FreeSpaceView v = view;
    const PyramidShape s = shape;
    const int x = first.x(), y = first.y(), z = first.z();
    constexpr int kLast = kOctantSide - 1;
    for (int i = 0; i < static_cast<int>(kOctantVoxels); ++i) {
      const Question q = question_of(v, s, center_of(v, 0, x + (i & kLast)),
                                     center_of(v, 1, y + (i >> kOctantSideLog2 & kLast)),
                                     center_of(v, 2, z + (i >> 2 * kOctantSideLog2)));
      out.distance2[static_cast<std::size_t>(i)] = q.distance2;
      out.place[static_cast<std::size_t>(i)] = q.place;
      out.right[static_cast<std::size_t>(i)] = q.right;
      out.down[static_cast<std::size_t>(i)] = q.down;
    }
  }
};

// Bit i: the voxel that is asked i-th.
std::uint64_t crossed_of(const OctantQuestions& questions, const float* cells) {
  std::array<float, kOctantVoxels> reached;
  for (std::size_t i = 0; i < kOctantVoxels; ++i)
    reached[i] = answer(cells, questions.place[i], questions.right[i], questions.down[i]);
  std::array<std::uint8_t, kOctantVoxels> is_crossed;
  for (std::size_t i = 0; i < kOctantVoxels; ++i)
    is_crossed[i] = questions.distance2[i] <= reached[i] ? 1 : 0;
  return bits_of_bytes(is_crossed);
}

// Voxels of an octant, in the order in which they are asked, to their places in the block.
void set_octant(int octant, std::uint64_t voxels, VoxelMask& block) {
  static_assert(kOctantSide == 4 && kBlockSide == 8);
  const Eigen::Vector3i first = first_of_octant(Eigen::Vector3i::Zero(), octant);
  for (int z = 0; z < kOctantSide; ++z) {
    // The four rows of four voxels, apart as the rows of the block are.
    std::uint64_t rows = voxels >> z * kOctantSide * kOctantSide & 0xffff;
    rows = (rows | rows << 8) & 0x00ff00ff;
    rows = (rows | rows << 4) & 0x0f0f0f0f;
    const int layer = first.z() + z, place = first.y() * kBlockSide + first.x();
    block.words[static_cast<std::size_t>(layer)] |= rows << place;
  }
}

bool is_layer_within(const FreeSpaceView& view, int z) {
  return view.first_layer <= z && z <= view.last_layer;
}

enum class Crossed { nothing, something, everything };

// A cube of voxels as the camera sees it: bounds on its distance and its place in the image. They
// are wide enough for the rounding of the questions.
class SeenCube {
 public:
  SeenCube(const FreeSpaceView& view, const Eigen::Vector3i& first, int side) {
    const float half = kHalf * static_cast<float>(side - 1);  // from centre to centre
    std::array<float, 3> p{};
    float near2 = 0.0F, far2 = 0.0F;
    for (int k = 0; k < 3; ++k) {
      const float middle = p[std::size_t(k)] = center_of(view, k, first[k]) + half;
      const float near = std::max(0.0F, std::abs(middle) - half), far = std::abs(middle) + half;
      near2 += near * near, far2 += far * far;
    }
    for (std::size_t row = 0; row < 3; ++row) {
      const float* const r = view.R_camera_world.data() + 3 * row;
      middle_[row] = r[0] * p[0] + r[1] * p[1] + r[2] * p[2];
      extent_[row] = (std::abs(r[0]) + std::abs(r[1]) + std::abs(r[2])) * half + kSlack;
    }
    nearest2_ = near2 * (1.0F - kRelativeSlack);
    farthest2_ = far2 * (1.0F + kRelativeSlack);
  }

  // Squares of distances from the camera, over the centres of its voxels.
  float nearest2() const { return nearest2_; }
  float farthest2() const { return farthest2_; }
  bool is_behind() const { return middle_[2] + extent_[2] < kNearest_voxels; }
  bool reaches_behind() const { return middle_[2] - extent_[2] < 1.0F; }

  struct Interval {
    float low, high;
  };
  Interval seen_across(std::size_t axis, float focal, float center) const {
    const float inverse_near = 1.0F / (middle_[2] - extent_[2]);
    const float inverse_far = 1.0F / (middle_[2] + extent_[2]);
    const float low = middle_[axis] - extent_[axis], high = middle_[axis] + extent_[axis];
    return {focal * low * (low < 0.0F ? inverse_near : inverse_far) + center - kSlack,
            focal * high * (high < 0.0F ? inverse_far : inverse_near) + center + kSlack};
  }
  float largest_half_face(float focal) const {
    return kHalf * focal / (middle_[2] - extent_[2]) + kHalf;
  }

 private:
  static constexpr float kSlack = 0.01F, kRelativeSlack = 1e-4F;

  std::array<float, 3> middle_{}, extent_{};
  float nearest2_, farthest2_;
};

// Whether the voxels of a cube are crossed, as far as the pyramid tells without asking each.
class CubeTest {
 public:
  CubeTest(const FreeSpaceView& view, const ReachPyramid& reach) : view_(view), reach_(reach) {}

  Crossed of(const Eigen::Vector3i& first, int side) const {
    if (first.z() > view_.last_layer || first.z() + side <= view_.first_layer)
      return Crossed::nothing;
    const SeenCube seen(view_, first, side);
    if (seen.is_behind()) return Crossed::nothing;
    if (seen.reaches_behind()) return Crossed::something;
    return of(seen);
  }

 private:
  Crossed of(const SeenCube& seen) const {
    // A window may reach half a cell farther, but the pyramid answers for whole cells, and here for
    // larger ones.
    const float margin = seen.largest_half_face(view_.focal_x) + 1.0F;
    const auto across = seen.seen_across(0, view_.focal_x, view_.center_x);
    const auto down = seen.seen_across(1, view_.focal_y, view_.center_y);
    const auto last_u = static_cast<float>(reach_.width() - 1);
    const auto last_v = static_cast<float>(reach_.height() - 1);
    if (across.high < -margin || down.high < -margin || across.low > last_u + margin ||
        down.low > last_v + margin)
      return Crossed::nothing;

    const auto sample = [](float place, float last) {
      return static_cast<int>(clamped(place, 0.0F, last));
    };
    const bool is_inside =
        across.low >= 0.0F && down.low >= 0.0F && across.high <= last_u && down.high <= last_v;
    const auto near = reach_.range_of(
        sample(across.low - margin, last_u), sample(down.low - margin, last_v),
        sample(across.high + margin + 1.0F, last_u), sample(down.high + margin + 1.0F, last_v));
    if (near.largest < 0.0F || seen.nearest2() > near.largest) return Crossed::nothing;
    const bool is_all = is_inside && near.smallest > 0.0F && seen.farthest2() < near.smallest;
    return is_all ? Crossed::everything : Crossed::something;
  }

  const FreeSpaceView& view_;
  const ReachPyramid& reach_;
};

struct FoundBlock {
  Eigen::Vector3i index;
  Crossed crossed;
};

std::uint64_t crossed_in_octant(const FreeSpaceView& view, const ReachPyramid& reach,
                                const Eigen::Vector3i& first, VectorTarget target) {
  const Crossed crossed = CubeTest(view, reach).of(first, kOctantSide);
  if (crossed != Crossed::something) return crossed == Crossed::nothing ? 0 : ~std::uint64_t{0};
  OctantQuestions questions;
  const PyramidShape shape = shape_of(reach);
  run_on(target, AskOctant{}, view, shape, first, questions);
  return crossed_of(questions, reach.cells());
}

VoxelMask crossed_by_octants(const FreeSpaceView& view, const ReachPyramid& reach,
                             const Eigen::Vector3i& block, VectorTarget target) {
  VoxelMask crossed;
  for (int octant = 0; octant < kOctants; ++octant)
    set_octant(octant, crossed_in_octant(view, reach, first_of_octant(block, octant), target),
               crossed);
  return crossed;
}

VoxelMask crossed_in_block(const FreeSpaceView& view, const ReachPyramid& reach,
                           const FoundBlock& block, VectorTarget target) {
  VoxelMask crossed;
  crossed.words.fill(~std::uint64_t{0});
  if (block.crossed == Crossed::something)
    crossed = crossed_by_octants(view, reach, block.index, target);
  for (int z = 0; z < kBlockSide; ++z)
    if (!is_layer_within(view, block.index.z() * kBlockSide + z))
      crossed.words[static_cast<std::size_t>(z)] = 0;
  return crossed;
}

class BlockSearch {
 public:
  BlockSearch(const FreeSpaceView& view, const ReachPyramid& reach)
      : view_(view), reach_(reach), cube_(view, reach) {
    const auto all = reach.range_of(0, 0, reach.width() - 1, reach.height() - 1);
    if (all.largest > 0.0F) search_within(std::sqrt(all.largest));
  }

  std::vector<FoundBlock> found;

 private:
  static constexpr int kRootLog2 = 3;  // cubes of 8 x 8 x 8 blocks to begin with

  void search_within(float reach) {
    const VoxelBounds bounds = bounds_of(reach);
    constexpr int kShift = kBlockSideLog2 + kRootLog2;
    for (int x = bounds.min.x() >> kShift; x <= bounds.max.x() >> kShift; ++x)
      for (int y = bounds.min.y() >> kShift; y <= bounds.max.y() >> kShift; ++y)
        for (int z = bounds.min.z() >> kShift; z <= bounds.max.z() >> kShift; ++z)
          search({x, y, z}, kRootLog2, Crossed::something);
  }

  // Of the pyramid of rays to all samples, up to this depth.
  VoxelBounds bounds_of(float reach) const {
    constexpr float kMargin_voxels = 2.0F;
    Eigen::Array3f low = Eigen::Array3f::Zero(), high = low;
    const auto& R = view_.R_camera_world;
    for (const float u : {-1.0F, static_cast<float>(reach_.width())})
      for (const float v : {-1.0F, static_cast<float>(reach_.height())}) {
        const float a = (u - view_.center_x) / view_.focal_x;
        const float b = (v - view_.center_y) / view_.focal_y;
        const Eigen::Array3f ray(R[0] * a + R[3] * b + R[6], R[1] * a + R[4] * b + R[7],
                                 R[2] * a + R[5] * b + R[8]);
        low = low.min(reach * ray), high = high.max(reach * ray);
      }
    VoxelBounds bounds{view_.camera_voxel + (low - kMargin_voxels).floor().cast<int>().matrix(),
                       view_.camera_voxel + (high + kMargin_voxels).ceil().cast<int>().matrix()};
    bounds.min.z() = std::max(bounds.min.z(), view_.first_layer);
    bounds.max.z() = std::min(bounds.max.z(), view_.last_layer);
    return bounds;
  }

  // `cube` counts in cubes of 2^level blocks a side.
  void search(const Eigen::Vector3i& cube, int level, Crossed crossed) {
    const int side = kBlockSide << level;
    if (crossed == Crossed::something) crossed = cube_.of(cube * side, side);
    if (crossed == Crossed::nothing) return;
    if (level == 0) {
      found.push_back({cube, crossed});
      return;
    }
    for (int part = 0; part < 8; ++part)
      search(2 * cube + Eigen::Vector3i(part & 1, part >> 1 & 1, part >> 2), level - 1, crossed);
  }

  const FreeSpaceView& view_;
  const ReachPyramid& reach_;
  const CubeTest cube_;
};

}  // namespace

ReachPyramid::ReachPyramid(int width, int height) : width_(width), height_(height) {
  constexpr int kLargest = 1 << (kLevels - 1);
  rows_ = (height + kLargest - 1) / kLargest * kLargest;
  const auto cells = [&](int stride) {
    return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(stride);
  };
  largest_ = std::make_unique_for_overwrite<float[]>(cells(stride_of(width)));
  smallest_ = std::make_unique_for_overwrite<float[]>(cells((width + 1) / 2));
}

void ReachPyramid::build() {
  for (int level = 1; level < kLevels; ++level) build_level(level);
}

void ReachPyramid::build_level(int level) {
  const int fine_width = ((width_ - 1) >> (level - 1)) + 1;
  const int fine_height = ((height_ - 1) >> (level - 1)) + 1;
  for (int v = 0; v <= (fine_height - 1) / 2; ++v) {
    const int below = std::min(2 * v + 1, fine_height - 1);
    const auto rows = [&](const float* cells, auto place_in) {
      return std::array{cells + place_in(level - 1, 2 * v), cells + place_in(level - 1, below)};
    };
    const auto in_largest = [&](int at, int row) { return place(at, 0, row); };
    const auto in_smallest = [&](int at, int row) { return place_of_smallest(at, 0, row); };
    const auto most = rows(largest_.get(), in_largest);
    const auto least = level == 1 ? most : rows(smallest_.get(), in_smallest);
    float* const to_most = largest_.get() + place(level, 0, v);
    float* const to_least = smallest_.get() + place_of_smallest(level, 0, v);
    const auto join = [&](int u, int left, int right) {
      to_most[u] = std::max(std::max(most[0][left], most[0][right]),
                            std::max(most[1][left], most[1][right]));
      to_least[u] = std::min(std::min(least[0][left], least[0][right]),
                             std::min(least[1][left], least[1][right]));
    };
    for (int u = 0; u < fine_width / 2; ++u) join(u, 2 * u, 2 * u + 1);
    if (fine_width % 2 == 1) join(fine_width / 2, fine_width - 1, fine_width - 1);
  }
}

ReachPyramid::Range ReachPyramid::range_of(int u0, int v0, int u1, int v1) const {
  constexpr int kMostCells = 4;
  int level = 1;
  while (level < kLevels - 1 && ((u1 >> level) - (u0 >> level) >= kMostCells ||
                                 (v1 >> level) - (v0 >> level) >= kMostCells))
    ++level;
  Range range{std::numeric_limits<float>::infinity(), -1.0F};
  for (int v = v0 >> level; v <= v1 >> level; ++v)
    for (int u = u0 >> level; u <= u1 >> level; ++u) {
      range.smallest = std::min(range.smallest, smallest_[place_of_smallest(level, u, v)]);
      range.largest = std::max(range.largest, largest_[place(level, u, v)]);
    }
  return range;
}

FreeSpaceView free_space_view(const FrameView& frame) {
  const double size_m = frame.params.voxel_size_m;
  const double step = frame.steps.ray_px, first = first_sample(frame.steps.ray_px);
  const PinholeCamera& c = frame.camera.pinhole;
  FreeSpaceView view;
  const Eigen::Matrix3d R = frame.measuring.R_world_camera.transpose();
  for (int i = 0; i < 9; ++i)
    view.R_camera_world[static_cast<std::size_t>(i)] = static_cast<float>(R(i / 3, i % 3));
  const Eigen::Vector3d& camera_m = frame.T_world_camera.translation;
  view.camera_voxel = voxel_index_of(size_m, camera_m);
  for (int k = 0; k < 3; ++k)
    view.center_offset[static_cast<std::size_t>(k)] =
        static_cast<float>(view.camera_voxel[k] + 0.5 - camera_m[k] / size_m);
  view.focal_x = static_cast<float>(c.fx_px / step);
  view.focal_y = static_cast<float>(c.fy_px / step);
  view.center_x = static_cast<float>((c.cx_px - first) / step);
  view.center_y = static_cast<float>((c.cy_px - first) / step);
  view.first_layer = static_cast<int>(std::ceil(frame.min_z_m / size_m - 0.5));
  view.last_layer = static_cast<int>(std::floor(frame.max_z_m / size_m - 0.5));
  return view;
}

bool is_crossed(const FreeSpaceView& view, const ReachPyramid& reach,
                const Eigen::Vector3i& voxel) {
  if (!is_layer_within(view, voxel.z())) return false;
  const Question q = question_of(view, shape_of(reach), center_of(view, 0, voxel.x()),
                                 center_of(view, 1, voxel.y()), center_of(view, 2, voxel.z()));
  return q.distance2 <= answer(reach.cells(), q.place, q.right, q.down);
}

std::vector<CrossedBlock> crossed_blocks(const FreeSpaceView& view, const ReachPyramid& reach,
                                         int threads, VectorTarget target) {
  const BlockSearch search(view, reach);
  std::vector<CrossedBlock> crossed(search.found.size());
  constexpr int kBlocksAtATime = 32;
  const int count = static_cast<int>(crossed.size());
  parallel_for(0, (count + kBlocksAtATime - 1) / kBlocksAtATime, threads, [&](int share) {
    const int end = std::min(count, (share + 1) * kBlocksAtATime);
    for (int i = share * kBlocksAtATime; i < end; ++i) {
      const FoundBlock& block = search.found[static_cast<std::size_t>(i)];
      crossed[static_cast<std::size_t>(i)] = {block.index,
                                              crossed_in_block(view, reach, block, target)};
    }
  });
  std::erase_if(crossed, [](const CrossedBlock& block) { return block.voxels.is_empty(); });
  return crossed;
}

}  // namespace stereovox
