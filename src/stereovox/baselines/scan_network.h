// The sensor network of Thrun 1993: how occupied is a place, given what the nearest beams read
// (method.md C.3). Layers 13 - 16 (tanh) - 1 (sigmoid).
//
//   const ScanNetwork& network = default_scan_network();
//   const double p = occupancy(network, features_of(scan, place, cell_size_m, max_range_m));
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "stereovox/baselines/pseudo_scan.h"

namespace stereovox {

inline constexpr int kScanFeatures = 13, kHiddenUnits = 16;

// Row by row: for each hidden unit its 13 weights and its bias, then the output's 16 weights and
// its bias.
struct ScanNetwork {
  static constexpr std::size_t kHiddenRow = kScanFeatures + 1, kOutputRow = kHiddenUnits + 1;
  static constexpr std::size_t kWeights = kHiddenUnits * kHiddenRow + kOutputRow;

  std::array<double, kWeights> weights{};

  bool operator==(const ScanNetwork&) const = default;
};

// Distance / max range, sine and cosine of the bearing from the heading; of the four beams nearest
// in bearing, if within 4 degrees, reading / max range and whether there is one; of the nearest
// its sigma / cell size and its free range / max range.
using ScanFeatures = std::array<double, kScanFeatures>;

// Nothing when the place is the camera's own, farther than `max_range_m` or outside the scan's fan.
std::optional<ScanFeatures> features_of(const PseudoScan& scan, const Eigen::Vector2d& place_m,
                                        double cell_size_m, double max_range_m);

using HiddenValues = std::array<double, kHiddenUnits>;
HiddenValues hidden_values(const ScanNetwork& network, const ScanFeatures& features);
double output_value(const ScanNetwork& network, const HiddenValues& hidden);

// Occupancy in (0, 1).
inline double occupancy(const ScanNetwork& network, const ScanFeatures& features) {
  return output_value(network, hidden_values(network, features));
}

// The network of data/networks/thrun_1993.txt, compiled in.
const ScanNetwork& default_scan_network();

// Text: "scan_network 1", "layers 13 16 1", then the rows above, one a line; `#` begins a comment.
// Reading throws Error "<path>:<line>: ..." for all that does not fit; what was written is read
// back bit by bit.
ScanNetwork read_scan_network(const std::filesystem::path& path);
void write_scan_network(const std::filesystem::path& path, const ScanNetwork& network,
                        const std::string& comment);

}  // namespace stereovox
