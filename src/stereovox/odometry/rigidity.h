// Which matches can belong to one rigid motion: the distance of two points does not change when the
// camera moves (Hirschmueller, Innocent, Garibaldi 2002; vision.md 1.7, steps 4 and 5). The test
// needs no motion and stands more wrong matches than right ones.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stereovox/core/camera.h"

namespace stereovox {

// A point in a camera's frame. `pixel_error_px` is the error of its column in either image, whose
// difference the disparity is, and sqrt(2) times the error of its row, which both images measure.
struct MeasuredPoint {
  Eigen::Vector3d p_camera;
  double pixel_error_px;
};

// First-order error of the distance between two points of one image, with the paper's terms A, B
// and C per point; infinite when the points coincide.
double distance_error_m(const RectifiedCamera& camera, const MeasuredPoint& a,
                        const MeasuredPoint& b);

// Which matches are consistent with which: a symmetric relation without self-loops.
class ConsistencyGraph {
 public:
  explicit ConsistencyGraph(int size);

  int size() const { return size_; }
  void connect(int a, int b);
  bool are_connected(int a, int b) const;
  std::span<const std::uint64_t> row(int a) const;  // bit b of the row: connected to b

 private:
  int size_;
  std::size_t words_per_row_;
  std::vector<std::uint64_t> bits_;
};

// Matches a and b are connected when their distance changes by at most `max_sigmas` of its error;
// entry i of both lists is match i.
ConsistencyGraph consistency_of(const RectifiedCamera& camera,
                                std::span<const MeasuredPoint> reference,
                                std::span<const MeasuredPoint> current, double max_sigmas);

// A large set of pairwise connected matches, in ascending order: starts with the match that has
// most partners and adds, as long as there are any, the candidate connected to most other
// candidates. The first of equals is taken.
std::vector<int> largest_consistent_cluster(const ConsistencyGraph& graph);

}  // namespace stereovox
