#include "stereovox/baselines/scan_network.h"

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "stereovox/core/angles.h"
#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

PseudoScan scan_of_beams() {
  PseudoScan scan{0, {1.0, 2.0}, 0.5 * std::numbers::pi, {}};
  for (int i = -4; i <= 4; ++i)
    scan.beams.push_back({.bearing_rad = 2.0 * i * kDegree_rad,
                          .range_m = 2.0 + 0.1 * i,
                          .sigma_m = 0.05,
                          .has_range = i != 1,
                          .free_range_m = 2.5});
  return scan;
}

Eigen::Vector2d place_at(const PseudoScan& scan, double distance_m, double bearing_deg) {
  const double direction_rad = scan.heading_rad + bearing_deg * kDegree_rad;
  return scan.position_m +
         distance_m * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
}

TEST(ScanFeatures, AreThePlaceAndTheFourNearestBeams) {
  const PseudoScan scan = scan_of_beams();
  const auto features = features_of(scan, place_at(scan, 3.0, 0.5), 0.25, 5.0);
  ASSERT_TRUE(features);
  const ScanFeatures expected = {0.6,
                                 std::sin(0.5 * kDegree_rad),
                                 std::cos(0.5 * kDegree_rad),
                                 0.4,
                                 1.0,  // 0 degrees
                                 0.0,
                                 0.0,  // 2 degrees: no reading
                                 0.38,
                                 1.0,  // -2 degrees
                                 0.44,
                                 1.0,  // 4 degrees
                                 0.2,
                                 0.5};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR((*features)[i], expected[i], 1e-9) << i;
}

TEST(ScanFeatures, BeamsBeyondFourDegreesDoNotCount) {
  const PseudoScan scan = scan_of_beams();
  const auto features = features_of(scan, place_at(scan, 3.0, 8.5), 0.25, 5.0);
  ASSERT_TRUE(features);
  EXPECT_EQ((*features)[4], 1.0);  // 8 degrees
  EXPECT_EQ((*features)[6], 1.0);  // 6 degrees
  EXPECT_EQ((*features)[8], 0.0);  // 4 degrees is 4.5 degrees off
  EXPECT_EQ((*features)[10], 0.0);
}

TEST(ScanFeatures, ExistOnlyInsideTheViewCone) {
  const PseudoScan scan = scan_of_beams();
  EXPECT_TRUE(features_of(scan, place_at(scan, 4.9, -8.9), 0.25, 5.0));
  EXPECT_FALSE(features_of(scan, place_at(scan, 4.9, -9.1), 0.25, 5.0));
  EXPECT_FALSE(features_of(scan, place_at(scan, 5.1, 0.0), 0.25, 5.0));
  EXPECT_FALSE(features_of(scan, place_at(scan, 1.0, 180.0), 0.25, 5.0));
  EXPECT_FALSE(features_of(scan, scan.position_m, 0.25, 5.0));
}

TEST(ScanNetwork, ForwardPassIsTanhThenSigmoid) {
  ScanNetwork network;
  network.weights[0] = 2.0;  // first unit: 2 x0 - 1
  network.weights[kScanFeatures] = -1.0;
  network.weights[kHiddenUnits * ScanNetwork::kHiddenRow] = 3.0;  // output: 3 h0 + .5
  network.weights.back() = 0.5;
  const double expected = 1.0 / (1.0 + std::exp(-(3.0 * std::tanh(2.0 * 0.8 - 1.0) + 0.5)));
  EXPECT_DOUBLE_EQ(occupancy(network, {0.8}), expected);
}

ScanNetwork numbered_network() {
  ScanNetwork network;
  for (std::size_t i = 0; i < network.weights.size(); ++i)
    network.weights[i] = (static_cast<double>(i) - 100.0) / 7.0;
  return network;
}

TEST(ScanNetworkFile, IsReadBackBitByBit) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "network.txt";
  write_scan_network(path, numbered_network(), "two\nlines");
  EXPECT_EQ(read_scan_network(path), numbered_network());
}

TEST(ScanNetworkFile, CompiledInNetworkIsTheShippedFile) {
  EXPECT_EQ(default_scan_network(),
            read_scan_network(STEREOVOX_SOURCE_DIR "/data/networks/thrun_1993.txt"));
}

std::string error_of(const std::function<std::string(std::string)>& damage) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "network.txt";
  write_scan_network(path, numbered_network(), "");
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::ofstream(path) << damage(text);
  try {
    read_scan_network(path);
  } catch (const Error& error) {
    return std::string(error.what()).substr(path.string().size());
  }
  return "none";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(ScanNetworkFile, DamagedFilesAreRefusedWithTheirLine) {
  EXPECT_EQ(error_of([](auto text) { return replaced(text, "scan_network 1", "scan_network 2"); }),
            ":1: expected 'scan_network 1'");
  EXPECT_EQ(error_of([](auto text) { return replaced(text, "13 16 1", "13 17 1"); }),
            ":2: expected 'layers 13 16 1'");
  EXPECT_EQ(error_of([](auto text) { return replaced(text, "-14.142857142857142", "1e7"); }),
            ":3: weight 10000000 is beyond 1000000");
  EXPECT_EQ(error_of([](auto text) { return text + "1 2 3\n"; }),
            ":20: there is more than the network needs");
  EXPECT_EQ(
      error_of([](auto text) { return text.substr(0, text.rfind('\n', text.size() - 2) + 1); }),
      ": holds 224 weights, the network has 241");
  EXPECT_NE(error_of([](auto text) { return replaced(text, "-14.142857142857142", ""); }), "none");
  EXPECT_NE(error_of([](auto text) { return replaced(text, "-14.142857142857142", "nan"); }),
            "none");
}

}  // namespace
}  // namespace stereovox
