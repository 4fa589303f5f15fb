#include "stereovox/baselines/scan_network_training.h"

#include <gtest/gtest.h>

#include "stereovox/baselines/random_rooms_for_test.h"
#include "stereovox/core/error.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

constexpr double kTrainingCell_m = 0.25;

// A camera at the left end of a corridor that looks to the right, at a wall.
const Drawing kCorridor = {
    "##########",  //
    "#.....#..#",  //
    "#.....#..#",  //
    "#.....#..#",  //
    "##########",
};

PseudoScan corridor_scan() {
  RandomEngine random(1);
  return scan_in(drawn_grid(kCorridor, kTrainingCell_m), {0.4, 0.6}, 0.0, random);
}

TEST(CollectSamples, TakesEquallyManyOfEachKind) {
  const auto samples =
      collect_samples(corridor_scan(), drawn_grid(kCorridor, kTrainingCell_m), {.max_per_kind = 2});
  ASSERT_EQ(samples.size(), 6U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(samples[i].target, 1.0);
    EXPECT_EQ(samples[2 + i].target, 0.0);
    EXPECT_GT(samples[4 + i].features[0], samples[4 + i].features[3]);  // behind the reading
  }
}

TEST(CollectSamples, SameSeedDrawsTheSameSamples) {
  const auto distances = [](std::uint64_t seed) {
    std::vector<double> list;
    for (const ScanSample& sample :
         collect_samples(corridor_scan(), drawn_grid(kCorridor, kTrainingCell_m),
                         {.max_per_kind = 2, .seed = seed}))
      list.push_back(sample.features[0]);
    return list;
  };
  EXPECT_EQ(distances(1), distances(1));
  EXPECT_NE(distances(1), distances(2));
}

TEST(CollectSamples, GivesNothingWhenAKindIsMissing) {
  const OccupancyGrid2D open = drawn_grid(Drawing(8, std::string(8, '.')), kTrainingCell_m);
  EXPECT_TRUE(collect_samples(corridor_scan(), open, {}).empty());
}

// Exclusive or of the first two features: no single unit can learn it.
std::vector<ScanSample> exclusive_or() {
  std::vector<ScanSample> samples;
  for (const double a : {0.0, 1.0})
    for (const double b : {0.0, 1.0}) samples.push_back({{a, b}, a == b ? 0.0 : 1.0});
  return samples;
}

TEST(Training, LearnsTheExclusiveOr) {
  const auto samples = exclusive_or();
  const TrainedNetwork trained =
      train(samples, {.seed = 3, .epochs = 500, .learning_rate = 0.03, .batch_size = 4});
  EXPECT_LT(trained.losses.back(), 0.05);
  EXPECT_LT(mean_loss(trained.network, samples), 0.05);
  for (const ScanSample& sample : samples)
    EXPECT_NEAR(occupancy(trained.network, sample.features), sample.target, 0.1);
}

TEST(Training, SameSeedGivesTheSameWeights) {
  const auto samples = exclusive_or();
  EXPECT_EQ(train(samples, {.seed = 3}).network, train(samples, {.seed = 3}).network);
  EXPECT_FALSE(train(samples, {.seed = 3}).network == train(samples, {.seed = 4}).network);
}

TEST(Training, GradientIsThatOfTheLoss) {
  ScanNetwork network = train(exclusive_or(), {.epochs = 2}).network;
  const ScanSample sample{{0.3, -0.5, 0.9, 0.4}, 0.7};
  const auto gradient = loss_gradient(network, sample);
  constexpr double kStep = 1e-6;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    ScanNetwork more = network, less = network;
    more.weights[i] += kStep;
    less.weights[i] -= kStep;
    const double slope =
        (mean_loss(more, std::span(&sample, 1)) - mean_loss(less, std::span(&sample, 1))) /
        (2 * kStep);
    EXPECT_NEAR(gradient[i], slope, 1e-8) << i;
  }
}

TEST(Training, LossOnRoomsNotSeenFalls) {
  const auto samples_of = [](std::uint64_t seed, int rooms) {
    RandomEngine random(seed);
    std::vector<ScanSample> samples;
    for (int i = 0; i < rooms; ++i) {
      const OccupancyGrid2D room = random_room(random, kTrainingCell_m);
      for (const PseudoScan& scan : random_scans(room, 5, random)) {
        const auto drawn = collect_samples(scan, room, {});
        samples.insert(samples.end(), drawn.begin(), drawn.end());
      }
    }
    return samples;
  };
  const auto seen = samples_of(1, 60), unseen = samples_of(2, 20);
  const TrainedNetwork trained = train(seen, {.epochs = 20, .learning_rate = 5e-3});
  EXPECT_LT(trained.losses.back(), 0.7 * trained.losses.front());
  EXPECT_LT(mean_loss(trained.network, unseen), 0.5);  // always one half: 0.69
}

TEST(Training, NeedsSamplesAndSensibleParameters) {
  EXPECT_THROW(train({}, {}), UsageError);
  EXPECT_THROW(train(exclusive_or(), {.epochs = 0}), UsageError);
  EXPECT_THROW(train(exclusive_or(), {.learning_rate = -1.0}), UsageError);
}

}  // namespace
}  // namespace stereovox
