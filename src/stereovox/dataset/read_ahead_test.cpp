#include "stereovox/dataset/read_ahead.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "stereovox/core/error.h"
#include "stereovox/dataset/small_data_set.h"

namespace stereovox {
namespace {

using testing::ElementsAre;

// Counts frames up, marks every third one as skipped and fails at the end when asked to.
class CountingSequence final : public StereoSequence {
 public:
  CountingSequence(int frames, bool fails_at_end, std::atomic<int>& read)
      : frames_(frames), fails_at_end_(fails_at_end), read_(read) {}

  const StereoRig& rig() const override { return rig_; }
  const SequenceInfo& info() const override { return info_; }
  const Trajectory& truth() const override { return truth_; }
  std::span<const SkippedPair> skipped() const override { return skipped_; }
  std::optional<StereoFrame> next() override {
    if (next_ % 3 == 2) {
      skipped_.push_back({std::to_string(next_++), "bad"});
      info_.remarks.push_back("remark");
    }
    if (next_ >= frames_ && fails_at_end_) throw Error("the disk is gone");
    if (next_ >= frames_) return std::nullopt;
    ++read_;
    return StereoFrame{next_, next_++, "", {cv::Mat1b(1, 1, uchar(next_))}, {}};
  }

 private:
  int frames_;
  bool fails_at_end_;
  std::atomic<int>& read_;
  int next_ = 0;
  StereoRig rig_;
  SequenceInfo info_;
  Trajectory truth_;
  std::vector<SkippedPair> skipped_;
};

std::unique_ptr<StereoSequence> counting(int frames, bool fails_at_end, int capacity,
                                         std::atomic<int>& read) {
  return read_ahead(std::make_unique<CountingSequence>(frames, fails_at_end, read), capacity);
}

TEST(ReadAhead, DeliversTheSameFramesSkippedPairsAndRemarks) {
  std::atomic<int> read = 0;
  const auto sequence = counting(8, false, 2, read);
  std::vector<int> indices;
  std::vector<std::size_t> skipped;
  while (const auto frame = sequence->next()) {
    indices.push_back(frame->index);
    skipped.push_back(sequence->skipped().size());
  }
  EXPECT_THAT(indices, ElementsAre(0, 1, 3, 4, 6, 7));
  EXPECT_THAT(skipped, ElementsAre(0, 0, 1, 1, 2, 2));  // never more than belongs to the frame
  EXPECT_EQ(sequence->info().remarks.size(), 3U);
  EXPECT_FALSE(sequence->next());
}

TEST(ReadAhead, PassesAnErrorAfterTheFramesBeforeIt) {
  std::atomic<int> read = 0;
  const auto sequence = counting(2, true, 5, read);
  EXPECT_TRUE(sequence->next());
  EXPECT_TRUE(sequence->next());
  EXPECT_THROW(sequence->next(), Error);
  EXPECT_FALSE(sequence->next());
}

TEST(ReadAhead, NeverReadsFartherThanItsCapacity) {
  std::atomic<int> read = 0;
  const auto sequence = counting(1000, false, 3, read);
  sequence->next();
  for (int look = 0; look < 50; ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_LE(read, 1 + 3 + 1);  // delivered, waiting, and one in hand
  }
  EXPECT_GE(read, 1 + 3);
}

TEST(ReadAhead, CanBeDestroyedWhileFullAndWhileEmpty) {
  std::atomic<int> read = 0;
  for (int repeat = 0; repeat < 200; ++repeat) counting(1000, false, 1 + repeat % 3, read);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const auto sequence = counting(3, false, 2, read);
    for (int i = 0; i < repeat % 5; ++i) sequence->next();
  }
  EXPECT_THROW(counting(1, false, 0, read), std::logic_error);
}

}  // namespace
}  // namespace stereovox
