#include "stereovox/odometry/rigidity.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace stereovox {
namespace {

constexpr int kBitsPerWord = 64;

// Variance that point `a` gives the distance along the vector to it from another point, times the
// squared distance: dP/du_l = z/(f t) (t-x, -y, -z), dP/du_r = z/(f t) (x, y, z) and
// dP/dv = z/(f t) (0, t, 0), the last with half the variance.
double scaled_variance(const RectifiedCamera& camera, const MeasuredPoint& a,
                       const Eigen::Vector3d& difference) {
  const double along_ray = difference.dot(a.p_camera);
  const double along_baseline = camera.baseline_m * difference.x();
  const double left = along_baseline - along_ray;
  const double row = camera.baseline_m * difference.y();
  const double gain =
      a.pixel_error_px * a.p_camera.z() / (camera.pinhole.fx_px * camera.baseline_m);
  return gain * gain * (left * left + along_ray * along_ray + 0.5 * row * row);
}

struct Distance {
  double length_m, variance_m2;
};

Distance distance_between(const RectifiedCamera& camera, const MeasuredPoint& a,
                          const MeasuredPoint& b) {
  const Eigen::Vector3d difference = a.p_camera - b.p_camera;
  const double length2 = difference.squaredNorm();
  if (length2 == 0.0) return {0.0, std::numeric_limits<double>::infinity()};
  const double variance =
      scaled_variance(camera, a, difference) + scaled_variance(camera, b, difference);
  return {std::sqrt(length2), variance / length2};
}

int count_common(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += std::popcount(a[i] & b[i]);
  return count;
}

// The member of `candidates` with most partners among them, or -1 when there is no candidate.
int best_connected(const ConsistencyGraph& graph, std::span<const std::uint64_t> candidates) {
  int best = -1, best_count = -1;
  for (std::size_t word = 0; word < candidates.size(); ++word)
    for (std::uint64_t rest = candidates[word]; rest != 0; rest &= rest - 1) {
      const int i = static_cast<int>(word) * kBitsPerWord + std::countr_zero(rest);
      const int count = count_common(graph.row(i), candidates);
      if (count > best_count) {
        best = i;
        best_count = count;
      }
    }
  return best;
}

}  // namespace

double distance_error_m(const RectifiedCamera& camera, const MeasuredPoint& a,
                        const MeasuredPoint& b) {
  return std::sqrt(distance_between(camera, a, b).variance_m2);
}

ConsistencyGraph::ConsistencyGraph(int size)
    : size_(size),
      words_per_row_(static_cast<std::size_t>((size + kBitsPerWord - 1) / kBitsPerWord)),
      bits_(words_per_row_ * static_cast<std::size_t>(size), 0) {}

void ConsistencyGraph::connect(int a, int b) {
  const auto set = [&](int row, int column) {
    bits_[static_cast<std::size_t>(row) * words_per_row_ +
          static_cast<std::size_t>(column / kBitsPerWord)] |= std::uint64_t{1}
                                                              << (column % kBitsPerWord);
  };
  set(a, b);
  set(b, a);
}

bool ConsistencyGraph::are_connected(int a, int b) const {
  return (row(a)[static_cast<std::size_t>(b / kBitsPerWord)] >> (b % kBitsPerWord) & 1U) != 0;
}

std::span<const std::uint64_t> ConsistencyGraph::row(int a) const {
  return std::span(bits_).subspan(static_cast<std::size_t>(a) * words_per_row_, words_per_row_);
}

ConsistencyGraph consistency_of(const RectifiedCamera& camera,
                                std::span<const MeasuredPoint> reference,
                                std::span<const MeasuredPoint> current, double max_sigmas) {
  ConsistencyGraph graph(static_cast<int>(reference.size()));
  for (std::size_t a = 0; a < reference.size(); ++a)
    for (std::size_t b = a + 1; b < reference.size(); ++b) {
      const Distance before = distance_between(camera, reference[a], reference[b]);
      const Distance after = distance_between(camera, current[a], current[b]);
      const double change = before.length_m - after.length_m;
      const double variance = before.variance_m2 + after.variance_m2;
      if (std::isfinite(variance) && change * change <= max_sigmas * max_sigmas * variance)
        graph.connect(static_cast<int>(a), static_cast<int>(b));
    }
  return graph;
}

std::vector<int> largest_consistent_cluster(const ConsistencyGraph& graph) {
  const int size = graph.size();
  std::vector<std::uint64_t> candidates(
      static_cast<std::size_t>((size + kBitsPerWord - 1) / kBitsPerWord), ~std::uint64_t{0});
  if (const int tail = size % kBitsPerWord; tail != 0)
    candidates.back() = (std::uint64_t{1} << tail) - 1;

  std::vector<int> cluster;
  for (int next = best_connected(graph, candidates); next >= 0;
       next = best_connected(graph, candidates)) {
    cluster.push_back(next);
    const std::span<const std::uint64_t> partners = graph.row(next);
    for (std::size_t i = 0; i < candidates.size(); ++i) candidates[i] &= partners[i];
  }
  std::sort(cluster.begin(), cluster.end());
  return cluster;
}

}  // namespace stereovox
