#include "stereovox/odometry/place_graph.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stereovox {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Keyframes that keep all they know: tracking may need it.
constexpr std::size_t kNewestCount = 24;

std::size_t memory_bytes(const Keyframe& keyframe) {
  std::size_t bytes = 0;
  for (const KeyframeLevel& level : keyframe.levels)
    bytes += level.left.pixels.total() +
             level.points.features.size() * (sizeof(Feature) + sizeof(PatchDescriptor));
  return bytes;
}

PoseLink link_of(const Comparison& comparison, int from, int to) {
  return {from, to,
          inverse(comparison.reference().T_segment_camera) * comparison.estimate.T_reference_camera,
          comparison.estimate.covariance.inverse()};
}

}  // namespace

std::size_t PlaceGraph::index_of(const Keyframe& keyframe) const {
  return static_cast<std::size_t>(
      std::ranges::find(keyframes_, &keyframe, [](const Keyframe& k) { return &k; }) -
      keyframes_.begin());
}

void PlaceGraph::add_keyframe(Keyframe keyframe) {
  double way_m = 0.0;
  if (!keyframes_.empty()) {
    way_m = way_m_.back();
    if (keyframes_.back().segment == keyframe.segment)
      way_m +=
          (keyframe.T_segment_camera.translation - keyframes_.back().T_segment_camera.translation)
              .norm();
  }
  way_m_.push_back(way_m);
  keyframes_.push_back(std::move(keyframe));
  save_memory();
}

void PlaceGraph::link_last(const Comparison& comparison) {
  links_.push_back(link_of(comparison, static_cast<int>(index_of(comparison.reference())),
                           static_cast<int>(keyframes_.size()) - 1));
}

void PlaceGraph::find_links(LeveledFrame& frame) {
  const int last = static_cast<int>(keyframes_.size()) - 1;
  for (const std::size_t candidate : candidates()) {
    const Comparison comparison =
        comparer_.compare_at(frame, 0, {&keyframes_[candidate]},
                             {.T_segment_predicted = keyframes_.back().T_segment_camera});
    if (!comparison.is_trusted() ||
        comparison.initial.consistent_count() < params_.quality.min_recognised)
      continue;
    const PoseLink link = link_of(comparison, static_cast<int>(candidate), last);
    if (is_believable(link)) links_.push_back(link);
  }
}

// The nearest in sight of earlier keyframes of the same segment: some of those just passed, but not
// the very last, and some of all others.
std::vector<std::size_t> PlaceGraph::candidates() const {
  const PlaceParams& params = params_.places;
  const Keyframe& last = keyframes_.back();
  struct Candidate {
    std::size_t index;
    double distance;
  };
  std::vector<Candidate> recent, earlier;
  for (std::size_t i = 0; i + 2 < keyframes_.size(); ++i) {
    const Keyframe& keyframe = keyframes_[i];
    if (keyframe.levels.empty() || keyframe.segment != last.segment) continue;
    const FeatureSet& points = keyframe.levels.front().points;
    if (points.features.empty()) continue;
    const SE3 motion = inverse(keyframe.T_segment_camera) * last.T_segment_camera;
    const double shift =
        motion.translation.norm() / (params.max_shift * median_depth_m(comparer_.camera(), points));
    const double turn = rotation_angle_rad(motion) * kDegrees / params.max_turn_deg;
    if (shift > 1.0 || turn > 1.0) continue;
    const bool is_recent = keyframes_.size() - 1 - i <= static_cast<std::size_t>(params.recent);
    (is_recent ? recent : earlier).push_back({i, shift + turn});
  }
  std::vector<std::size_t> chosen;
  for (auto* group : {&recent, &earlier}) {
    std::ranges::stable_sort(*group, {}, &Candidate::distance);
    const auto count = std::min(group->size(), static_cast<std::size_t>(params.attempts));
    for (std::size_t i = 0; i < count; ++i) chosen.push_back((*group)[i].index);
  }
  return chosen;
}

// Tracking drifts, but not by any amount.
bool PlaceGraph::is_believable(const PoseLink& link) const {
  const PlaceParams& params = params_.places;
  const auto from = static_cast<std::size_t>(link.from), to = static_cast<std::size_t>(link.to);
  const SE3 tracked = inverse(keyframes_[from].T_segment_camera) * keyframes_[to].T_segment_camera;
  const SE3 miss = inverse(tracked) * link.T_from_to;
  const double way_m = way_m_[to] - way_m_[from];
  return miss.translation.norm() <= params.max_miss_m + params.max_drift_share * way_m &&
         rotation_angle_rad(miss) * kDegrees <=
             params.max_miss_deg + params.max_drift_deg_per_m * way_m;
}

// Older keyframes keep their finest images only: coarse ones of different places look alike.
void PlaceGraph::save_memory() {
  if (keyframes_.size() <= kNewestCount) return;
  const std::size_t older = keyframes_.size() - kNewestCount;
  Keyframe& ageing = keyframes_[older - 1];
  if (ageing.levels.size() > 1) ageing.levels.resize(1);
  ageing.surfaces.clear();
  std::size_t bytes = 0;
  for (const Keyframe& keyframe : keyframes_) bytes += memory_bytes(keyframe);
  constexpr double kBytesPerMb = 1e6;
  if (static_cast<double>(bytes) <= params_.keyframes.memory_mb * kBytesPerMb) return;
  bool forgets = false;
  for (std::size_t i = 0; i < older; ++i) {
    if (keyframes_[i].levels.empty()) continue;
    if (forgets) keyframes_[i].levels.clear();
    forgets = !forgets;
  }
}

void PlaceGraph::add_frame(std::int64_t stamp_ns, std::size_t keyframe,
                           const SE3& T_segment_camera) {
  frames_.push_back(
      {stamp_ns, keyframe, inverse(keyframes_[keyframe].T_segment_camera) * T_segment_camera});
}

// True when the link gave a segment its place beside one that has it.
bool PlaceGraph::place_across(const PoseLink& link,
                              std::vector<std::optional<Placement>>& placements) const {
  const Keyframe& from = keyframes_[static_cast<std::size_t>(link.from)];
  const Keyframe& to = keyframes_[static_cast<std::size_t>(link.to)];
  auto& known = placements[static_cast<std::size_t>(from.segment)];
  auto& other = placements[static_cast<std::size_t>(to.segment)];
  if (known.has_value() == other.has_value()) return false;
  const SE3 T_from_to = from.T_segment_camera * link.T_from_to * inverse(to.T_segment_camera);
  if (known)
    other = {known->segment, known->T_first_segment * T_from_to};
  else
    known = {other->segment, other->T_first_segment * inverse(T_from_to)};
  return true;
}

std::vector<std::optional<PlaceGraph::Placement>> PlaceGraph::connected_segments() const {
  int segments = 0;
  for (const Keyframe& keyframe : keyframes_) segments = std::max(segments, keyframe.segment + 1);
  std::vector<std::optional<Placement>> placements(static_cast<std::size_t>(segments));
  for (int segment = 0; segment < segments; ++segment) {
    auto& placement = placements[static_cast<std::size_t>(segment)];
    if (!placement) placement = Placement{segment, SE3{}};
    bool spreads = true;
    while (spreads) {
      spreads = false;
      for (const PoseLink& link : links_) spreads |= place_across(link, placements);
    }
  }
  return placements;
}

std::vector<PlacedFrame> PlaceGraph::placed_frames() const {
  const auto placements = connected_segments();
  std::vector<SE3> poses;
  std::vector<bool> is_fixed, is_begun(placements.size(), false);
  for (const Keyframe& keyframe : keyframes_) {
    const Placement& placement = *placements[static_cast<std::size_t>(keyframe.segment)];
    poses.push_back(placement.T_first_segment * keyframe.T_segment_camera);
    const auto first = static_cast<std::size_t>(placement.segment);
    is_fixed.push_back(!is_begun[first]);
    is_begun[first] = true;
  }
  optimize(links_, is_fixed, params_.places.robust_sigmas, poses);

  std::vector<PlacedFrame> placed;
  for (const Frame& frame : frames_) {
    const Keyframe& keyframe = keyframes_[frame.keyframe];
    placed.push_back({frame.stamp_ns,
                      placements[static_cast<std::size_t>(keyframe.segment)]->segment,
                      poses[frame.keyframe] * frame.T_keyframe_camera});
  }
  return placed;
}

}  // namespace stereovox
