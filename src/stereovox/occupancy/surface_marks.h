// Step 2 of the pipeline, first half: which voxels the points of a frame speak for, and how
// strongly. Each block has a list of small pages of marks, so that a mark costs one store and those
// of a block lie side by side.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "stereovox/occupancy/block_index.h"
#include "stereovox/occupancy/frame_view.h"
#include "stereovox/occupancy/pixel_chunk.h"

namespace stereovox {

// Evidence of one point for one voxel of a block.
struct EvidenceMark {
  std::uint16_t place;  // in the block
  bool is_inside;       // the point lies in this voxel
  bool is_exact;        // its error is small against the voxel
  float evidence;

  int position() const { return place; }
  void add_to(VoxelEvidence& sum) const { sum.add(evidence, is_inside, is_exact); }
};

// The same when only the level of the evidence counts.
class LevelMark {
 public:
  LevelMark() = default;
  // `level`: 0 nothing, else 1 + that of the evidence.
  // Flags are numbers, 1 or 0: as bools they would be stored and loaded again.
  [[gnu::always_inline]] LevelMark(unsigned position, unsigned level, unsigned is_inside,
                                   unsigned is_exact) {
    const unsigned says = level > 0 ? 1 : 0;
    bits_ = static_cast<std::uint16_t>(position | (level - says) << kLevelBit |
                                       is_inside << kInsideBit | (is_exact & says) << kExactBit);
  }

  int position() const { return bits_ & (kVoxelsPerBlock - 1); }
  void add_to(VoxelEvidence& sum) const {
    static_assert(VoxelEvidence::kInside == 1 && VoxelEvidence::kExact == 2);
    const unsigned bits = bits_;
    sum.add_level(bits >> kLevelBit & (VoxelEvidence::kLevels - 1), bits >> kInsideBit);
  }

 private:
  static constexpr int kLevelBit = 9, kInsideBit = 14, kExactBit = 15;
  static_assert(1 << kLevelBit == kVoxelsPerBlock);
  static_assert(VoxelEvidence::kLevels == 1 << (kInsideBit - kLevelBit));
  std::uint16_t bits_;
};

// Successive points in the same voxel, which see all of it and nothing else.
struct PointsMark {
  std::uint16_t place;  // in the block
  std::uint8_t points;  // of a chunk
  bool is_exact;

  int position() const { return place; }
  void add_to(VoxelEvidence& sum) const {
    sum.add_level(VoxelEvidence::kLevels - 1,
                  VoxelEvidence::kInside | (is_exact ? VoxelEvidence::kExact : 0), points);
  }
};

template <class Mark>
class SurfaceMarks {
  struct Page;

 public:
  int points_used = 0;

  SurfaceMarks() = default;
  SurfaceMarks(const SurfaceMarks&) = delete;  // its lists know where it is
  SurfaceMarks& operator=(const SurfaceMarks&) = delete;

  // Where the marks of one block go. Good until another block is asked for.
  class List {
   public:
    explicit List(SurfaceMarks& marks) : marks_(marks) {}
    void add(const Mark& mark) {
      if (room_ == 0) open_page();
      last_->marks[--room_] = mark;
    }

   private:
    friend class SurfaceMarks;
    void open_page() {
      last_ = marks_.new_page(last_);
      room_ = kPageSize;
    }

    SurfaceMarks& marks_;
    Page* last_ = nullptr;
    std::size_t room_ = 0;  // in the last page, whose marks stand at its end
  };
  List& list_of(const Eigen::Vector3i& block) {
    return lists_[static_cast<std::size_t>(number_of(block))];
  }
  const std::vector<Eigen::Vector3i>& blocks() const { return blocks_; }

  // Calls visit(mark) for each mark of a block.
  template <class Visit>
  void for_each_in_block(std::size_t block, Visit visit) const {
    std::size_t first = lists_[block].room_;
    for (const Page* page = lists_[block].last_; page != nullptr;
         page = page->previous, first = 0) {
      fetch(page->previous);
      for (std::size_t i = first; i < kPageSize; ++i) visit(page->marks[i]);
    }
  }

 private:
  static constexpr std::size_t kPageBytes = 256, kPagesAtATime = 256;
  static constexpr std::size_t kPageSize = (kPageBytes - sizeof(void*)) / sizeof(Mark);

  struct Page {
    Page* previous;
    std::array<Mark, kPageSize> marks;
  };
  // A point near the corner of a block speaks for up to eight: each has a place of its own here.
  struct Recent {
    Eigen::Vector3i block = Eigen::Vector3i::Zero();
    int number = BlockIndex::kNone;
  };

  // Into the cache, while the page before is read.
  static void fetch(const Page* page) {
    constexpr std::size_t kCacheLine = 64;
    const auto* const bytes = reinterpret_cast<const char*>(page);
    for (std::size_t i = 0; i < sizeof(Page); i += kCacheLine) __builtin_prefetch(bytes + i);
  }
  Page* new_page(Page* previous) {
    if (pages_used_ == pages_.size() * kPagesAtATime)
      pages_.push_back(std::make_unique_for_overwrite<Page[]>(kPagesAtATime));
    Page* const page = &pages_.back()[pages_used_++ % kPagesAtATime];
    page->previous = previous;
    return page;
  }
  int number_of(const Eigen::Vector3i& block) {
    Recent& recent = recent_[static_cast<std::size_t>((block.x() & 1) | (block.y() & 1) << 1 |
                                                      (block.z() & 1) << 2)];
    if (recent.number != BlockIndex::kNone && recent.block == block) return recent.number;
    recent = {block, index_.find_or_insert(block)};
    if (recent.number == static_cast<int>(blocks_.size())) {
      blocks_.push_back(block);
      lists_.emplace_back(*this);
    }
    return recent.number;
  }

  BlockIndex index_;
  std::vector<Eigen::Vector3i> blocks_;
  std::vector<List> lists_;
  std::vector<std::unique_ptr<Page[]>> pages_;
  std::size_t pages_used_ = 0;
  std::array<Recent, 8> recent_{};
};

// Which marks tell all that these parameters ask of the points.
enum class MarkKind { evidence, levels, points };
MarkKind sufficient_marks(const FrameView& frame);

// Adds the marks of the points of these pixels.
void mark_points(const FrameView& frame, const PixelChunk& chunk, SurfaceMarks<PointsMark>& marks);
void mark_levels(const FrameView& frame, const PixelChunk& chunk, AxisLevels& levels,
                 SurfaceMarks<LevelMark>& marks);
void mark_evidence(const FrameView& frame, const PixelRun& run, SurfaceMarks<EvidenceMark>& marks);

}  // namespace stereovox
