#include "stereovox/baselines/scan_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "stereovox/baselines/scan_network_weights.h"
#include "stereovox/core/angles.h"
#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/text_file.h"

namespace stereovox {
namespace {

constexpr std::size_t kPlaceFeatures = 3;  // distance, sine and cosine of the bearing
constexpr std::size_t kNearestBeams = 4;
constexpr double kNearest_rad = 4.0 * kDegree_rad;

constexpr std::size_t kRows = kHiddenUnits + 1;
constexpr double kMaxWeight = 1e6;  // trained ones are of order ten; tanh is flat long before

std::size_t row_length(std::size_t row) {
  return row < kHiddenUnits ? ScanNetwork::kHiddenRow : ScanNetwork::kOutputRow;
}

double weighted_sum(std::span<const double> row, std::span<const double> inputs) {
  double sum = row.back();  // the bias
  for (std::size_t i = 0; i < inputs.size(); ++i) sum += row[i] * inputs[i];
  return sum;
}

// Angle between neighbours of the fan.
double beam_spacing_rad(std::span<const Beam> beams) {
  if (beams.size() < 2) return kNearest_rad;
  return (beams.back().bearing_rad - beams.front().bearing_rad) / double(beams.size() - 1);
}

bool is_in_fan(std::span<const Beam> beams, double bearing_rad, double spacing_rad) {
  return bearing_rad >= beams.front().bearing_rad - 0.5 * spacing_rad &&
         bearing_rad <= beams.back().bearing_rad + 0.5 * spacing_rad;
}

// Index of the beam whose bearing is nearest; beams are equally spaced.
std::ptrdiff_t nearest_beam(std::span<const Beam> beams, double bearing_rad, double spacing_rad) {
  const double steps = (bearing_rad - beams.front().bearing_rad) / spacing_rad;
  return std::clamp(static_cast<std::ptrdiff_t>(std::lround(steps)), std::ptrdiff_t{0},
                    static_cast<std::ptrdiff_t>(beams.size()) - 1);
}

// The beams nearest to a bearing, nearest first; null where there is none within 4 degrees.
std::array<const Beam*, kNearestBeams> nearest_beams(std::span<const Beam> beams,
                                                     double bearing_rad, double spacing_rad) {
  std::ptrdiff_t below = nearest_beam(beams, bearing_rad, spacing_rad), above = below + 1;
  const auto distance_rad = [&](std::ptrdiff_t i) {
    if (i < 0 || i >= static_cast<std::ptrdiff_t>(beams.size())) return HUGE_VAL;
    return std::abs(beams[static_cast<std::size_t>(i)].bearing_rad - bearing_rad);
  };
  std::array<const Beam*, kNearestBeams> nearest{};
  for (const Beam*& beam : nearest) {
    const std::ptrdiff_t next = distance_rad(below) <= distance_rad(above) ? below-- : above++;
    if (distance_rad(next) > kNearest_rad) break;
    beam = &beams[static_cast<std::size_t>(next)];
  }
  return nearest;
}

void expect_words(const TextRecord& record, std::initializer_list<std::string_view> words) {
  if (!std::ranges::equal(record.fields, words))
    throw Error(fmt::format("{}: expected '{}'", record.place(), fmt::join(words, " ")));
}

void read_row(const TextRecord& record, double* weights) {
  for (std::size_t i = 0; i < record.fields.size(); ++i) {
    weights[i] = record.number(i);
    if (std::abs(weights[i]) > kMaxWeight)
      throw Error(
          fmt::format("{}: weight {} is beyond {}", record.place(), weights[i], kMaxWeight));
  }
}

}  // namespace

std::optional<ScanFeatures> features_of(const PseudoScan& scan, const Eigen::Vector2d& place_m,
                                        double cell_size_m, double max_range_m) {
  const Eigen::Vector2d offset_m = place_m - scan.position_m;
  const double distance_m = offset_m.norm();
  if (distance_m == 0.0 || distance_m > max_range_m || scan.beams.empty()) return std::nullopt;
  const double bearing_rad =
      std::remainder(std::atan2(offset_m.y(), offset_m.x()) - scan.heading_rad, 2.0 * M_PI);
  const double spacing_rad = beam_spacing_rad(scan.beams);
  if (!is_in_fan(scan.beams, bearing_rad, spacing_rad)) return std::nullopt;

  ScanFeatures features{distance_m / max_range_m, std::sin(bearing_rad), std::cos(bearing_rad)};
  const auto nearest = nearest_beams(scan.beams, bearing_rad, spacing_rad);
  std::size_t next = kPlaceFeatures;
  for (const Beam* const beam : nearest) {
    const bool has_range = beam != nullptr && beam->has_range;
    features[next++] = has_range ? beam->range_m / max_range_m : 0.0;
    features[next++] = has_range ? 1.0 : 0.0;
  }
  if (nearest[0] == nullptr) return features;
  features[next++] = nearest[0]->has_range ? nearest[0]->sigma_m / cell_size_m : 0.0;
  features[next] = nearest[0]->free_range_m / max_range_m;
  return features;
}

HiddenValues hidden_values(const ScanNetwork& network, const ScanFeatures& features) {
  HiddenValues hidden;
  for (std::size_t i = 0; i < hidden.size(); ++i)
    hidden[i] = std::tanh(weighted_sum(
        std::span(network.weights).subspan(i * ScanNetwork::kHiddenRow, ScanNetwork::kHiddenRow),
        features));
  return hidden;
}

double output_value(const ScanNetwork& network, const HiddenValues& hidden) {
  const double sum =
      weighted_sum(std::span(network.weights).last<ScanNetwork::kOutputRow>(), hidden);
  return 1.0 / (1.0 + std::exp(-sum));
}

const ScanNetwork& default_scan_network() {
  static_assert(std::size(kDefaultScanNetworkWeights) == ScanNetwork::kWeights);
  static const ScanNetwork network = [] {
    ScanNetwork made;
    std::ranges::copy(kDefaultScanNetworkWeights, made.weights.begin());
    return made;
  }();
  return network;
}

ScanNetwork read_scan_network(const std::filesystem::path& path) {
  ScanNetwork network;
  std::size_t records = 0, read = 0;
  for_each_record(path, [&](const TextRecord& record) {
    const std::size_t index = records++;
    if (index == 0) return expect_words(record, {"scan_network", "1"});
    if (index == 1) return expect_words(record, {"layers", "13", "16", "1"});
    const std::size_t row = index - 2;
    if (row >= kRows) throw Error(record.place() + ": there is more than the network needs");
    record.expect_fields(row_length(row));
    read_row(record, network.weights.data() + read);
    read += row_length(row);
  });
  if (read != network.weights.size())
    throw Error(fmt::format("{}: holds {} weights, the network has {}", path.string(), read,
                            network.weights.size()));
  return network;
}

void write_scan_network(const std::filesystem::path& path, const ScanNetwork& network,
                        const std::string& comment) {
  write_file_atomically(path, [&](std::ostream& out) {
    std::istringstream lines(comment);
    for (std::string line; std::getline(lines, line);) out << "# " << line << "\n";
    out << "scan_network 1\nlayers 13 16 1\n";
    const double* weight = network.weights.data();
    for (std::size_t row = 0; row < kRows; ++row, out << "\n")
      for (std::size_t i = 0; i < row_length(row); ++i)
        out << (i == 0 ? "" : " ") << fmt::format("{}", *weight++);
  });
}

}  // namespace stereovox
