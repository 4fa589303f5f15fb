#include "stereovox/odometry/odometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"

namespace stereovox {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Motion is taken to go on steadily over a gap up to this many times the one before.
constexpr double kMaxGapRatio = 3.0;
// All pixels speak for a place where they differ by so much less than at another. On simulated
// walls of repeated patterns over clouds of 1 to 10 grey levels wrong places never differed by 0.95
// or less.
constexpr double kClearlyBetter = 0.95;
// Turns since the last frame from which blank walls are aligned.
constexpr std::array kTriedTurns_deg = {0.0, -4.0, 4.0, -8.0, 8.0, -12.0, 12.0};

Vector6d turn_about_y(double angle_deg) {
  Vector6d twist = Vector6d::Zero();
  twist[4] = angle_deg / kDegrees;
  return twist;
}

}  // namespace

Odometry::Odometry(const RectifiedCamera& camera, const OdometryParams& params)
    : params_(params), comparer_(camera, params), places_(comparer_, params) {}

OdometryResult Odometry::track(const RectifiedPair& pair, const DisparityImage& disparity) {
  check_sizes(pair, disparity);
  auto frame = std::make_unique<LeveledFrame>(pair, disparity, params_.features);
  const OdometryResult result = places_.keyframes().empty() ? start(*frame) : place(*frame);
  if (result.status == OdometryStatus::tracked) {
    last_frame_ = std::move(frame);
    last_is_keyframe_ = result.is_keyframe;
  }
  return result;
}

OdometryResult Odometry::place(LeveledFrame& frame) {
  const std::optional<SE3> T_segment_predicted = predicted_pose(frame.stamp_ns);
  Comparison comparison =
      comparer_.compare(frame, local_keyframes(reference_), {T_segment_predicted, last_});
  if (!comparison.is_trusted()) return search(frame, comparison);
  comparison = look_closer(frame, std::move(comparison), T_segment_predicted);
  // The camera may be back where an earlier segment knew its way.
  if (const auto earlier = recognise(frame, true, 1))
    return accept_in_earlier_segment(frame, comparison, *earlier);
  return accept(frame, comparison);
}

// Few corners may know the place less well than all pixels do, and a pattern that repeats may lead
// them to a wrong one.
Comparison Odometry::look_closer(LeveledFrame& frame, Comparison found,
                                 const std::optional<SE3>& T_segment_predicted) {
  if (T_segment_predicted &&
      are_apart(*T_segment_predicted, found.estimate.T_reference_camera, found))
    found = best_around(frame, std::move(found), *T_segment_predicted);
  if (found.estimate.inliers >= params_.quality.plenty_inliers) return found;
  const auto near = find_near_last_pose(frame, T_segment_predicted);
  if (!near) return found;
  const bool is_surer = sigma_m(near->estimate) < sigma_m(found.estimate);
  return is_surer || fits_better(frame, *near, found) ? with_keyframe(*near) : found;
}

// Corners are matched anew around where the camera would be had it turned a little more or less
// than steadily; all pixels say which motion it was.
Comparison Odometry::best_around(LeveledFrame& frame, Comparison found,
                                 const SE3& T_segment_predicted) {
  for (const double yaw_deg : kTriedTurns_deg) {
    Comparison other = comparer_.compare_at(
        frame, found.level, local_keyframes(reference_),
        {.T_segment_predicted = T_segment_predicted * exp(turn_about_y(yaw_deg)),
         .last = last_,
         .only_near = true});
    if (other.is_trusted() && fits_better(frame, other, found)) found = std::move(other);
  }
  return found;
}

bool Odometry::fits_better(LeveledFrame& frame, const Comparison& a, const Comparison& b) const {
  const SE3 &T_segment_a = a.estimate.T_reference_camera,
            &T_segment_b = b.estimate.T_reference_camera;
  return are_apart(T_segment_a, T_segment_b, b) &&
         comparer_.difference_ratio(frame, *last_frame_, last_->T_segment_camera, T_segment_a,
                                    T_segment_b) < kClearlyBetter;
}

// So far that only a sudden motion or a wrong pose explains it.
bool Odometry::are_apart(const SE3& a, const SE3& b, const Comparison& seen) const {
  const SE3 between = inverse(a) * b;
  const QualityParams& quality = params_.quality;
  return rotation_angle_rad(between) * kDegrees > quality.max_surprise_deg ||
         between.translation.norm() >
             quality.max_surprise *
                 median_depth_m(comparer_.camera(seen.level), seen.reference_points());
}

OdometryResult Odometry::start(LeveledFrame& frame) {
  const int count = corner_count(frame);
  OdometryResult result;
  if (count < params_.quality.min_recognised) {
    result.reason = fmt::format("{} corners have a disparity, {} are needed to start", count,
                                params_.quality.min_recognised);
    return result;
  }
  places_.add_keyframe(make_keyframe(frame));
  places_.add_frame(frame.stamp_ns, 0, SE3{});
  remember_pose(frame.stamp_ns, SE3{});
  result.status = OdometryStatus::tracked;
  result.is_keyframe = true;
  return result;
}

// Of the level that has most.
int Odometry::corner_count(LeveledFrame& frame) const {
  std::size_t most = 0;
  for (std::size_t level = 0; level < comparer_.level_count(); ++level)
    most = std::max(most, frame.at(level).features.features.size());
  return static_cast<int>(most);
}

Keyframe Odometry::make_keyframe(LeveledFrame& frame) const {
  Keyframe keyframe;
  for (std::size_t level = 0; level < comparer_.level_count(); ++level)
    keyframe.levels.push_back(make_keyframe_level(frame.at(level).images.pair,
                                                  frame.at(level).features, params_.alignment));
  keyframe.surfaces = FrameComparer::surfaces_of(frame);
  return keyframe;
}

OdometryResult Odometry::accept(LeveledFrame& frame, const Comparison& comparison) {
  const MotionEstimate& estimate = comparison.estimate;
  const OdometryResult result{.status = OdometryStatus::tracked,
                              .segment = comparison.reference().segment,
                              .T_segment_camera = estimate.T_reference_camera,
                              .covariance = estimate.covariance,
                              .matches = comparison.initial.matches,
                              .consistent = comparison.initial.consistent_count(),
                              .expected = comparison.points.expected,
                              .inliers = estimate.inliers,
                              .rms_px = estimate.rms_px,
                              .level = static_cast<int>(comparison.level),
                              .is_keyframe = needs_keyframe(comparison)};
  absorb_sightings(comparison);
  last_comparison_ = comparison;
  reference_ = places_.index_of(comparison.reference());
  remember_pose(frame.stamp_ns, result.T_segment_camera);
  candidate_.reset();
  if (result.is_keyframe) add_keyframe(frame, comparison);
  places_.add_frame(frame.stamp_ns, reference_, result.T_segment_camera);
  return result;
}

// A keyframe that both segments know ties them together.
OdometryResult Odometry::accept_in_earlier_segment(LeveledFrame& frame, const Comparison& later,
                                                   const Comparison& earlier) {
  OdometryResult result = accept(frame, earlier);
  if (!result.is_keyframe) add_keyframe(frame, earlier);
  result.is_keyframe = true;
  places_.link_last(later);
  return result;
}

void Odometry::absorb_sightings(const Comparison& comparison) {
  for (std::size_t i = 0; i < comparison.points.sightings.size(); ++i) {
    const PointSighting& sighting = comparison.points.sightings[i];
    KeyframeLevel& seen = comparison.local[sighting.keyframe]->levels[comparison.level];
    if (comparison.estimate.is_inlier[i])
      absorb(comparer_.camera(comparison.level), sighting.observation,
             comparison.estimate.T_reference_camera, seen.points.features[sighting.point]);
  }
}

void Odometry::add_keyframe(LeveledFrame& frame, const Comparison& comparison) {
  Keyframe keyframe = make_keyframe(frame);
  keyframe.segment = comparison.reference().segment;
  keyframe.T_segment_camera = comparison.estimate.T_reference_camera;
  places_.add_keyframe(std::move(keyframe));
  places_.link_last(comparison);
  places_.find_links(frame);
  reference_ = places_.keyframes().size() - 1;
}

OdometryResult Odometry::search(LeveledFrame& frame, const Comparison& failed) {
  const std::optional<SE3> T_segment_predicted = predicted_pose(frame.stamp_ns);
  before_last_.reset();
  if (const auto found = recognise(frame, false, params_.keyframes.attempts_per_frame))
    return accept(frame, *found);
  if (const auto near = find_near_last_pose(frame, T_segment_predicted))
    return accept(frame, with_keyframe(*near));
  if (const auto begun = begin_segment(frame)) return accept(frame, *begun);
  if (corner_count(frame) >= params_.quality.min_recognised) candidate_ = make_keyframe(frame);
  return lost(failed);
}

// Before a blank wall there are no corners, but the frame before, if it was tracked, is near
// enough.
std::optional<Comparison> Odometry::find_near_last_pose(
    LeveledFrame& frame, const std::optional<SE3>& T_segment_predicted) {
  if (candidate_) return std::nullopt;
  std::vector<SE3> starts;
  for (const double yaw_deg : kTriedTurns_deg)
    starts.push_back(last_->T_segment_camera * exp(turn_about_y(yaw_deg)));
  if (T_segment_predicted) starts.push_back(*T_segment_predicted);
  if (!last_is_keyframe_)
    last_view_ = Keyframe{.segment = last_->segment,
                          .T_segment_camera = last_->T_segment_camera,
                          .surfaces = FrameComparer::surfaces_of(*last_frame_)};
  Keyframe& last_view = !last_is_keyframe_ ? *last_view_ : places_.keyframes()[reference_];
  Comparison comparison = comparer_.compare_directly(frame, last_view, starts, last_);
  if (!comparison.is_trusted()) return std::nullopt;
  return comparison;
}

// What was compared with the frame before, which becomes a keyframe.
Comparison Odometry::with_keyframe(Comparison near) {
  if (!std::exchange(last_is_keyframe_, true)) add_keyframe(*last_frame_, *last_comparison_);
  near.local = {&places_.keyframes()[reference_]};
  return near;
}

OdometryResult Odometry::lost(const Comparison& comparison) const {
  return {.status = OdometryStatus::lost,
          .segment = last_->segment,
          .T_segment_camera = last_->T_segment_camera,
          .matches = comparison.initial.matches,
          .consistent = comparison.initial.consistent_count(),
          .expected = comparison.points.expected,
          .inliers = comparison.estimate.inliers,
          .rms_px = comparison.estimate.rms_px,
          .reason = comparison.doubt};
}

std::optional<SE3> Odometry::predicted_pose(std::int64_t stamp_ns) const {
  if (!last_ || !before_last_) return std::nullopt;
  const double gap_s = seconds_from_ns(stamp_ns - last_->stamp_ns);
  const double gap_before_s = seconds_from_ns(last_->stamp_ns - before_last_->stamp_ns);
  if (gap_s <= 0.0 || gap_before_s <= 0.0 || gap_s > kMaxGapRatio * gap_before_s)
    return std::nullopt;
  return interpolate(before_last_->T_segment_camera, last_->T_segment_camera,
                     1.0 + gap_s / gap_before_s);
}

// Keyframes are tried in turn, the latest first, so that in time every one is.
std::optional<Comparison> Odometry::recognise(LeveledFrame& frame, bool earlier_segments_only,
                                              int attempts) {
  std::deque<Keyframe>& keyframes = places_.keyframes();
  const int segment = keyframes[reference_].segment;
  for (std::size_t seen = 0; seen < keyframes.size() && attempts > 0; ++seen) {
    next_recognised_ = (next_recognised_ + keyframes.size() - 1) % keyframes.size();
    const Keyframe& keyframe = keyframes[next_recognised_];
    if (next_recognised_ == reference_ || keyframe.levels.empty() ||
        (earlier_segments_only && keyframe.segment >= segment))
      continue;
    --attempts;
    // Coarse images of different places look alike.
    Comparison comparison =
        comparer_.compare_at(frame, 0, local_keyframes(next_recognised_), {.last = last_});
    if (comparison.is_trusted() &&
        comparison.initial.consistent_count() >= params_.quality.min_recognised)
      return comparison;
  }
  return std::nullopt;
}

// A new segment begins when two lost frames in a row agree on the motion between them.
std::optional<Comparison> Odometry::begin_segment(LeveledFrame& frame) {
  if (!candidate_) return std::nullopt;
  candidate_->segment = segments_;
  const Comparison comparison = comparer_.compare(frame, {&*candidate_}, {.last = last_});
  if (!comparison.is_trusted()) return std::nullopt;
  // The frame, not the candidate, is the first whose pose is reported: it is the origin.
  candidate_->T_segment_camera = inverse(comparison.estimate.T_reference_camera);
  ++segments_;
  places_.add_keyframe(std::move(*candidate_));
  candidate_.reset();
  return comparer_.compare(frame, {&places_.keyframes().back()}, {.last = last_});
}

std::vector<Keyframe*> Odometry::local_keyframes(std::size_t reference) {
  std::deque<Keyframe>& keyframes = places_.keyframes();
  std::vector<Keyframe*> local;
  for (std::size_t i = reference + 1; i-- > 0;) {
    if (local.size() == static_cast<std::size_t>(params_.keyframes.local_count)) break;
    if (keyframes[i].segment == keyframes[reference].segment && !keyframes[i].levels.empty())
      local.push_back(&keyframes[i]);
  }
  std::ranges::reverse(local);
  return local;
}

bool Odometry::needs_keyframe(const Comparison& comparison) const {
  // Without corners only the very next frame is near enough to be compared.
  if (comparison.is_direct) return true;
  const KeyframeParams& params = params_.keyframes;
  const Keyframe& reference = comparison.reference();
  const SE3 motion = inverse(reference.T_segment_camera) * comparison.estimate.T_reference_camera;
  const auto known = static_cast<double>(comparison.reference_points().features.size());
  return comparison.initial.consistent_count() < params.min_consistent_share * known ||
         motion.translation.norm() >
             params.max_shift * median_depth_m(comparer_.camera(comparison.level),
                                               comparison.reference_points()) ||
         rotation_angle_rad(motion) * kDegrees > params.max_turn_deg;
}

void Odometry::remember_pose(std::int64_t stamp_ns, const SE3& T_segment_camera) {
  const int segment = places_.keyframes()[reference_].segment;
  before_last_ = last_ && last_->segment == segment ? last_ : std::nullopt;
  last_ = LastPose{stamp_ns, segment, T_segment_camera};
}

void Odometry::check_sizes(const RectifiedPair& pair, const DisparityImage& disparity) const {
  const cv::Size expected(comparer_.camera().pinhole.width, comparer_.camera().pinhole.height);
  const auto check = [&](const char* what, const cv::Size& found) {
    if (found != expected)
      throw Error(fmt::format("odometry: {} is {} x {}, the camera says {} x {}", what, found.width,
                              found.height, expected.width, expected.height));
  };
  check("left image", pair.left.pixels.size());
  check("right image", pair.right.pixels.size());
  check("disparity", disparity.disparity_px.size());
  check("disparity sigma", disparity.sigma_px.size());
  if (!pair.valid_left.empty()) check("mask of the left image", pair.valid_left.size());
}

}  // namespace stereovox
