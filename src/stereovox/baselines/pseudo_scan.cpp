#include "stereovox/baselines/pseudo_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <span>

#include "stereovox/core/angles.h"
#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr double kSpeckleSteps = 16.0;     // disparities are compared in sixteenths of a pixel
constexpr float kSigmasOfTheFarthest = 3;  // three sigmas hold all but one in a thousand points
// Reading window [R - sigma, R + 2 sigma] around a candidate R.
constexpr float kSigmasBefore = 1, kSigmasBehind = 2;
constexpr std::size_t kFirstSorted = 64;  // nearest points of a bin that are looked at first

struct RangePoint {
  float range_m, sigma_m;
};

struct Bin {
  std::vector<RangePoint> obstacles;
  std::vector<float> free_ranges_m;
};

// Bearing bins, found by the tangent of the bearing: successive pixels mostly share a bin.
class BearingBins {
 public:
  BearingBins(const PinholeCamera& camera, double width_rad) : width_rad_(width_rad) {
    const double left_rad = std::atan(camera.cx_px / camera.fx_px);
    const double right_rad = std::atan((camera.width - 1 - camera.cx_px) / camera.fx_px);
    const auto count = std::max(1, static_cast<int>((left_rad + right_rad) / width_rad));
    first_rad_ = 0.5 * (left_rad - right_rad - count * width_rad);
    for (int i = 0; i <= count; ++i)
      edges_.push_back(static_cast<float>(std::tan(first_rad_ + i * width_rad)));
  }

  int count() const { return static_cast<int>(edges_.size()) - 1; }
  double center_rad(int bin) const { return first_rad_ + (bin + 0.5) * width_rad_; }

  // Moves `bin` to where the tangent lies; -1 or count() when that is outside.
  void follow(float tangent, int& bin) const {
    while (bin < count() && tangent >= edge(bin + 1)) ++bin;
    while (bin >= 0 && tangent < edge(bin)) --bin;
  }

 private:
  float edge(int i) const { return edges_[static_cast<std::size_t>(i)]; }

  double width_rad_, first_rad_;
  std::vector<float> edges_;  // tangents, rising
};

cv::Mat1s without_speckles(const cv::Mat1f& disparity_px, const PseudoScanParams& params) {
  cv::Mat steps;
  disparity_px.convertTo(steps, CV_16S, kSpeckleSteps);
  cv::filterSpeckles(steps, 0.0, params.speckle_size_px - 1,
                     params.speckle_range_px * kSpeckleSteps);
  return steps;
}

// Coordinates in the level frame: x along the heading, y to the left, z up.
Eigen::Matrix3d level_from_camera(const SE3& T_world_camera, double heading_rad) {
  return (Eigen::AngleAxisd(-heading_rad, Eigen::Vector3d::UnitZ()) * T_world_camera.rotation)
      .toRotationMatrix();
}

// Eq. (10): the pointing part grows with z, the disparity part with z^2; `slope_sq` is the squared
// tangent of the angle to the optical axis.
struct RangeError {
  float pointing_sq, disparity_scale;

  RangeError(const RectifiedCamera& camera, double sigma_pointing_px)
      : pointing_sq(static_cast<float>(std::pow(sigma_pointing_px / camera.pinhole.fx_px, 2))),
        disparity_scale(static_cast<float>(1.0 / (camera.pinhole.fx_px * camera.baseline_m))) {}

  float sigma_m(float depth_m, float slope_sq, float sigma_disparity_px) const {
    const float along = depth_m * disparity_scale * sigma_disparity_px;
    return depth_m *
           std::sqrt(pointing_sq * slope_sq / (1 + slope_sq) + along * along * (1 + slope_sq));
  }
};

struct LevelPoint {
  float height_m, range_m, sigma_m;
};

// Sorts a point into its bin by what it says: an obstacle, or free space up to floor or background.
class PointSorter {
 public:
  PointSorter(const PseudoScanParams& params, double camera_height_m)
      : low_m_(static_cast<float>(params.min_height_m)),
        high_m_(static_cast<float>(params.max_height_m)),
        floor_m_(static_cast<float>(-params.floor_tolerance_m)),
        max_range_m_(static_cast<float>(params.max_range_m)),
        free_cap_m_(static_cast<float>(params.max_range_m + params.free_margin_m)),
        camera_height_m_(static_cast<float>(camera_height_m)) {}

  void add(const LevelPoint& point, Bin& bin) const {
    if (point.height_m < floor_m_) return;  // below the floor: a mismatch
    const bool is_in_band = point.height_m >= low_m_ && point.height_m <= high_m_;
    // Some points beyond the reach belong to a wall just inside it.
    if (is_in_band && point.range_m <= free_cap_m_)
      bin.obstacles.push_back({point.range_m, point.sigma_m});
    if (point.height_m >= low_m_ && point.range_m <= max_range_m_) return;
    const float free_m =
        (point.range_m - kSigmasOfTheFarthest * point.sigma_m) * share_in_band(point.height_m);
    if (free_m > 0) bin.free_ranges_m.push_back(std::min(free_m, free_cap_m_));
  }

 private:
  // A sight line to a point above the band shows free space only until it leaves the band.
  float share_in_band(float height_m) const {
    if (height_m <= high_m_) return 1;
    return std::max(0.0F, (high_m_ - camera_height_m_) / (height_m - camera_height_m_));
  }

  float low_m_, high_m_, floor_m_, max_range_m_, free_cap_m_, camera_height_m_;
};

struct Reading {
  double range_m, sigma_m;
};

// Median range of the points in the window around `candidate`; `points` are sorted up to it.
Reading median_in_window(std::span<const RangePoint> points, const RangePoint& candidate) {
  const float nearest_m = candidate.range_m - kSigmasBefore * candidate.sigma_m;
  const float farthest_m = candidate.range_m + kSigmasBehind * candidate.sigma_m;
  std::vector<RangePoint> inside;
  for (const RangePoint& point : points)
    if (point.range_m >= nearest_m && point.range_m <= farthest_m) inside.push_back(point);
  const auto middle = inside.begin() + static_cast<std::ptrdiff_t>(inside.size() / 2);
  std::ranges::nth_element(inside, middle, {}, &RangePoint::range_m);
  return {middle->range_m, middle->sigma_m};
}

// The nearest range R with enough points in [R - sigma, R + 2 sigma]. Most bins are decided by
// their nearest points, so only as many as needed are sorted.
std::optional<Reading> nearest_reading(std::span<RangePoint> points, std::size_t min_points) {
  std::size_t sorted = 0, first = 0;  // `first` = nearest point in the candidate's window
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + min_points > sorted) {
      const std::size_t target = std::max({kFirstSorted, 2 * sorted, i + min_points});
      const std::size_t end = std::min(target, points.size());
      std::ranges::partial_sort(points.subspan(sorted),
                                points.begin() + static_cast<std::ptrdiff_t>(end), {},
                                &RangePoint::range_m);
      sorted = end;
    }
    const RangePoint& candidate = points[i];
    const float nearest_m = candidate.range_m - kSigmasBefore * candidate.sigma_m;
    for (first = i; first > 0 && points[first - 1].range_m >= nearest_m;) --first;
    if (first + min_points > points.size()) return std::nullopt;
    const float farthest_m = candidate.range_m + kSigmasBehind * candidate.sigma_m;
    if (points[first + min_points - 1].range_m <= farthest_m)
      return median_in_window(points, candidate);
  }
  return std::nullopt;
}

// The farthest range that at least `min_points` points show to be free.
double farthest_free_m(std::vector<float>& free_ranges_m, std::size_t min_points) {
  if (free_ranges_m.size() < min_points) return 0.0;
  const auto supported = free_ranges_m.begin() + static_cast<std::ptrdiff_t>(min_points - 1);
  std::ranges::nth_element(free_ranges_m, supported, std::greater<>());
  return *supported;
}

Beam beam_of(Bin& bin, double bearing_rad, const PseudoScanParams& params) {
  const auto min_points = static_cast<std::size_t>(params.min_points);
  Beam beam{.bearing_rad = bearing_rad};
  beam.free_range_m = farthest_free_m(bin.free_ranges_m, min_points);
  const auto reading = nearest_reading(bin.obstacles, min_points);
  if (!reading || reading->range_m > params.max_range_m) return beam;
  beam.range_m = reading->range_m;
  beam.sigma_m = std::max(reading->sigma_m, params.min_sigma_range_m);
  beam.has_range = true;
  return beam;
}

// Walks over the disparity image and fills the bins.
class BinFiller {
 public:
  BinFiller(const RectifiedCamera& camera, const SE3& T_world_camera, double heading_rad,
            double floor_z_m, const PseudoScanParams& params)
      : pinhole_(camera.pinhole),
        R_level_camera_(level_from_camera(T_world_camera, heading_rad).cast<float>()),
        camera_height_m_(static_cast<float>(T_world_camera.translation.z() - floor_z_m)),
        focal_baseline_px_m_(static_cast<float>(camera.depth_m(1.0))),
        min_sigma_px_(static_cast<float>(params.min_sigma_disparity_px)),
        error_(camera, params.sigma_pointing_px),
        sorter_(params, camera_height_m_),
        bearings_(camera.pinhole, params.bin_width_deg * kDegree_rad),
        bins_(static_cast<std::size_t>(bearings_.count())) {}

  void add_row(const DisparityImage& disparity, const cv::Mat1s& kept, int v) {
    const float* const disparities_px = disparity.disparity_px[v];
    const short* const is_kept = kept[v];
    const auto y = static_cast<float>((v - pinhole_.cy_px) / pinhole_.fy_px);
    int bin = bearings_.count() - 1;
    for (int u = 0; u < disparity.width(); ++u) {
      if (!(disparities_px[u] > 0) || is_kept[u] == 0) continue;
      const auto x = static_cast<float>((u - pinhole_.cx_px) / pinhole_.fx_px);
      const Eigen::Vector3f ray_level = R_level_camera_ * Eigen::Vector3f(x, y, 1);
      if (ray_level.x() <= 0) continue;  // beside or behind a steep camera
      bearings_.follow(ray_level.y() / ray_level.x(), bin);
      if (bin < 0 || bin >= bearings_.count()) continue;
      const float sigma_px = std::max(disparity.sigma_px(v, u), min_sigma_px_);
      const float depth_m = focal_baseline_px_m_ / disparities_px[u];
      sorter_.add({camera_height_m_ + depth_m * ray_level.z(), depth_m * ray_level.head<2>().norm(),
                   error_.sigma_m(depth_m, x * x + y * y, sigma_px)},
                  bins_[static_cast<std::size_t>(bin)]);
    }
  }

  std::vector<Beam> beams(const PseudoScanParams& params) {
    std::vector<Beam> beams;
    beams.reserve(static_cast<std::size_t>(bearings_.count()));
    for (int i = 0; i < bearings_.count(); ++i)
      beams.push_back(beam_of(bins_[static_cast<std::size_t>(i)], bearings_.center_rad(i), params));
    return beams;
  }

 private:
  PinholeCamera pinhole_;
  Eigen::Matrix3f R_level_camera_;
  float camera_height_m_, focal_baseline_px_m_, min_sigma_px_;
  RangeError error_;
  PointSorter sorter_;
  BearingBins bearings_;
  std::vector<Bin> bins_;
};

}  // namespace

void PseudoScanParams::describe(ParameterList& list) {
  list("min_height_m", min_height_m, {-10, 100}, "lower end of the height band, above the floor");
  list("max_height_m", max_height_m, {-10, 100}, "upper end of the height band, above the floor");
  list("floor_tolerance_m", floor_tolerance_m, {0, 10},
       "points farther below the floor are mismatches");
  list("speckle_size_px", speckle_size_px, {0, 100000}, "smaller islands of disparity are dropped");
  list("speckle_range_px", speckle_range_px, {0.1, 64}, "largest disparity step in an island");
  list("bin_width_deg", bin_width_deg, {0.05, 10}, "width of a bearing bin");
  list("min_points", min_points, {1, 10000}, "points that must support a range");
  list("max_range_m", max_range_m, {0.5, 100}, "farther readings are background");
  list("free_margin_m", free_margin_m, {0, 10},
       "how far beyond max_range_m background shows free space");
  list("sigma_pointing_px", sigma_pointing_px, {0, 10}, "standard deviation of a pixel's position");
  list("min_sigma_disparity_px", min_sigma_disparity_px, {0.01, 10},
       "least standard deviation of a disparity");
  list("min_sigma_range_m", min_sigma_range_m, {0.0001, 10}, "least standard deviation of a range");
}

double range_sigma_m(const RectifiedCamera& camera, double u_px, double v_px, double disparity_px,
                     double sigma_pointing_px, double sigma_disparity_px) {
  const PinholeCamera& pinhole = camera.pinhole;
  const double x = (u_px - pinhole.cx_px) / pinhole.fx_px;
  const double y = (v_px - pinhole.cy_px) / pinhole.fy_px;
  return RangeError(camera, sigma_pointing_px)
      .sigma_m(static_cast<float>(camera.depth_m(disparity_px)), static_cast<float>(x * x + y * y),
               static_cast<float>(sigma_disparity_px));
}

PseudoScan pseudo_scan(const DisparityImage& disparity, const RectifiedCamera& camera,
                       const SE3& T_world_camera, double floor_z_m, std::int64_t stamp_ns,
                       const PseudoScanParams& params) {
  if (params.min_height_m > params.max_height_m)
    throw UsageError(fmt::format("pseudo scan: min_height_m {} is above max_height_m {}",
                                 params.min_height_m, params.max_height_m));
  const Eigen::Vector3d axis_world = T_world_camera.rotation * Eigen::Vector3d::UnitZ();
  const double heading_rad = std::atan2(axis_world.y(), axis_world.x());
  BinFiller filler(camera, T_world_camera, heading_rad, floor_z_m, params);
  const cv::Mat1s kept = without_speckles(disparity.disparity_px, params);
  for (int v = 0; v < disparity.height(); ++v) filler.add_row(disparity, kept, v);
  return {stamp_ns, T_world_camera.translation.head<2>(), heading_rad, filler.beams(params)};
}

}  // namespace stereovox
