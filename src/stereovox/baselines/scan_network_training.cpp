#include "stereovox/baselines/scan_network_training.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "stereovox/baselines/beam_cells.h"
#include "stereovox/core/error.h"

namespace stereovox {
namespace {

using Weights = std::array<double, ScanNetwork::kWeights>;

// What the authors of Adam propose.
constexpr double kMomentDecay = 0.9, kSquareDecay = 0.999, kAdamEpsilon = 1e-8;
constexpr double kSmallestProbability = 1e-12;  // keeps the logarithm of a sure error finite

enum Kind { visible_occupied, visible_free, occluded, kinds };

// Draws `count` items to the front.
template <class Item>
void draw(std::vector<Item>& items, std::size_t count, std::mt19937_64& random) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uniform_int_distribution<std::size_t> any(i, items.size() - 1);
    std::swap(items[i], items[any(random)]);
  }
}

bool is_visible(const OccupancyGrid2D& ideal, const Eigen::Vector2d& from_m,
                const Eigen::Vector2i& target) {
  const Eigen::Vector2d offset_m = center_of(ideal.geometry, target) - from_m;
  bool is_blocked = false;
  for_each_beam_cell(ideal.geometry, {from_m, std::atan2(offset_m.y(), offset_m.x())},
                     offset_m.norm(), [&](const BeamCell& cell) {
                       if (cell.cell != target)
                         is_blocked |= ideal.labels[cell.position] == CellLabel::occupied;
                     });
  return !is_blocked;
}

Kind kind_of(const OccupancyGrid2D& ideal, const Eigen::Vector2d& from_m,
             const Eigen::Vector2i& cell) {
  const CellLabel label = ideal.label_at(cell);
  if (label == CellLabel::unknown || !is_visible(ideal, from_m, cell)) return occluded;
  return label == CellLabel::occupied ? visible_occupied : visible_free;
}

double target_of(CellLabel label) {
  if (label == CellLabel::unknown) return 0.5;
  return label == CellLabel::occupied ? 1.0 : 0.0;
}

using SamplesByKind = std::array<std::vector<ScanSample>, kinds>;

SamplesByKind all_samples(const PseudoScan& scan, const OccupancyGrid2D& ideal,
                          double max_range_m) {
  SamplesByKind samples;
  const GridGeometry& grid = ideal.geometry;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const Eigen::Vector2i cell(x, y);
      const auto features = features_of(scan, center_of(grid, cell), grid.cell_size_m, max_range_m);
      if (features)
        samples[kind_of(ideal, scan.position_m, cell)].push_back(
            {*features, target_of(ideal.label_at(cell))});
    }
  return samples;
}

double cross_entropy(double p, double target) {
  return -target * std::log(std::max(p, kSmallestProbability)) -
         (1.0 - target) * std::log(std::max(1.0 - p, kSmallestProbability));
}

// Spread so that sums of a layer's inputs neither vanish nor saturate (Glorot & Bengio 2010).
ScanNetwork random_network(std::mt19937_64& random) {
  const auto spread = [](int inputs, int outputs) { return std::sqrt(6.0 / (inputs + outputs)); };
  const double hidden = spread(kScanFeatures, kHiddenUnits), output = spread(kHiddenUnits, 1);
  ScanNetwork network;
  constexpr std::size_t kHidden = kHiddenUnits * ScanNetwork::kHiddenRow;
  for (std::size_t i = 0; i < network.weights.size(); ++i) {
    const double limit = i < kHidden ? hidden : output;
    network.weights[i] = std::uniform_real_distribution<double>(-limit, limit)(random);
  }
  return network;
}

class Adam {
 public:
  explicit Adam(double learning_rate) : learning_rate_(learning_rate) {}

  void step(const Weights& gradient, Weights& weights) {
    moment_share_ *= kMomentDecay;
    square_share_ *= kSquareDecay;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      moments_[i] = kMomentDecay * moments_[i] + (1.0 - kMomentDecay) * gradient[i];
      squares_[i] = kSquareDecay * squares_[i] + (1.0 - kSquareDecay) * gradient[i] * gradient[i];
      weights[i] -= learning_rate_ * moments_[i] / (1.0 - moment_share_) /
                    (std::sqrt(squares_[i] / (1.0 - square_share_)) + kAdamEpsilon);
    }
  }

 private:
  double learning_rate_;
  double moment_share_ = 1.0, square_share_ = 1.0;
  Weights moments_{}, squares_{};
};

// One pass over the samples in the given order; returns the mean loss on the way.
double run_epoch(std::span<const ScanSample> samples, std::span<const std::size_t> order,
                 std::size_t batch_size, Adam& adam, ScanNetwork& network) {
  double loss = 0.0;
  for (std::size_t begin = 0; begin < order.size(); begin += batch_size) {
    const std::size_t count = std::min(batch_size, order.size() - begin);
    Weights mean{};
    for (const std::size_t index : order.subspan(begin, count)) {
      const ScanSample& sample = samples[index];
      const Weights gradient = loss_gradient(network, sample);
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += gradient[i] / double(count);
      loss += cross_entropy(occupancy(network, sample.features), sample.target);
    }
    adam.step(mean, network.weights);
  }
  return loss / double(order.size());
}

void validate(std::span<const ScanSample> samples, const TrainingParams& params) {
  if (samples.empty()) throw UsageError("training: there are no samples");
  if (params.epochs < 1 || params.batch_size < 1 || !(params.learning_rate > 0.0))
    throw UsageError(
        fmt::format("training: {} epochs, batches of {}, learning rate {}: all must "
                    "be above 0",
                    params.epochs, params.batch_size, params.learning_rate));
}

}  // namespace

std::vector<ScanSample> collect_samples(const PseudoScan& scan, const OccupancyGrid2D& ideal,
                                        const SampleParams& params) {
  SamplesByKind samples = all_samples(scan, ideal, params.max_range_m);
  std::size_t count = static_cast<std::size_t>(std::max(0, params.max_per_kind));
  for (const auto& kind : samples) count = std::min(count, kind.size());
  std::mt19937_64 random(params.seed);
  std::vector<ScanSample> drawn;
  for (auto& kind : samples) {
    draw(kind, count, random);
    drawn.insert(drawn.end(), kind.begin(), kind.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return drawn;
}

double mean_loss(const ScanNetwork& network, std::span<const ScanSample> samples) {
  double sum = 0.0;
  for (const ScanSample& sample : samples)
    sum += cross_entropy(occupancy(network, sample.features), sample.target);
  return samples.empty() ? 0.0 : sum / double(samples.size());
}

Weights loss_gradient(const ScanNetwork& network, const ScanSample& sample) {
  const HiddenValues hidden = hidden_values(network, sample.features);
  const double error = output_value(network, hidden) - sample.target;
  constexpr std::size_t kOutput = kHiddenUnits * ScanNetwork::kHiddenRow;
  Weights gradient{};
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    gradient[kOutput + i] = error * hidden[i];
    const double back = error * network.weights[kOutput + i] * (1.0 - hidden[i] * hidden[i]);
    double* const row = gradient.data() + i * ScanNetwork::kHiddenRow;
    for (std::size_t k = 0; k < sample.features.size(); ++k) row[k] = back * sample.features[k];
    row[kScanFeatures] = back;
  }
  gradient.back() = error;
  return gradient;
}

TrainedNetwork train(std::span<const ScanSample> samples, const TrainingParams& params) {
  validate(samples, params);
  std::mt19937_64 random(params.seed);
  TrainedNetwork trained{random_network(random), {}};
  Adam adam(params.learning_rate);
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (int epoch = 0; epoch < params.epochs; ++epoch) {
    draw(order, order.size(), random);
    trained.losses.push_back(run_epoch(samples, order, static_cast<std::size_t>(params.batch_size),
                                       adam, trained.network));
  }
  return trained;
}

}  // namespace stereovox
