#include "stereovox/odometry/pose_graph.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace stereovox {
namespace {

constexpr int kMaxGraphIterations = 30;
// Steps below a micrometre and a microradian change nothing.
constexpr double kConverged = 1e-6;
// Keeps poses in place that nothing ties down; measured motions weigh 1e4 and more.
constexpr double kDamping = 1e-6;
constexpr int kFreedom = 6;

Vector6d residual_of(const PoseLink& link, std::span<const SE3> poses) {
  const SE3& T_world_from = poses[static_cast<std::size_t>(link.from)];
  const SE3& T_world_to = poses[static_cast<std::size_t>(link.to)];
  return log(inverse(link.T_from_to) * inverse(T_world_from) * T_world_to);
}

// How twists change under T: exp(adjoint(T) x) = T exp(x) T^-1.
Matrix6d adjoint(const SE3& T) {
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = R;
  A.topRightCorner<3, 3>() = skew(T.translation) * R;
  return A;
}

// d log(exp(r) exp(x)) / dx at 0, to the first order in r.
Matrix6d right_jacobian_inverse(const Vector6d& r) {
  Matrix6d ad = Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = ad.bottomRightCorner<3, 3>() = skew(r.tail<3>());
  ad.topRightCorner<3, 3>() = skew(r.head<3>());
  return Matrix6d::Identity() + 0.5 * ad;
}

// Normal equations of all links in the unknown poses; an index of -1 is a fixed pose.
class NormalEquations {
 public:
  explicit NormalEquations(int unknowns)
      : H_(kFreedom * unknowns, kFreedom * unknowns), g_(Eigen::VectorXd::Zero(H_.rows())) {
    for (int i = 0; i < H_.rows(); ++i) entries_.emplace_back(i, i, kDamping);
  }

  void add(int from, int to, const Matrix6d& J_from, const Matrix6d& J_to, const Matrix6d& W,
           const Vector6d& residual) {
    add_block(from, from, J_from.transpose() * W * J_from);
    add_block(to, to, J_to.transpose() * W * J_to);
    add_block(from, to, J_from.transpose() * W * J_to);
    add_block(to, from, J_to.transpose() * W * J_from);
    add_gradient(from, J_from.transpose() * W * residual);
    add_gradient(to, J_to.transpose() * W * residual);
  }

  // Empty when the equations cannot be solved.
  Eigen::VectorXd step() {
    H_.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(H_);
    if (factors.info() != Eigen::Success) return {};
    return factors.solve(-g_);
  }

 private:
  void add_block(int row, int column, const Matrix6d& block) {
    if (row < 0 || column < 0) return;
    for (int i = 0; i < kFreedom; ++i)
      for (int j = 0; j < kFreedom; ++j)
        entries_.emplace_back(kFreedom * row + i, kFreedom * column + j, block(i, j));
  }
  void add_gradient(int row, const Vector6d& gradient) {
    if (row >= 0) g_.segment<kFreedom>(Eigen::Index{kFreedom} * row) += gradient;
  }

  Eigen::SparseMatrix<double> H_;
  Eigen::VectorXd g_;
  std::vector<Eigen::Triplet<double>> entries_;
};

void add_link(const PoseLink& link, std::span<const SE3> poses, const std::vector<int>& unknown,
              double robust_sigmas, NormalEquations& equations) {
  const Vector6d residual = residual_of(link, poses);
  const double distance2 = residual.dot(link.information * residual);
  const double weight = 1.0 / (1.0 + distance2 / (robust_sigmas * robust_sigmas));
  const auto from = static_cast<std::size_t>(link.from), to = static_cast<std::size_t>(link.to);
  const Matrix6d J_to = right_jacobian_inverse(residual);
  const Matrix6d J_from = -J_to * adjoint(inverse(poses[to]) * poses[from]);
  equations.add(unknown[from], unknown[to], J_from, J_to, weight * link.information, residual);
}

// The place of each pose among the unknowns; -1 for a fixed one.
std::vector<int> numbered(const std::vector<bool>& is_fixed) {
  std::vector<int> unknown;
  unknown.reserve(is_fixed.size());
  for (int count = 0; const bool fixed : is_fixed) unknown.push_back(fixed ? -1 : count++);
  return unknown;
}

}  // namespace

double chi_squared(const PoseLink& link, std::span<const SE3> poses) {
  const Vector6d residual = residual_of(link, poses);
  return residual.dot(link.information * residual);
}

void optimize(std::span<const PoseLink> links, const std::vector<bool>& is_fixed,
              double robust_sigmas, std::vector<SE3>& poses) {
  assert(is_fixed.size() == poses.size());
  const std::vector<int> unknown = numbered(is_fixed);
  const int unknowns = static_cast<int>(std::ranges::count(is_fixed, false));
  if (unknowns == 0) return;
  for (int iteration = 0; iteration < kMaxGraphIterations; ++iteration) {
    NormalEquations equations(unknowns);
    for (const PoseLink& link : links) add_link(link, poses, unknown, robust_sigmas, equations);
    const Eigen::VectorXd step = equations.step();
    if (step.size() == 0 || !step.allFinite()) return;
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (unknown[i] >= 0)
        poses[i] = poses[i] * exp(step.segment<kFreedom>(Eigen::Index{kFreedom} * unknown[i]));
    if (step.lpNorm<Eigen::Infinity>() < kConverged) return;
  }
}

}  // namespace stereovox
