#include "stereovox/simulation/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "stereovox/core/parallel.h"
#include "stereovox/simulation/lighting.h"

namespace stereovox {
namespace {

// Eight places in a pixel, no two in one row or column of an 8 x 8 grid.
constexpr std::array<std::array<float, 2>, 8> kSubpixels = {{{-0.4375F, -0.1875F},
                                                             {-0.3125F, 0.3125F},
                                                             {-0.1875F, -0.4375F},
                                                             {-0.0625F, 0.0625F},
                                                             {0.0625F, 0.4375F},
                                                             {0.1875F, -0.3125F},
                                                             {0.3125F, 0.1875F},
                                                             {0.4375F, -0.0625F}}};
// Two pixels of one solid belong to two of its faces when their normals differ by 2.5 degrees.
constexpr float kSameFaceCosine = 0.999F;

struct Camera {
  const PixelRays& rays;
  Eigen::Matrix3f R_world_camera;
  Eigen::Vector3f center_m;
  float pixel_rad;

  Camera(const PixelRays& pixels, const SE3& T_world_camera)
      : rays(pixels),
        R_world_camera(T_world_camera.rotation.toRotationMatrix().cast<float>()),
        center_m(T_world_camera.translation.cast<float>()) {
    const float u = 0.5F * static_cast<float>(pixels.width()),
                v = 0.5F * static_cast<float>(pixels.height());
    pixel_rad = pixels.direction(u + 1, v).x() - pixels.direction(u, v).x();
  }

  Ray ray(float u, float v) const { return {center_m, R_world_camera * rays.direction(u, v)}; }
};

std::vector<Seen> look(const Scene& scene, const Camera& camera, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  scene.cast(rays, hits);
  std::vector<Seen> seen(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) seen[i] = {rays[i], hits[i], camera.pixel_rad};
  return seen;
}

std::vector<Seen> look_along_row(const Scene& scene, const Camera& camera, int v) {
  std::vector<Ray> rays;
  for (int u = 0; u < camera.rays.width(); ++u)
    rays.push_back(camera.ray(static_cast<float>(u), static_cast<float>(v)));
  return look(scene, camera, rays);
}

bool same_surface(const Hit& a, const Hit& b) {
  return a.solid == b.solid && a.normal.dot(b.normal) > kSameFaceCosine;
}

// Mean radiance over the pixels at edges, several rays each.
void smooth_edges(const World& world, const Scene& scene, const Camera& camera,
                  const std::vector<int>& columns, int v, float* radiance) {
  std::vector<Ray> rays;
  for (const int u : columns)
    for (const auto& [du, dv] : kSubpixels)
      rays.push_back(camera.ray(static_cast<float>(u) + du, static_cast<float>(v) + dv));
  const std::vector<float> parts = radiance_of(world, scene, look(scene, camera, rays));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto first = parts.begin() + static_cast<std::ptrdiff_t>(i * kSubpixels.size());
    radiance[columns[i]] =
        std::accumulate(first, first + kSubpixels.size(), 0.0F) / kSubpixels.size();
  }
}

// Columns of the pixels of a row that have another surface beside them.
std::vector<int> edge_columns(const std::vector<std::vector<Seen>>& rows, int v) {
  const auto at = [&](int row, int u) -> const Hit& {
    const auto& seen =
        rows[static_cast<std::size_t>(std::clamp(row, 0, static_cast<int>(rows.size()) - 1))];
    return seen[static_cast<std::size_t>(std::clamp(u, 0, static_cast<int>(seen.size()) - 1))].hit;
  };
  std::vector<int> columns;
  for (int u = 0; u < static_cast<int>(rows[0].size()); ++u) {
    const Hit& hit = at(v, u);
    const bool is_inside = same_surface(hit, at(v, u - 1)) && same_surface(hit, at(v, u + 1)) &&
                           same_surface(hit, at(v - 1, u)) && same_surface(hit, at(v + 1, u));
    if (!is_inside) columns.push_back(u);
  }
  return columns;
}

cv::Mat2f undistorted_directions(const CameraCalibration& camera) {
  const PinholeCamera& pinhole = camera.pinhole;
  cv::Mat2f pixels(pinhole.height + 2, pinhole.width + 2);
  for (int v = 0; v < pixels.rows; ++v)
    for (int u = 0; u < pixels.cols; ++u) pixels(v, u) = cv::Vec2f(u - 1.0F, v - 1.0F);
  const cv::Matx33d K(pinhole.fx_px, 0, pinhole.cx_px, 0, pinhole.fy_px, pinhole.cy_px, 0, 0, 1);
  cv::Mat directions;
  const cv::Mat list = pixels.reshape(2, static_cast<int>(pixels.total()));
  if (camera.distortion_model == DistortionModel::equidistant)
    cv::fisheye::undistortPoints(list, directions, K, camera.distortion);
  else
    cv::undistortPoints(list, directions, K, camera.distortion);
  return directions.reshape(2, pixels.rows);
}

}  // namespace

PixelRays::PixelRays(const CameraCalibration& camera)
    : directions_(undistorted_directions(camera)) {}

Eigen::Vector3f PixelRays::direction(float u_px, float v_px) const {
  const float x = u_px + 1, y = v_px + 1;
  const int i = std::clamp(static_cast<int>(x), 0, directions_.cols - 2);
  const int j = std::clamp(static_cast<int>(y), 0, directions_.rows - 2);
  const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
  const cv::Vec2f above = directions_(j, i) * (1 - fx) + directions_(j, i + 1) * fx;
  const cv::Vec2f below = directions_(j + 1, i) * (1 - fx) + directions_(j + 1, i + 1) * fx;
  const cv::Vec2f d = above * (1 - fy) + below * fy;
  return {d[0], d[1], 1.0F};
}

cv::Mat1f render(const World& world, const Scene& scene, const PixelRays& rays,
                 const SE3& T_world_camera, int threads) {
  const Camera camera(rays, T_world_camera);
  cv::Mat1f radiance(rays.height(), rays.width());
  std::vector<std::vector<Seen>> rows(static_cast<std::size_t>(rays.height()));
  parallel_for(0, rays.height(), threads, [&](int v) {
    rows[static_cast<std::size_t>(v)] = look_along_row(scene, camera, v);
    std::ranges::copy(radiance_of(world, scene, rows[static_cast<std::size_t>(v)]), radiance[v]);
  });
  parallel_for(0, rays.height(), threads, [&](int v) {
    smooth_edges(world, scene, camera, edge_columns(rows, v), v, radiance[v]);
  });
  return radiance;
}

cv::Mat1f depth_of(const Scene& scene, const PixelRays& rays, const SE3& T_world_camera,
                   int threads) {
  const Camera camera(rays, T_world_camera);
  cv::Mat1f depth_m(rays.height(), rays.width());
  parallel_for(0, rays.height(), threads, [&](int v) {
    // Directions have z = 1, so distances along them are depths.
    std::ranges::transform(look_along_row(scene, camera, v), depth_m[v],
                           [](const Seen& seen) { return seen.hit.distance; });
  });
  return depth_m;
}

cv::Mat1b occluded_pixels(const Scene& scene, const PixelRays& left, const cv::Mat1f& left_depth_m,
                          const SE3& T_world_left, const RectifiedCamera& pair, int threads) {
  const Camera camera(left, T_world_left);
  const Eigen::Vector3f right_center_m =
      (T_world_left * Eigen::Vector3d(pair.baseline_m, 0, 0)).cast<float>();
  cv::Mat1b occluded(left.height(), left.width());
  parallel_for(0, left.height(), threads, [&](int v) {
    std::vector<LightPath> segments;
    for (int u = 0; u < left.width(); ++u) {
      const Ray ray = camera.ray(static_cast<float>(u), static_cast<float>(v));
      segments.push_back({ray.origin_m + left_depth_m(v, u) * ray.direction, right_center_m});
    }
    std::vector<char> is_blocked(segments.size());
    scene.block(segments, is_blocked);
    for (int u = 0; u < left.width(); ++u) {
      const double depth_m = left_depth_m(v, u);
      const bool is_seen = depth_m > 0 && u >= pair.disparity_px(depth_m) &&
                           !is_blocked[static_cast<std::size_t>(u)];
      occluded(v, u) = is_seen ? 0 : 255;
    }
  });
  return occluded;
}

}  // namespace stereovox
