#include "stereovox/odometry/rigidity.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "stereovox/core/se3.h"

namespace stereovox {
namespace {

const RectifiedCamera kCamera{{640, 480, 500.0, 500.0, 320.0, 240.0}, 0.12};

MeasuredPoint random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> side(-1.0, 1.0), depth(1.0, 6.0), error(0.1, 0.4);
  return {{side(random), side(random), depth(random)}, error(random)};
}

// The point whose columns and row are off by these amounts.
Eigen::Vector3d displaced(const MeasuredPoint& point, double left_px, double right_px,
                          double row_px) {
  const Eigen::Vector2d pixel = project(kCamera.pinhole, point.p_camera);
  return triangulate(kCamera, pixel.x() + left_px, pixel.y() + row_px,
                     kCamera.disparity_px(point.p_camera.z()) + left_px - right_px);
}

// The slow twin: numeric derivatives for the three measurements of each point.
double numeric_distance_error_m(const MeasuredPoint& a, const MeasuredPoint& b) {
  constexpr double step_px = 1e-4;
  double variance = 0.0;
  for (const auto& [moving, fixed] : {std::pair(a, b), std::pair(b, a)})
    for (int axis = 0; axis < 3; ++axis) {
      const auto length_at = [&](double px) {
        return (displaced(moving, axis == 0 ? px : 0, axis == 1 ? px : 0, axis == 2 ? px : 0) -
                fixed.p_camera)
            .norm();
      };
      const double slope = (length_at(step_px) - length_at(-step_px)) / (2 * step_px);
      const double error_px = moving.pixel_error_px * (axis == 2 ? std::sqrt(0.5) : 1.0);
      variance += slope * slope * error_px * error_px;
    }
  return std::sqrt(variance);
}

TEST(Rigidity, ErrorOfADistanceIsItsFirstOrderSpread) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const MeasuredPoint a = random_point(random), b = random_point(random);
    const double numeric = numeric_distance_error_m(a, b);
    EXPECT_NEAR(distance_error_m(kCamera, a, b), numeric, 1e-6 * numeric);
  }
}

TEST(Rigidity, ErrorWithOnePixelErrorForAllIsThePapersFormula) {
  const double De = 0.2, f = 500.0, t = 0.12;
  const Eigen::Vector3d P(0.3, -0.2, 2.0), Q(-0.7, 0.4, 3.5);
  const auto terms = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d d = P - Q;
    const double a = d.x() * (t - p.x()) - d.y() * p.y() - d.z() * p.z();
    const double b = d.x() * p.x() + d.y() * p.y() + d.z() * p.z();
    return p.z() * p.z() * (a * a + b * b + 0.5 * std::pow(t * d.y(), 2));
  };
  const double expected = De / ((P - Q).norm() * f * t) * std::sqrt(terms(P) + terms(Q));
  EXPECT_NEAR(distance_error_m(kCamera, {P, De}, {Q, De}), expected, 1e-12);
}

TEST(Rigidity, PointsOfOneRigidMotionAreConsistentAndAStrayPointIsNot) {
  std::mt19937 random(2);
  Vector6d twist;
  twist << 0.3, -0.1, 0.4, 0.1, 0.2, -0.05;
  std::vector<MeasuredPoint> before, after;
  for (int i = 0; i < 70; ++i) {
    before.push_back(random_point(random));
    after.push_back({exp(twist) * before.back().p_camera, before.back().pixel_error_px});
  }
  after[3].p_camera += Eigen::Vector3d(1.5, 1.0, -0.8);
  const ConsistencyGraph graph = consistency_of(kCamera, before, after, 3.0);
  EXPECT_TRUE(graph.are_connected(0, 69));
  const std::vector<int> cluster = largest_consistent_cluster(graph);
  EXPECT_EQ(cluster.size(), 69U);
  EXPECT_EQ(std::ranges::count(cluster, 3), 0);
}

TEST(Rigidity, PointsInOnePlaceAreNotConsistent) {
  const std::vector<MeasuredPoint> same(2, {{0.0, 0.0, 2.0}, 0.2});
  EXPECT_FALSE(consistency_of(kCamera, same, same, 3.0).are_connected(0, 1));
}

bool is_clique(const ConsistencyGraph& graph, const std::vector<int>& members) {
  for (const int a : members)
    for (const int b : members)
      if (a < b && !graph.are_connected(a, b)) return false;
  return true;
}

std::size_t largest_clique_size_by_trying_all(const ConsistencyGraph& graph) {
  std::size_t largest = 0;
  for (unsigned subset = 0; subset < (1U << graph.size()); ++subset) {
    std::vector<int> members;
    for (int i = 0; i < graph.size(); ++i)
      if ((subset >> i & 1U) != 0) members.push_back(i);
    if (members.size() > largest && is_clique(graph, members)) largest = members.size();
  }
  return largest;
}

// Seven of twelve belong together, the other pairs are connected by chance.
ConsistencyGraph graph_with_a_group_of_seven(unsigned seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution by_chance(0.3);
  ConsistencyGraph graph(12);
  for (int a = 0; a < 12; ++a)
    for (int b = a + 1; b < 12; ++b)
      if ((a % 12 < 7 && b % 12 < 7) || by_chance(random)) graph.connect(a, b);
  return graph;
}

TEST(Rigidity, ClusterIsTheLargestOneOfAllSubsets) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const ConsistencyGraph graph = graph_with_a_group_of_seven(seed);
    const std::vector<int> cluster = largest_consistent_cluster(graph);
    EXPECT_TRUE(is_clique(graph, cluster)) << "seed " << seed;
    EXPECT_EQ(cluster.size(), largest_clique_size_by_trying_all(graph)) << "seed " << seed;
  }
}

TEST(Rigidity, ClusterOfNothingIsEmptyAndWithoutConsistencyHasOneMember) {
  EXPECT_TRUE(largest_consistent_cluster(ConsistencyGraph(0)).empty());
  EXPECT_EQ(largest_consistent_cluster(ConsistencyGraph(64)), std::vector<int>{0});
}

}  // namespace
}  // namespace stereovox
