// Trains the network of Thrun's paradigm (baselines/scan_network.h) on simulated random rooms, none
// of which is a world that maps are judged on, and prints its training log:
//
//   train_scan_network data/networks/thrun_1993.txt [ROOMS]
#include <fmt/format.h>

#include <iostream>
#include <thread>

#include "stereovox/baselines/scan_network_training.h"
#include "stereovox/core/error.h"
#include "stereovox/experiment/ideal_maps.h"
#include "stereovox/io/text_file.h"
#include "stereovox/simulation/random_room.h"
#include "stereovox/simulation/simulated_sequence.h"
#include "stereovox/stereo/matcher.h"

namespace stereovox {
namespace {

constexpr int kRooms = 40, kSeed = 1993;
constexpr double kCellSizes_m[] = {0.25, 0.1};

// Samples of one room, from the images of a drive through it.
std::vector<ScanSample> samples_of_room(std::uint32_t seed, int threads) {
  const Simulation simulation(random_room(seed), "main", {}, "random room", threads);
  const RectifiedCamera camera{simulation.rig().left.pinhole, simulation.rig().baseline_m()};
  std::vector<ScanSample> samples;
  for (int i = 0; i < static_cast<int>(simulation.trajectory().size()); ++i) {
    const StereoFrame frame = simulation.frame(i);
    const SE3& T_world_camera = simulation.trajectory()[static_cast<std::size_t>(i)].T_world_camera;
    // What the network in the library was learned from.
    const DisparityImage disparity =
        match({frame.stamp_ns, frame.left, frame.right, {}, {}}, SemiGlobalMatchingParams{});
    const PseudoScan scan =
        pseudo_scan(disparity, camera, T_world_camera, 0.0, frame.stamp_ns, PseudoScanParams{});
    for (const double cell_size_m : kCellSizes_m) {
      const IdealMap ideal =
          ideal_map(simulation.world(), cell_size_m, HeightBand{},
                    simulation.trajectory()[0].T_world_camera.translation.head<2>());
      SampleParams params;
      params.seed = hash_of(i, static_cast<int>(100 * cell_size_m), 0, seed);
      const std::vector<ScanSample> more = collect_samples(scan, ideal.theoretical, params);
      samples.insert(samples.end(), more.begin(), more.end());
    }
  }
  return samples;
}

int run(const std::string& output, int rooms) {
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<ScanSample> samples;
  for (int room = 0; room < rooms; ++room) {
    const auto more = samples_of_room(kSeed + static_cast<std::uint32_t>(room), threads);
    samples.insert(samples.end(), more.begin(), more.end());
    std::cout << fmt::format("room {} of {}: {} samples\n", room + 1, rooms, samples.size())
              << std::flush;
  }
  TrainingParams params;
  params.seed = kSeed;
  const TrainedNetwork trained = train(samples, params);
  std::string log = fmt::format("{} samples of {} random rooms, seed {}, cells of 0.25 and 0.1 m",
                                samples.size(), rooms, kSeed);
  for (std::size_t epoch = 0; epoch < trained.losses.size(); ++epoch)
    log += fmt::format("\nepoch {}: mean loss {:.4f}", epoch + 1, trained.losses[epoch]);
  std::cout << log << "\n";
  write_scan_network(output, trained.network, log);
  return 0;
}

}  // namespace
}  // namespace stereovox

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw stereovox::UsageError("train_scan_network OUTPUT [ROOMS]");
    const auto rooms = argc > 2 ? stereovox::parse_integer(argv[2]) : stereovox::kRooms;
    if (!rooms || *rooms < 1 || *rooms > 10000)
      throw stereovox::UsageError("ROOMS is a number from 1 to 10000");
    return stereovox::run(argv[1], static_cast<int>(*rooms));
  } catch (const std::exception& error) {
    std::cerr << "train_scan_network: error: " << error.what() << "\n";
    return 2;
  }
}
