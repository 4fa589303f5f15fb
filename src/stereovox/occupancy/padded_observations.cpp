// The loop is written so that compilers turn it into vector instructions.
#include "stereovox/occupancy/padded_observations.h"

#include <algorithm>
#include <cmath>

namespace stereovox {
namespace {

constexpr int kCube = 27;  // a block and those around it
constexpr int kSide = kBlockSide + 2;

Eigen::Vector3i step_to(int i) { return {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}; }

constexpr int padded_step(int x, int y, int z) { return x + kSide * (y + kSide * z); }
constexpr int padded_position(int x, int y, int z) { return padded_step(x + 1, y + 1, z + 1); }

// The rows of a layer with what lies between them in the padded observations, so that there is one
// long loop.
constexpr std::size_t kStretch = kSide * kBlockSide;

struct Layer {
  const float* first;  // its first voxel
  std::span<const Eigen::Vector3i> neighbours;
  double least_observation;  // neighbours with less do not count
};

struct CompareNeighbours {
  [[gnu::always_inline]] void operator()(const Layer& layer, PerVoxelOfLayer<double>& out) const {
    std::array<double, kStretch> sums{}, counts{};
    const double least = layer.least_observation;
    for (const Eigen::Vector3i& step : layer.neighbours) {
      const float* const here = layer.first;
      const float* const beside = here + padded_step(step.x(), step.y(), step.z());
      for (std::size_t i = 0; i < kStretch; ++i) {
        const double other = beside[i];
        const double weight = other >= least ? 1.0 : 0.0;
        sums[i] += weight * std::abs(here[i] - (other > 0.0 ? other : 0.0));
        counts[i] += weight;
      }
    }
    for (std::size_t i = 0; i < kStretch; ++i)
      sums[i] = counts[i] > 0.0 ? sums[i] / counts[i] : 0.0;
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = sums[i / kBlockSide * kSide + i % kBlockSide];
  }
};

}  // namespace

PaddedObservations::PaddedObservations(const FrameObservation& frame,
                                       const BlockObservation& center) {
  std::array<const BlockObservation*, kCube> blocks{};
  for (int i = 0; i < kCube; ++i) {
    const int number = frame.index.find(center.index + step_to(i));
    if (number == BlockIndex::kNone) continue;
    const BlockObservation& block = frame.blocks[static_cast<std::size_t>(number)];
    blocks[static_cast<std::size_t>(i)] = &block;
    has_hits_ = has_hits_ || !block.values.empty();
  }
  if (!has_hits_) return;
  values_.fill(kUnobserved);
  for (int i = 0; i < kCube; ++i)
    if (blocks[static_cast<std::size_t>(i)] != nullptr)
      copy_overlap(*blocks[static_cast<std::size_t>(i)], step_to(i));
}

void PaddedObservations::copy_overlap(const BlockObservation& block, const Eigen::Vector3i& step) {
  const auto low = [](int s) { return s < 0 ? kBlockSide - 1 : 0; };
  const auto high = [](int s) { return s > 0 ? 0 : kBlockSide - 1; };
  const int x_low = low(step.x()), count = high(step.x()) - x_low + 1;
  for (int z = low(step.z()); z <= high(step.z()); ++z)
    for (int y = low(step.y()); y <= high(step.y()); ++y) {
      float* const to =
          values_.data() + padded_position(x_low + kBlockSide * step.x(), y + kBlockSide * step.y(),
                                           z + kBlockSide * step.z());
      const int from = position_in_block({x_low, y, z});
      for (int x = 0; x < count; ++x) to[x] = block.value_at(from + x);
    }
}

void PaddedObservations::heterogeneities(int layer, const HomogeneityParams& params,
                                         PerVoxelOfLayer<double>& out, VectorTarget target) const {
  const Layer in{values_.data() + padded_position(0, 0, layer), neighbour_steps(params.neighbours),
                 params.unobserved == UnobservedNeighbours::excluded ? 0.0 : kUnobserved};
  run_on(target, CompareNeighbours{}, in, out);
}

}  // namespace stereovox
