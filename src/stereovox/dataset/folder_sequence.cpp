#include "stereovox/dataset/folder_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"
#include "stereovox/dataset/stamps.h"
#include "stereovox/io/image_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kImagesToProbe = 3;

std::string size_complaint(const fs::path& image, int width, int height, const StereoRig& rig) {
  return fmt::format("{}: size is {} x {}, the calibration says {} x {}", image.string(), width,
                     height, rig.left.pinhole.width, rig.left.pinhole.height);
}

// A calibration for another resolution is a mistake of the whole data set, not of one image.
void check_first_sizes(const std::vector<ListedPair>& pairs, const StereoRig& rig) {
  const PinholeCamera& camera = rig.left.pinhole;
  std::string first_complaint;
  for (std::size_t i = 0; i < std::min(pairs.size(), kImagesToProbe); ++i) try {
      const cv::Size size = read_image_size(pairs[i].left);
      if (size == cv::Size(camera.width, camera.height)) return;
      if (!first_complaint.empty()) continue;
      first_complaint = size_complaint(pairs[i].left, size.width, size.height, rig);
      if (std::int64_t{size.width} * camera.height == std::int64_t{size.height} * camera.width)
        first_complaint += fmt::format(", {:.6g} times the size; is it of another resolution?",
                                       static_cast<double>(camera.width) / size.width);
    } catch (const Error&) {
      continue;  // next() skips and counts it
    }
  if (!first_complaint.empty()) throw Error(first_complaint);
}

std::vector<ListedPair> select(std::vector<ListedPair> pairs, const SequenceParams& params) {
  const std::int64_t first_ns = pairs.front().stamp_ns, last_ns = pairs.back().stamp_ns;
  const std::int64_t start_ns = first_ns + ns_from_seconds(params.start_s);
  const std::int64_t end_ns = start_ns + ns_from_seconds(params.duration_s);
  std::erase_if(pairs, [&](const ListedPair& pair) {
    return pair.stamp_ns < start_ns || (params.duration_s > 0.0 && pair.stamp_ns >= end_ns);
  });
  if (pairs.empty())
    throw UsageError(fmt::format("no pair from {} s on for {} s; the sequence is {:.3f} s long",
                                 params.start_s, params.duration_s,
                                 seconds_from_ns(last_ns - first_ns)));
  std::vector<ListedPair> selected;
  const std::size_t step = static_cast<std::size_t>(params.frame_skip) + 1;
  const std::size_t most =
      params.max_frames > 0 ? static_cast<std::size_t>(params.max_frames) : pairs.size();
  for (std::size_t i = 0; i < pairs.size() && selected.size() < most; i += step)
    selected.push_back(std::move(pairs[i]));
  return selected;
}

int max_skipped(std::size_t pairs, double max_percent) {
  const int share = static_cast<int>(std::floor(static_cast<double>(pairs) * max_percent / 100.0));
  return max_percent > 0.0 ? std::max(share, 1) : 0;
}

class FolderSequence final : public StereoSequence {
 public:
  FolderSequence(SequenceListing listing, const StereoRig& rig, const SequenceParams& params)
      : listing_(std::move(listing)), rig_(rig), params_(params) {}

  const StereoRig& rig() const override { return rig_; }
  const SequenceInfo& info() const override { return listing_.info; }
  const Trajectory& truth() const override { return listing_.truth; }
  std::span<const SkippedPair> skipped() const override { return skipped_; }

  std::optional<StereoFrame> next() override {
    while (next_ < listing_.pairs.size()) {
      const ListedPair& pair = listing_.pairs[next_++];
      try {
        return read(pair);
      } catch (const Error& error) {
        skip(pair, error.what());
      }
    }
    return std::nullopt;
  }

 private:
  StereoFrame read(const ListedPair& pair) {
    LoadedPair loaded = read_gray_pair(pair.left, pair.right, used_bits_);
    check(pair.left, loaded.left);
    check(pair.right, loaded.right);
    return {pair.stamp_ns, pair.index, pair.left.filename().string(), loaded.left.image,
            loaded.right.image};
  }

  void check(const fs::path& path, const LoadedImage& loaded) {
    const GrayImage& image = loaded.image;
    if (image.width() != rig_.left.pinhole.width || image.height() != rig_.left.pinhole.height)
      throw Error(size_complaint(path, image.width(), image.height(), rig_));
    if (!loaded.conversion.empty() && conversions_.insert(loaded.conversion).second)
      listing_.info.remarks.push_back(fmt::format("images are converted: {}; first: {}",
                                                  loaded.conversion, path.filename().string()));
  }

  void skip(const ListedPair& pair, const std::string& reason) {
    skipped_.push_back({pair.left.filename().string(), reason});
    const std::size_t pairs = listing_.pairs.size();
    const int most = max_skipped(pairs, params_.max_skipped_percent);
    if (static_cast<int>(skipped_.size()) > most || skipped_.size() == pairs)
      throw Error(
          fmt::format("{}: {} of {} pairs cannot be used, at most {} may be ({} %); first: {}",
                      listing_.info.path.string(), skipped_.size(), pairs, most,
                      params_.max_skipped_percent, skipped_.front().reason));
  }

  SequenceListing listing_;
  StereoRig rig_;
  SequenceParams params_;
  std::size_t next_ = 0;
  std::vector<SkippedPair> skipped_;
  int used_bits_ = 0;  // of the images so far: all are scaled alike from the brightest on
  std::set<std::string> conversions_;  // already remarked
};

}  // namespace

std::unique_ptr<StereoSequence> make_folder_sequence(SequenceListing listing, const StereoRig& rig,
                                                     const SequenceParams& params) {
  SequenceInfo& info = listing.info;
  listing.pairs = select(std::move(listing.pairs), params);
  info.pairs = static_cast<int>(listing.pairs.size());
  std::vector<std::int64_t> stamps_ns;
  for (const ListedPair& pair : listing.pairs) stamps_ns.push_back(pair.stamp_ns);
  if (const std::string jumps = remark_on_jumps(stamps_ns); !jumps.empty())
    info.remarks.push_back(jumps);
  for (const std::string& oddity : oddities(rig)) info.remarks.push_back(oddity);
  check_first_sizes(listing.pairs, rig);
  return std::make_unique<FolderSequence>(std::move(listing), rig, params);
}

}  // namespace stereovox
