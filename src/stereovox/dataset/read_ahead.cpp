#include "stereovox/dataset/read_ahead.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace stereovox {
namespace {

// What one call of next() brought: a frame, the end or an exception, and what was said on the way.
struct Outcome {
  std::optional<StereoFrame> frame;
  std::exception_ptr exception;
  std::vector<SkippedPair> skipped;
  std::vector<std::string> remarks;

  bool is_last() const { return !frame; }
};

class ReadAhead final : public StereoSequence {
 public:
  ReadAhead(std::unique_ptr<StereoSequence> sequence, int capacity)
      : sequence_(std::move(sequence)),
        capacity_(static_cast<std::size_t>(capacity)),
        info_(sequence_->info()),
        skipped_(sequence_->skipped().begin(), sequence_->skipped().end()),
        reader_([this](const std::stop_token& stop) { read(stop); }) {}

  const StereoRig& rig() const override { return sequence_->rig(); }
  const Trajectory& truth() const override { return sequence_->truth(); }
  const SequenceInfo& info() const override { return info_; }
  std::span<const SkippedPair> skipped() const override { return skipped_; }

  std::optional<StereoFrame> next() override {
    if (has_ended_) return std::nullopt;
    Outcome outcome = take();
    has_ended_ = outcome.is_last();
    std::ranges::move(outcome.skipped, std::back_inserter(skipped_));
    std::ranges::move(outcome.remarks, std::back_inserter(info_.remarks));
    if (outcome.exception) std::rethrow_exception(outcome.exception);
    return std::move(outcome.frame);
  }

 private:
  Outcome take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !queue_.empty(); });
    Outcome outcome = std::move(queue_.front());
    queue_.pop_front();
    lock.unlock();
    changed_.notify_all();
    return outcome;
  }

  void read(const std::stop_token& stop) {
    std::size_t known_skipped = skipped_.size(), known_remarks = info_.remarks.size();
    while (!stop.stop_requested()) {
      Outcome outcome = read_one(known_skipped, known_remarks);
      const bool is_last = outcome.is_last();
      known_skipped += outcome.skipped.size();
      known_remarks += outcome.remarks.size();
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return queue_.size() < capacity_; })) return;
      queue_.push_back(std::move(outcome));
      lock.unlock();
      changed_.notify_all();
      if (is_last) return;
    }
  }

  Outcome read_one(std::size_t known_skipped, std::size_t known_remarks) {
    Outcome outcome;
    try {
      outcome.frame = sequence_->next();
    } catch (...) {
      outcome.exception = std::current_exception();
    }
    const std::span<const SkippedPair> skipped = sequence_->skipped().subspan(known_skipped);
    outcome.skipped.assign(skipped.begin(), skipped.end());
    const std::vector<std::string>& remarks = sequence_->info().remarks;
    outcome.remarks.assign(remarks.begin() + static_cast<std::ptrdiff_t>(known_remarks),
                           remarks.end());
    return outcome;
  }

  std::unique_ptr<StereoSequence> sequence_;
  std::size_t capacity_;
  SequenceInfo info_;
  std::vector<SkippedPair> skipped_;
  bool has_ended_ = false;

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Outcome> queue_;
  std::jthread reader_;  // last: it must stop before what it uses goes
};

}  // namespace

std::unique_ptr<StereoSequence> read_ahead(std::unique_ptr<StereoSequence> sequence, int capacity) {
  if (capacity < 1) throw std::logic_error("read_ahead: capacity must be at least 1");
  return std::make_unique<ReadAhead>(std::move(sequence), capacity);
}

}  // namespace stereovox
