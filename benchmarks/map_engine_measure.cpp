#include "map_engine_measure.h"

namespace stereovox::bench {
namespace {

bool is_occupied_near(const StateAt& state, const Eigen::Vector3i& voxel) {
  Eigen::Vector3i step;
  for (step.x() = -1; step.x() <= 1; ++step.x())
    for (step.y() = -1; step.y() <= 1; ++step.y())
      for (step.z() = -1; step.z() <= 1; ++step.z())
        if (state(voxel + step) == State::occupied) return true;
  return false;
}

struct Share {
  std::int64_t of = 0, all = 0;
  void add(bool counts) {
    of += counts ? 1 : 0;
    ++all;
  }
  double value() const { return all == 0 ? 0.0 : double(of) / double(all); }
};

}  // namespace

Accuracy accuracy_of(const Truth& truth, const StateAt& state) {
  Share free, occupied, near, thin, precise;
  Eigen::Vector3i place;
  for (place.z() = 0; place.z() < truth.size.z(); ++place.z())
    for (place.y() = 0; place.y() < truth.size.y(); ++place.y())
      for (place.x() = 0; place.x() < truth.size.x(); ++place.x()) {
        const Eigen::Vector3i voxel = truth.low + place;
        const std::uint8_t what = truth.at(voxel);
        const State found = state(voxel);
        if (what & Truth::kHit) {
          occupied.add(found == State::occupied);
          near.add(is_occupied_near(state, voxel));
          if (what & Truth::kThin) thin.add(found == State::occupied);
        } else if ((what & Truth::kCrossed) && !(what & Truth::kSolid)) {
          free.add(found == State::free);
        }
        if (found == State::occupied) precise.add((what & Truth::kNearSolid) != 0);
      }
  return {free.value(), occupied.value(), near.value(), thin.value(), precise.value()};
}

void keep(std::int64_t count) {
  [[maybe_unused]] static volatile std::int64_t kept = 0;
  kept = count;
}

// A linear congruential generator is enough to scatter queries.
std::vector<Eigen::Vector3d> random_places(int count) {
  std::uint64_t state = 12345;
  const auto next = [&] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < count; ++i) places.emplace_back(16.0 * next(), 12.0 * next(), 2.8 * next());
  return places;
}

}  // namespace stereovox::bench
