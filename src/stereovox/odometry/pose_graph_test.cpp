#include "stereovox/odometry/pose_graph.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace stereovox {
namespace {

constexpr double kSigma_m = 0.01, kSigma_rad = 0.005, kRobustSigmas = 4.0;

Matrix6d information() {
  Vector6d weights;
  weights.head<3>().setConstant(1.0 / (kSigma_m * kSigma_m));
  weights.tail<3>().setConstant(1.0 / (kSigma_rad * kSigma_rad));
  return weights.asDiagonal();
}

// Around a circle of 2 m radius, looking ahead.
std::vector<SE3> circle(int count) {
  std::vector<SE3> poses;
  for (int i = 0; i < count; ++i) {
    Vector6d turn = Vector6d::Zero();
    turn[4] = 2.0 * std::numbers::pi * i / count;
    poses.push_back(exp(turn) * SE3{Eigen::Quaterniond::Identity(), {2.0, 0.0, 0.0}});
  }
  return poses;
}

PoseLink exact_link(const std::vector<SE3>& truth, int from, int to) {
  const auto at = [&](int i) { return truth[static_cast<std::size_t>(i)]; };
  return {from, to, inverse(at(from)) * at(to), information()};
}

std::vector<PoseLink> chain(const std::vector<SE3>& truth) {
  std::vector<PoseLink> links;
  for (int i = 0; i + 1 < static_cast<int>(truth.size()); ++i)
    links.push_back(exact_link(truth, i, i + 1));
  return links;
}

std::vector<bool> only_first_fixed(std::size_t count) {
  std::vector<bool> fixed(count, false);
  fixed[0] = true;
  return fixed;
}

double largest_error(const std::vector<SE3>& poses, const std::vector<SE3>& truth) {
  double largest = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    largest = std::max(largest, log(inverse(truth[i]) * poses[i]).norm());
  return largest;
}

TEST(PoseGraph, ExactLinksGiveTheTruthFromAFarStart) {
  const std::vector<SE3> truth = circle(12);
  std::vector<PoseLink> links = chain(truth);
  links.push_back(exact_link(truth, 11, 0));
  std::vector<SE3> poses = truth;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (std::size_t i = 1; i < poses.size(); ++i)
    poses[i] = poses[i] * exp(Vector6d::NullaryExpr([&] { return noise(random); }));
  optimize(links, only_first_fixed(poses.size()), kRobustSigmas, poses);
  EXPECT_LT(largest_error(poses, truth), 1e-6);
  EXPECT_LT(chi_squared(links.back(), poses), 1e-6);
}

TEST(PoseGraph, AClosedLoopSharesTheErrorOfItsLinks) {
  const std::vector<SE3> truth = circle(24);
  std::vector<PoseLink> links = chain(truth);
  Vector6d drift = Vector6d::Zero();
  drift[4] = 0.004;
  std::vector<SE3> poses = {truth[0]};
  for (PoseLink& link : links) {
    link.T_from_to = link.T_from_to * exp(drift);
    poses.push_back(poses.back() * link.T_from_to);
  }
  const double before = largest_error(poses, truth);
  links.push_back(exact_link(truth, 23, 0));
  optimize(links, only_first_fixed(poses.size()), kRobustSigmas, poses);
  EXPECT_LT(largest_error(poses, truth), 0.3 * before);
}

TEST(PoseGraph, AWrongLinkCountsLittle) {
  const std::vector<SE3> truth = circle(12);
  std::vector<PoseLink> links = chain(truth);
  links.push_back(exact_link(truth, 11, 0));
  links.push_back(exact_link(truth, 3, 9));
  Vector6d wrong;
  wrong << 0.5, 0.0, 0.3, 0.0, 0.4, 0.0;
  links.back().T_from_to = links.back().T_from_to * exp(wrong);
  std::vector<SE3> poses = truth;
  optimize(links, only_first_fixed(poses.size()), kRobustSigmas, poses);
  EXPECT_LT(largest_error(poses, truth), 0.02);
  optimize(links, only_first_fixed(poses.size()), 1e6, poses);
  EXPECT_GT(largest_error(poses, truth), 0.1) << "what it does when all links count in full";
}

TEST(PoseGraph, TheMoreCertainLinkGivesWayLess) {
  std::vector<SE3> poses(2);
  PoseLink sure{0, 1, {Eigen::Quaterniond::Identity(), {1.00, 0, 0}}, 9.0 * information()};
  PoseLink unsure{0, 1, {Eigen::Quaterniond::Identity(), {1.01, 0, 0}}, information()};
  poses[1] = sure.T_from_to;
  optimize(std::vector{sure, unsure}, {true, false}, 1e6, poses);
  EXPECT_NEAR(poses[1].translation.x(), 1.001, 1e-6);
}

TEST(PoseGraph, FixedAndUntiedPosesKeepTheirPlace) {
  std::vector<SE3> poses = circle(5);
  const std::vector<SE3> before = poses;
  Vector6d shift = Vector6d::Zero();
  shift[0] = 0.3;
  PoseLink link = exact_link(before, 0, 1);
  link.T_from_to = link.T_from_to * exp(shift);
  optimize(std::vector{link}, {true, false, false, true, false}, kRobustSigmas, poses);
  EXPECT_GT(log(inverse(before[1]) * poses[1]).norm(), 0.29);
  for (const std::size_t i : {0, 2, 3, 4})
    EXPECT_LT(log(inverse(before[i]) * poses[i]).norm(), 1e-12) << i;
}

}  // namespace
}  // namespace stereovox
