#include "stereovox/pipeline/matched_frames.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <opencv2/core.hpp>
#include <thread>

#include "stereovox/stereo/rectification_check.h"

namespace stereovox {
namespace {

constexpr int kCheckedFrames = 5;
// Frames that wait between the halves; more would only cost memory.
constexpr std::size_t kQueueCapacity = 2;

std::optional<MatchedFrame> rectified(StereoSequence& sequence, const Rectifier& rectifier) {
  const std::optional<StereoFrame> frame = sequence.next();
  if (!frame) return std::nullopt;
  MatchedFrame out;
  out.index = frame->index;
  out.pair = timed(out.rectify, [&] { return rectifier.rectify(*frame); });
  return out;
}

// What a camera sees in the dark is its own noise.
constexpr double kMinBrightness_gray = 5.0;

bool is_dark(const RectifiedPair& pair) {
  return std::min(cv::mean(pair.left.pixels)[0], cv::mean(pair.right.pixels)[0]) <
         kMinBrightness_gray;
}

DisparityImage match_or_nothing(const RectifiedPair& pair, const MatcherParams& matcher,
                                int threads) {
  return is_dark(pair) ? empty_disparities(pair.left.pixels.size()) : match(pair, matcher, threads);
}

}  // namespace

// Makes frames on its own thread until the queue is full, the end is reached or it is destroyed.
class MatchedFrames::Worker {
 public:
  explicit Worker(MatchedFrames& frames)
      : thread_([this, &frames](const std::stop_token& stop) { run(stop, frames); }) {}

  std::optional<MatchedFrame> take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !queue_.empty() || is_finished_; });
    if (queue_.empty()) {
      if (failure_) std::rethrow_exception(failure_);
      return std::nullopt;
    }
    MatchedFrame frame = std::move(queue_.front());
    queue_.pop_front();
    changed_.notify_all();
    return frame;
  }

 private:
  void run(const std::stop_token& stop, MatchedFrames& frames) {
    try {
      while (std::optional<MatchedFrame> frame = frames.make_next())
        if (!put(stop, std::move(*frame))) break;
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    is_finished_ = true;
    changed_.notify_all();
  }

  // False when there is nobody left to take it.
  bool put(const std::stop_token& stop, MatchedFrame frame) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait(lock, stop, [&] { return queue_.size() < kQueueCapacity; })) return false;
    queue_.push_back(std::move(frame));
    changed_.notify_all();
    return true;
  }

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<MatchedFrame> queue_;
  bool is_finished_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;  // last: it uses the others
};

MatchedFrames::MatchedFrames(StereoSequence& sequence, const Rectifier& rectifier,
                             const PipelineConfig& config)
    : sequence_(sequence),
      rectifier_(rectifier),
      matcher_(config.matcher),
      threads_(config.thread_count()) {
  std::vector<CornerOffsets> offsets;
  while (checked_.size() < kCheckedFrames) {
    std::optional<MatchedFrame> frame = rectified(sequence_, rectifier_);
    if (!frame) break;
    offsets.push_back(measure_corner_offsets(frame->pair));
    checked_.push_back(std::move(*frame));
  }
  warning_ = judge(summarize(offsets), config.rectification, sequence_.info().path.string());
  std::ranges::reverse(checked_);
  if (config.thread_count() > 1) worker_ = std::make_unique<Worker>(*this);
}

MatchedFrames::~MatchedFrames() = default;

std::optional<MatchedFrame> MatchedFrames::next() {
  return worker_ ? worker_->take() : make_next();
}

std::optional<MatchedFrame> MatchedFrames::make_next() {
  std::optional<MatchedFrame> frame;
  if (checked_.empty()) {
    frame = rectified(sequence_, rectifier_);
  } else {
    frame = std::move(checked_.back());
    checked_.pop_back();
  }
  if (frame)
    frame->disparity =
        timed(frame->match, [&] { return match_or_nothing(frame->pair, matcher_, threads_); });
  return frame;
}

}  // namespace stereovox
