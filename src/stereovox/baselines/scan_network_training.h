// How the weights of the sensor network are learnt: from scans of rooms whose ideal map is known
// (method.md C.3). Everything is determined by its arguments.
//
//   for (room : rooms) for (scan : scans) append(samples, collect_samples(scan, ideal, {.seed =
//   n++})); const TrainedNetwork trained = train(samples, {.seed = 1});
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stereovox/baselines/scan_network.h"
#include "stereovox/core/parameters.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

struct ScanSample {
  ScanFeatures features;
  double target = 0;  // ideal occupancy: 1 occupied, 0 free, .5 unknown
};

struct SampleParams {
  double max_range_m = 5.0;  // as in the paradigm's parameters
  int max_per_kind = 100;
  std::uint64_t seed = 1;
};

// Samples of one scan: equally many visible occupied cells, visible free ones and occluded ones, as
// many as there are of the rarest kind but at most `max_per_kind`, drawn at random. A cell is
// visible when no cell on the line to it from the camera is occupied in the ideal map. Cells
// outside the ideal map are not sampled. The kinds follow each other.
std::vector<ScanSample> collect_samples(const PseudoScan& scan, const OccupancyGrid2D& ideal,
                                        const SampleParams& params);

struct TrainingParams {
  std::uint64_t seed = 1;
  int epochs = 20;
  double learning_rate = 1e-3;
  int batch_size = 32;
};

struct TrainedNetwork {
  ScanNetwork network;
  std::vector<double> losses;  // mean cross-entropy of each epoch, in nats
};

// Mean cross-entropy of the network on the samples, in nats; 0 without samples.
double mean_loss(const ScanNetwork& network, std::span<const ScanSample> samples);

// Derivative of one sample's cross-entropy by each weight.
std::array<double, ScanNetwork::kWeights> loss_gradient(const ScanNetwork& network,
                                                        const ScanSample& sample);

// Adam (Kingma & Ba 2015) on cross-entropy from random weights; the samples are shuffled in each
// epoch. Throws UsageError without samples or with parameters that are not positive.
TrainedNetwork train(std::span<const ScanSample> samples, const TrainingParams& params);

}  // namespace stereovox
