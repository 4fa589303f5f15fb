// Step 2 of the pipeline, first half: which voxels the points of a frame speak for, and how
// strongly. Marks are kept in the order in which they come, in one array; a run of successive ones
// in the same block is linked to that block's run before. So a mark costs one store.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "stereovox/occupancy/block_index.h"
#include "stereovox/occupancy/frame_view.h"
#include "stereovox/occupancy/pixel_chunk.h"

namespace stereovox {

// Evidence of one point for one voxel of a block.
struct EvidenceMark {
  std::uint16_t place = 0;  // in the block
  bool is_inside = false;   // the point lies in this voxel
  bool is_exact = false;    // its error is small against the voxel
  float evidence = 0.0F;

  int position() const { return place; }
  void add_to(VoxelEvidence& sum) const { sum.add(evidence, is_inside, is_exact); }
};

// The same when only the level of the evidence counts.
class LevelMark {
 public:
  LevelMark() = default;
  LevelMark(int position, int level, bool is_inside, bool is_exact)
      : bits_(static_cast<std::uint16_t>(position | level << kLevelBit |
                                         int{is_inside} << kInsideBit |
                                         int{is_exact} << kExactBit)) {}

  int position() const { return bits_ & (kVoxelsPerBlock - 1); }
  void add_to(VoxelEvidence& sum) const {
    sum.add_level(bits_ >> kLevelBit & (VoxelEvidence::kLevels - 1), (bits_ >> kInsideBit & 1) != 0,
                  bits_ >> kExactBit != 0);
  }

 private:
  static constexpr int kLevelBit = 9, kInsideBit = 14, kExactBit = 15;
  static_assert(1 << kLevelBit == kVoxelsPerBlock);
  static_assert(VoxelEvidence::kLevels == 1 << (kInsideBit - kLevelBit));
  std::uint16_t bits_ = 0;
};

template <class Mark>
class SurfaceMarks {
 public:
  static constexpr std::uint32_t kNoRun = ~std::uint32_t{0};

  int points_used = 0;

  // Later marks belong to this block.
  void open(const Eigen::Vector3i& block) {
    if (open_block_ != BlockIndex::kNone && block == open_place_) return;
    close();
    open_block_ = number_of(block);
    open_place_ = block;
    run_begin_ = marks_.size();
  }
  void add(const Mark& mark) { marks_.push_back(mark); }
  void close() {
    if (open_block_ == BlockIndex::kNone) return;
    if (run_begin_ < marks_.size()) end_run();
    open_block_ = BlockIndex::kNone;
  }
  const std::vector<Eigen::Vector3i>& blocks() const { return blocks_; }

  // Calls visit(mark) for each mark of a block, runs from the last to the first; after close().
  template <class Visit>
  void for_each_in_block(std::size_t block, Visit visit) const {
    for (std::uint32_t run = last_run_[block]; run != kNoRun; run = runs_[run].previous)
      for (std::uint32_t i = runs_[run].begin; i < runs_[run].end; ++i) visit(marks_[i]);
  }

 private:
  struct Run {
    std::uint32_t begin, end, previous;
  };
  // A point near the corner of a block speaks for up to eight: each has a place of its own here.
  struct Recent {
    Eigen::Vector3i block = Eigen::Vector3i::Zero();
    int number = BlockIndex::kNone;
  };

  void end_run() {
    std::uint32_t& last = last_run_[static_cast<std::size_t>(open_block_)];
    runs_.push_back(
        {static_cast<std::uint32_t>(run_begin_), static_cast<std::uint32_t>(marks_.size()), last});
    last = static_cast<std::uint32_t>(runs_.size() - 1);
  }
  int number_of(const Eigen::Vector3i& block) {
    Recent& recent = recent_[static_cast<std::size_t>((block.x() & 1) | (block.y() & 1) << 1 |
                                                      (block.z() & 1) << 2)];
    if (recent.number != BlockIndex::kNone && recent.block == block) return recent.number;
    recent = {block, index_.find_or_insert(block)};
    if (recent.number == static_cast<int>(blocks_.size())) {
      blocks_.push_back(block);
      last_run_.push_back(kNoRun);
    }
    return recent.number;
  }

  BlockIndex index_;
  std::vector<Eigen::Vector3i> blocks_;
  std::vector<std::uint32_t> last_run_;
  std::vector<Run> runs_;
  std::vector<Mark> marks_;
  std::array<Recent, 8> recent_{};
  int open_block_ = BlockIndex::kNone;
  Eigen::Vector3i open_place_ = Eigen::Vector3i::Zero();
  std::size_t run_begin_ = 0;
};

// Whether levels are all that these parameters ask of the points, so that mark_levels may be used.
bool levels_suffice(const FrameView& frame);

// Adds the marks of the points of these pixels.
void mark_levels(const FrameView& frame, const PixelChunk& chunk, AxisLevels& levels,
                 SurfaceMarks<LevelMark>& marks);
void mark_evidence(const FrameView& frame, const PixelRun& run, SurfaceMarks<EvidenceMark>& marks);

}  // namespace stereovox
