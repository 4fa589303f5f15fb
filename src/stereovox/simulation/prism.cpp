#include "stereovox/simulation/prism.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace stereovox {
namespace {

// Enough that the flats of a 0.3 m post stay within 2 mm of the circle.
constexpr int kSidesOfPost = 24;

Polygon2D rectangle(const Placement& at, double length_m, double width_m) {
  const double x = length_m / 2, y = width_m / 2;
  return {at * Eigen::Vector2d(-x, -y), at * Eigen::Vector2d(x, -y), at * Eigen::Vector2d(x, y),
          at * Eigen::Vector2d(-x, y)};
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distance_to_edge_m(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                          const Eigen::Vector2d& p) {
  const Eigen::Vector2d edge = b - a;
  const double t = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (p - a - t * edge).norm();
}

// Calls use(a, b) for each edge.
template <class Use>
void for_each_edge(const Polygon2D& polygon, Use use) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    use(polygon[i], polygon[(i + 1) % polygon.size()]);
}

Eigen::Vector3f point3(const Eigen::Vector2d& p, double z) {
  return Eigen::Vector3d(p.x(), p.y(), z).cast<float>();
}

}  // namespace

Eigen::Vector2d Placement::operator*(const Eigen::Vector2d& p) const {
  return at_m + Eigen::Rotation2Dd(yaw_rad) * p;
}

Prism box_prism(const Placement& at, const Eigen::Vector3d& size_m, double bottom_m, int material) {
  return {.name = {},
          .base_m = rectangle(at, size_m.x(), size_m.y()),
          .bottom_m = bottom_m,
          .top_m = bottom_m + size_m.z(),
          .material = material};
}

Prism ramp_prism(const Placement& at, const Eigen::Vector3d& size_m, double bottom_m,
                 int material) {
  Prism ramp = box_prism(at, size_m, bottom_m, material);
  ramp.top_m = bottom_m;  // the first corner lies at -x
  ramp.top_slope = Eigen::Rotation2Dd(at.yaw_rad) * Eigen::Vector2d(size_m.z() / size_m.x(), 0.0);
  return ramp;
}

Prism post_prism(const Eigen::Vector2d& at_m, double radius_m, double height_m, double bottom_m,
                 int material) {
  Polygon2D base;
  for (int i = 0; i < kSidesOfPost; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSidesOfPost;
    base.push_back(at_m + radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return {.name = {},
          .base_m = std::move(base),
          .bottom_m = bottom_m,
          .top_m = bottom_m + height_m,
          .material = material};
}

Polygon2D base_between(const Prism& prism, double low_m, double high_m) {
  if (prism.bottom_m >= high_m) return {};
  if (prism.top_slope.isZero()) return prism.top_m > low_m ? prism.base_m : Polygon2D{};
  // Where the sloping top lies above `low`: -slope . p <= top(0) - low.
  const double top_at_origin = prism.top_m - prism.top_slope.dot(prism.base_m[0]);
  return clipped(prism.base_m, -prism.top_slope, top_at_origin - low_m);
}

double area_m2(const Polygon2D& polygon) {
  double twice = 0.0;
  for_each_edge(polygon, [&](const auto& a, const auto& b) { twice += cross(a, b); });
  return twice / 2;
}

bool contains(const Polygon2D& polygon, const Eigen::Vector2d& p) {
  bool inside = !polygon.empty();
  for_each_edge(polygon, [&](const auto& a, const auto& b) { inside &= cross(b - a, p - a) >= 0; });
  return inside;
}

Polygon2D clipped(const Polygon2D& polygon, const Eigen::Vector2d& normal, double offset) {
  Polygon2D kept;
  for_each_edge(polygon, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double beyond_a = normal.dot(a) - offset, beyond_b = normal.dot(b) - offset;
    if (beyond_a <= 0) kept.push_back(a);
    if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0))
      kept.push_back(a + (b - a) * (beyond_a / (beyond_a - beyond_b)));
  });
  return kept.size() < 3 ? Polygon2D{} : kept;
}

Polygon2D clipped(const Polygon2D& polygon, const Eigen::Vector2d& min,
                  const Eigen::Vector2d& max) {
  Polygon2D kept = clipped(polygon, Eigen::Vector2d::UnitX(), max.x());
  kept = clipped(kept, Eigen::Vector2d::UnitY(), max.y());
  kept = clipped(kept, -Eigen::Vector2d::UnitX(), -min.x());
  return clipped(kept, -Eigen::Vector2d::UnitY(), -min.y());
}

double distance_m(const Polygon2D& polygon, const Eigen::Vector2d& p) {
  if (contains(polygon, p)) return 0.0;
  double smallest = std::numeric_limits<double>::infinity();
  for_each_edge(polygon, [&](const auto& a, const auto& b) {
    smallest = std::min(smallest, distance_to_edge_m(a, b, p));
  });
  return smallest;
}

// The narrowest rectangle around a convex polygon has a side along one of its edges.
Eigen::Vector2d extents_m(const Polygon2D& polygon) {
  Eigen::Vector2d best(std::numeric_limits<double>::infinity(), 0.0);
  for_each_edge(polygon, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d along = (b - a).normalized(), across(-along.y(), along.x());
    double width = 0.0, low = 0.0, high = 0.0;
    for (const Eigen::Vector2d& corner : polygon) {
      width = std::max(width, across.dot(corner - a));
      low = std::min(low, along.dot(corner - a));
      high = std::max(high, along.dot(corner - a));
    }
    if (width < best.x()) best = {width, high - low};
  });
  return {std::min(best.x(), best.y()), std::max(best.x(), best.y())};
}

TriangleMesh mesh_of(const Prism& prism) {
  const auto corners = static_cast<unsigned>(prism.base_m.size());
  TriangleMesh mesh;
  for (const Eigen::Vector2d& p : prism.base_m) {  // corner 2i below, 2i + 1 above
    mesh.corners.push_back(point3(p, prism.bottom_m));
    mesh.corners.push_back(point3(p, prism.top_at_m(p)));
  }
  for (unsigned i = 0; i < corners; ++i) {
    const unsigned below = 2 * i, above = below + 1;
    const unsigned next_below = 2 * ((i + 1) % corners), next_above = next_below + 1;
    mesh.triangles.push_back({below, next_below, next_above});
    mesh.triangles.push_back({below, next_above, above});
    if (i < 2) continue;  // fans from the first corner close the top and the bottom
    mesh.triangles.push_back({1, above - 2, above});
    mesh.triangles.push_back({0, below, below - 2});
  }
  return mesh;
}

}  // namespace stereovox
