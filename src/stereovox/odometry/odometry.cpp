#include "stereovox/odometry/odometry.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"

namespace stereovox {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Motion is taken to go on steadily over a gap up to this many times the one before.
constexpr double kMaxGapRatio = 3.0;

double largest_sigma(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

// Of the position, in the direction where it is known least.
double sigma_m(const MotionEstimate& estimate) {
  return largest_sigma(estimate.covariance.topLeftCorner<3, 3>());
}

double median_depth_m(const RectifiedCamera& camera, const FeatureSet& points) {
  std::vector<double> depths;
  for (const Feature& point : points.features) depths.push_back(camera.depth_m(point.disparity_px));
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

std::string doubt_about(const InitialMotion& motion, const QualityParams& quality) {
  if (motion.consistent_count() < quality.min_consistent)
    return fmt::format("{} of {} matches are consistent, {} are needed", motion.consistent_count(),
                       motion.matches, quality.min_consistent);
  if (motion.consistent_count() < quality.min_consistent_share * motion.matches)
    return fmt::format("{} of {} matches are consistent, a share of {} is needed",
                       motion.consistent_count(), motion.matches, quality.min_consistent_share);
  return "";
}

std::string doubt_about(const MotionEstimate& estimate, int expected,
                        const QualityParams& quality) {
  if (estimate.inliers < quality.min_inliers ||
      estimate.inliers < quality.min_inlier_share * expected)
    return fmt::format("{} of {} points fit the motion, {} and a share of {} are needed",
                       estimate.inliers, expected, quality.min_inliers, quality.min_inlier_share);
  if (estimate.rms_px > quality.max_rms_px)
    return fmt::format("reprojection error is {:.2f} px, {} are allowed", estimate.rms_px,
                       quality.max_rms_px);
  const double position_m = sigma_m(estimate);
  const double sigma_deg = largest_sigma(estimate.covariance.bottomRightCorner<3, 3>()) * kDegrees;
  if (!(position_m <= quality.max_sigma_m && sigma_deg <= quality.max_sigma_deg))
    return fmt::format("motion is known to {:.3f} m and {:.2f} deg, {} and {} are needed",
                       position_m, sigma_deg, quality.max_sigma_m, quality.max_sigma_deg);
  return "";
}

}  // namespace

// A pair with its corners, at every level that was asked for.
struct Odometry::Frame {
  struct Level {
    PairLevel images;
    FeatureSet features;
  };

  const Level& at(std::size_t level) {
    while (levels.size() <= level) add(halved(levels.back().images));
    return levels[level];
  }
  void add(PairLevel images) {
    FeatureSet features = extract_features(images.pair, images.disparity, params);
    levels.push_back({std::move(images), std::move(features)});
  }

  const FeatureParams& params;
  std::int64_t stamp_ns;
  std::deque<Level> levels = {};
};

// What comparing a frame with keyframes gave; trusted when `doubt` is empty.
struct Odometry::Attempt {
  std::size_t level;             // of the images compared
  std::vector<Keyframe*> local;  // of one segment; the last is the reference
  InitialMotion initial = {};
  MotionEstimate estimate = {};  // in the frame of the segment
  SightingSet points = {};
  std::string doubt = "";

  Keyframe& reference() const { return *local.back(); }
  const FeatureSet& reference_points() const { return reference().levels[level].points; }
  bool is_trusted() const { return doubt.empty(); }
};

Odometry::Odometry(const RectifiedCamera& camera, const OdometryParams& params)
    : cameras_{camera}, params_(params) {
  for (int i = 0; i < params.keyframes.coarser_levels; ++i)
    cameras_.push_back(halved(cameras_.back()));
}

OdometryResult Odometry::track(const RectifiedPair& pair, const DisparityImage& disparity) {
  check_sizes(pair, disparity);
  Frame frame{.params = params_.features, .stamp_ns = pair.stamp_ns};
  frame.add({pair, disparity});
  if (keyframes_.empty()) return start(frame);

  Attempt attempt = compare(frame, local_keyframes(reference_), predicted_pose(pair.stamp_ns));
  if (!attempt.is_trusted()) return search(frame, attempt);
  // The camera may be back where an earlier segment knew its way.
  if (auto earlier = recognise(frame, true, 1)) attempt = std::move(*earlier);
  return accept(frame, attempt);
}

OdometryResult Odometry::start(Frame& frame) {
  const int count = corner_count(frame);
  OdometryResult result;
  if (count < params_.quality.min_recognised) {
    result.reason = fmt::format("{} corners have a disparity, {} are needed to start", count,
                                params_.quality.min_recognised);
    return result;
  }
  store(make_keyframe(frame));
  remember_pose(frame.stamp_ns, SE3{});
  result.status = OdometryStatus::tracked;
  result.is_keyframe = true;
  return result;
}

// Of the level that has most.
int Odometry::corner_count(Frame& frame) const {
  std::size_t most = 0;
  for (std::size_t level = 0; level < cameras_.size(); ++level)
    most = std::max(most, frame.at(level).features.features.size());
  return static_cast<int>(most);
}

Keyframe Odometry::make_keyframe(Frame& frame) const {
  Keyframe keyframe;
  for (std::size_t level = 0; level < cameras_.size(); ++level)
    keyframe.levels.push_back(make_keyframe_level(frame.at(level).images.pair,
                                                  frame.at(level).features, params_.alignment));
  return keyframe;
}

OdometryResult Odometry::accept(Frame& frame, const Attempt& attempt) {
  const MotionEstimate& estimate = attempt.estimate;
  const SE3& T_segment_camera = estimate.T_reference_camera;
  OdometryResult result{.status = OdometryStatus::tracked,
                        .segment = attempt.reference().segment,
                        .T_segment_camera = T_segment_camera,
                        .covariance = estimate.covariance,
                        .matches = attempt.initial.matches,
                        .consistent = attempt.initial.consistent_count(),
                        .expected = attempt.points.expected,
                        .inliers = estimate.inliers,
                        .level = static_cast<int>(attempt.level),
                        .rms_px = estimate.rms_px,
                        .is_keyframe = needs_keyframe(attempt)};
  for (std::size_t i = 0; i < attempt.points.sightings.size(); ++i) {
    const PointSighting& sighting = attempt.points.sightings[i];
    Keyframe& keyframe = *attempt.local[sighting.keyframe];
    if (estimate.is_inlier[i])
      absorb(cameras_[attempt.level], sighting.observation, T_segment_camera,
             keyframe.levels[attempt.level].points.features[sighting.point]);
  }
  reference_ = static_cast<std::size_t>(
      std::ranges::find(keyframes_, &attempt.reference(), [](const Keyframe& k) { return &k; }) -
      keyframes_.begin());
  remember_pose(frame.stamp_ns, T_segment_camera);
  candidate_.reset();
  if (!result.is_keyframe) return result;
  Keyframe keyframe = make_keyframe(frame);
  keyframe.segment = result.segment;
  keyframe.T_segment_camera = T_segment_camera;
  store(std::move(keyframe));
  return result;
}

OdometryResult Odometry::search(Frame& frame, const Attempt& failed) {
  before_last_.reset();
  if (const auto found = recognise(frame, false, params_.keyframes.attempts_per_frame))
    return accept(frame, *found);
  if (const auto begun = begin_segment(frame)) return accept(frame, *begun);
  OdometryResult result = lost(failed);
  if (corner_count(frame) >= params_.quality.min_recognised) candidate_ = make_keyframe(frame);
  return result;
}

OdometryResult Odometry::lost(const Attempt& attempt) const {
  return {.status = OdometryStatus::lost,
          .segment = last_->segment,
          .T_segment_camera = last_->T_segment_camera,
          .matches = attempt.initial.matches,
          .consistent = attempt.initial.consistent_count(),
          .expected = attempt.points.expected,
          .inliers = attempt.estimate.inliers,
          .rms_px = attempt.estimate.rms_px,
          .reason = attempt.doubt};
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

// At the finest level when it has plenty of points, else at the level that knows the place best.
// When none does, the finest tells why.
Odometry::Attempt Odometry::compare(Frame& frame, const std::vector<Keyframe*>& local,
                                    const std::optional<SE3>& T_segment_predicted) const {
  Attempt best = compare_at(frame, 0, local, T_segment_predicted);
  if (best.is_trusted() && best.estimate.inliers >= params_.quality.plenty_inliers) return best;
  for (std::size_t level = 1; level < cameras_.size(); ++level) {
    Attempt attempt = compare_at(frame, level, local, T_segment_predicted);
    if (!attempt.is_trusted()) continue;
    if (!best.is_trusted() || sigma_m(attempt.estimate) < sigma_m(best.estimate))
      best = std::move(attempt);
  }
  return best;
}

Odometry::Attempt Odometry::compare_at(Frame& frame, std::size_t level,
                                       std::vector<Keyframe*> local,
                                       const std::optional<SE3>& T_segment_predicted) const {
  Attempt attempt{.level = level, .local = std::move(local)};
  const Keyframe& reference = attempt.reference();
  const FeatureSet& features = frame.at(level).features;
  const LevelView view{level, cameras_[level], frame.at(level).images.pair};
  std::optional<SE3> T_reference_predicted;
  if (T_segment_predicted)
    T_reference_predicted = inverse(reference.T_segment_camera) * *T_segment_predicted;
  attempt.initial =
      find_initial_motion(view.camera, attempt.reference_points(), features, T_reference_predicted,
                          params_.matching, params_.refinement);
  attempt.doubt = doubt_about(attempt.initial, params_.quality);
  if (!attempt.is_trusted()) return attempt;

  // First the matched corners bring the camera near, then all points give its place.
  SE3 place = reference.T_segment_camera * attempt.initial.T_reference_current;
  const std::vector<Observation> matched = sight_matches(
      view, reference, attempt.initial.consistent, features, place, params_.alignment);
  place = refine_motion(view.camera, matched, place, params_.refinement).T_reference_camera;
  const std::vector<const Keyframe*> keyframes(attempt.local.begin(), attempt.local.end());
  attempt.points = sight_points(view, keyframes, place, params_.alignment);
  std::vector<Observation> observations;
  for (const PointSighting& s : attempt.points.sightings) observations.push_back(s.observation);
  attempt.estimate = refine_motion(view.camera, observations, place, params_.refinement);
  attempt.doubt = doubt_about(attempt.estimate, attempt.points.expected, params_.quality);
  if (attempt.is_trusted())
    attempt.doubt =
        doubt_about_speed(frame.stamp_ns, reference.segment, attempt.estimate.T_reference_camera);
  return attempt;
}

std::optional<Odometry::Attempt> Odometry::recognise(Frame& frame, bool earlier_segments_only,
                                                     int attempts) {
  const int segment = keyframes_[reference_].segment;
  for (std::size_t seen = 0; seen < keyframes_.size() && attempts > 0; ++seen) {
    next_recognised_ = (next_recognised_ + keyframes_.size() - 1) % keyframes_.size();
    const bool is_earlier = keyframes_[next_recognised_].segment < segment;
    if (next_recognised_ == reference_ || (earlier_segments_only && !is_earlier)) continue;
    --attempts;
    // Coarse images of different places look alike.
    Attempt attempt = compare_at(frame, 0, local_keyframes(next_recognised_), std::nullopt);
    if (attempt.is_trusted() &&
        attempt.initial.consistent_count() >= params_.quality.min_recognised)
      return attempt;
  }
  return std::nullopt;
}

// A new segment begins when two lost frames in a row agree on the motion between them.
std::optional<Odometry::Attempt> Odometry::begin_segment(Frame& frame) {
  if (!candidate_) return std::nullopt;
  candidate_->segment = segments_;
  Attempt attempt = compare(frame, {&*candidate_}, std::nullopt);
  if (!attempt.is_trusted()) return std::nullopt;
  // The frame, not the candidate, is the first whose pose is reported: it is the origin.
  candidate_->T_segment_camera = inverse(attempt.estimate.T_reference_camera);
  ++segments_;
  store(std::move(*candidate_));
  candidate_.reset();
  return compare(frame, {&keyframes_.back()}, std::nullopt);
}

std::vector<Keyframe*> Odometry::local_keyframes(std::size_t reference) {
  std::vector<Keyframe*> local;
  for (std::size_t i = reference + 1; i-- > 0;) {
    if (local.size() == static_cast<std::size_t>(params_.keyframes.local_count)) break;
    if (keyframes_[i].segment == keyframes_[reference].segment) local.push_back(&keyframes_[i]);
  }
  std::ranges::reverse(local);
  return local;
}

std::string Odometry::doubt_about_speed(std::int64_t stamp_ns, int segment,
                                        const SE3& T_segment_camera) const {
  if (!last_ || last_->segment != segment) return "";
  const double gap_s = seconds_from_ns(stamp_ns - last_->stamp_ns);
  if (gap_s <= 0.0) return "";
  const SE3 motion = inverse(last_->T_segment_camera) * T_segment_camera;
  const double speed = motion.translation.norm() / gap_s;
  const double turn = rotation_angle_rad(motion) * kDegrees / gap_s;
  const QualityParams& quality = params_.quality;
  if (speed <= quality.max_speed_m_per_s && turn <= quality.max_turn_deg_per_s) return "";
  return fmt::format("moved at {:.1f} m/s and {:.0f} deg/s, {} and {} are believed", speed, turn,
                     quality.max_speed_m_per_s, quality.max_turn_deg_per_s);
}

bool Odometry::needs_keyframe(const Attempt& attempt) const {
  const KeyframeParams& params = params_.keyframes;
  const Keyframe& reference = attempt.reference();
  const SE3 motion = inverse(reference.T_segment_camera) * attempt.estimate.T_reference_camera;
  const FeatureSet& points = attempt.reference_points();
  const auto known = static_cast<double>(points.features.size());
  return attempt.initial.consistent_count() < params.min_consistent_share * known ||
         motion.translation.norm() >
             params.max_shift * median_depth_m(cameras_[attempt.level], points) ||
         rotation_angle_rad(motion) * kDegrees > params.max_turn_deg;
}

// When there are too many, the segment with most keyframes forgets its oldest.
void Odometry::store(Keyframe keyframe) {
  keyframes_.push_back(std::move(keyframe));
  if (keyframes_.size() > static_cast<std::size_t>(params_.keyframes.stored_count)) {
    const auto size_of_segment = [this](const Keyframe& k) {
      return std::ranges::count(keyframes_, k.segment, &Keyframe::segment);
    };
    keyframes_.erase(std::ranges::max_element(keyframes_, {}, size_of_segment));
  }
  reference_ = keyframes_.size() - 1;
}

void Odometry::remember_pose(std::int64_t stamp_ns, const SE3& T_segment_camera) {
  const int segment = keyframes_[reference_].segment;
  before_last_ = last_ && last_->segment == segment ? last_ : std::nullopt;
  last_ = LastPose{stamp_ns, segment, T_segment_camera};
}

void Odometry::check_sizes(const RectifiedPair& pair, const DisparityImage& disparity) const {
  const cv::Size expected(cameras_.front().pinhole.width, cameras_.front().pinhole.height);
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
