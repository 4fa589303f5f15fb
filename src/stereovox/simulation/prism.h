// The one solid that worlds are made of: an upright prism over a convex base. Its top may slope,
// so boxes, round posts and ramps are prisms, and rendering, ideal maps and ideal voxels follow
// from the same few functions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace stereovox {

// Convex, counter-clockwise, at least three corners.
using Polygon2D = std::vector<Eigen::Vector2d>;

struct Prism {
  std::string name;  // of the thing it is part of, for messages
  Polygon2D base_m;
  double bottom_m = 0.0, top_m = 0.0;  // heights; the top at the first corner of the base
  Eigen::Vector2d top_slope = Eigen::Vector2d::Zero();  // rise of the top per metre along x and y
  int material = 0;                                     // position in World::materials
  Eigen::Vector3d texture_origin_m = Eigen::Vector3d::Zero();  // moves with what moves

  double top_at_m(const Eigen::Vector2d& p) const { return top_m + top_slope.dot(p - base_m[0]); }
};

struct Placement {
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;

  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const;
};

// A box of the given length (along x), width and height, its centre at `at` after turning by yaw.
Prism box_prism(const Placement& at, const Eigen::Vector3d& size_m, double bottom_m, int material);

// Rises from nothing at -x to the full height at +x.
Prism ramp_prism(const Placement& at, const Eigen::Vector3d& size_m, double bottom_m, int material);

// A round post, as a prism with many sides.
Prism post_prism(const Eigen::Vector2d& at_m, double radius_m, double height_m, double bottom_m,
                 int material);

// The base of the part of the prism between two heights; empty when there is none.
Polygon2D base_between(const Prism& prism, double low_m, double high_m);

double area_m2(const Polygon2D& polygon);
bool contains(const Polygon2D& polygon, const Eigen::Vector2d& p);

// What is left of a convex polygon on the side where normal . p <= offset.
Polygon2D clipped(const Polygon2D& polygon, const Eigen::Vector2d& normal, double offset);

// The part inside an axis-aligned rectangle.
Polygon2D clipped(const Polygon2D& polygon, const Eigen::Vector2d& min, const Eigen::Vector2d& max);

// Smallest distance from a point to the polygon; 0 inside.
double distance_m(const Polygon2D& polygon, const Eigen::Vector2d& p);

// Width of the polygon across its narrowest direction and along that direction's normal: the sides
// of the tightest turned rectangle around it, narrow one first.
Eigen::Vector2d extents_m(const Polygon2D& polygon);

// A closed surface of triangles with outward normals.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> corners;
  std::vector<std::array<unsigned, 3>> triangles;
};
TriangleMesh mesh_of(const Prism& prism);

}  // namespace stereovox
