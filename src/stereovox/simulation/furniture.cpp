#include "stereovox/simulation/furniture.h"

#include <random>

namespace stereovox {
namespace {

constexpr double kBoard_m = 0.025;

// A box given by its place in the thing's own frame.
Prism part(const Placement& thing, const Eigen::Vector2d& at_m, const Eigen::Vector3d& size_m,
           double bottom_m, int material) {
  return box_prism({thing * at_m, thing.yaw_rad}, size_m, bottom_m, material);
}

void add_legs(const Placement& at, double length_m, double width_m, double height_m, double leg_m,
              int material, std::vector<Prism>& solids) {
  const double x = (length_m - leg_m) / 2, y = (width_m - leg_m) / 2;
  for (const double sx : {-1.0, 1.0})
    for (const double sy : {-1.0, 1.0})
      solids.push_back(part(at, {sx * x, sy * y}, {leg_m, leg_m, height_m}, 0.0, material));
}

// Uniform in [low, high), the same on every machine (std::uniform_real_distribution is not).
double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (random() / 4294967296.0);
}

struct Shelf {
  double length_m, depth_m, height_m;  // space for things
  double bottom_m;
};

// Things side by side, with gaps, until the shelf is full.
void fill(const Placement& at, const Shelf& shelf, double filled, Eigen::Vector2d widths_m,
          std::mt19937& random, int content, std::vector<Prism>& solids) {
  for (double x = -shelf.length_m / 2; x < shelf.length_m / 2;) {
    const double width = uniform(random, widths_m.x(), widths_m.y());
    const double height = shelf.height_m * uniform(random, 0.5, 0.95);
    const double depth = shelf.depth_m * uniform(random, 0.6, 0.95);
    const bool is_there = uniform(random, 0, 1) < filled;
    if (is_there && x + width <= shelf.length_m / 2)
      solids.push_back(
          part(at, {x + width / 2, 0}, {width, depth, height}, shelf.bottom_m, content));
    x += width;
  }
}

}  // namespace

std::vector<Prism> table(const Placement& at, const Eigen::Vector3d& size_m, double leg_m,
                         int material) {
  constexpr double kPlate_m = 0.03;
  const double legs = size_m.z() - kPlate_m;
  std::vector<Prism> solids = {
      part(at, {0, 0}, {size_m.x(), size_m.y(), kPlate_m}, legs, material)};
  add_legs(at, size_m.x(), size_m.y(), legs, leg_m, material, solids);
  return solids;
}

std::vector<Prism> chair(const Placement& at, int material) {
  constexpr double kWidth_m = 0.44, kSeat_m = 0.45, kSeatThickness_m = 0.04;
  constexpr double kBack_m = 0.42, kBackThickness_m = 0.03, kLeg_m = 0.035;
  std::vector<Prism> solids = {part(at, {0, 0}, {kWidth_m, kWidth_m, kSeatThickness_m},
                                    kSeat_m - kSeatThickness_m, material),
                               part(at, {-(kWidth_m - kBackThickness_m) / 2, 0},
                                    {kBackThickness_m, kWidth_m, kBack_m}, kSeat_m, material)};
  add_legs(at, kWidth_m, kWidth_m, kSeat_m - kSeatThickness_m, kLeg_m, material, solids);
  return solids;
}

std::vector<Prism> bookcase(const Placement& at, const Eigen::Vector3d& size_m, int boards,
                            double filled, std::uint32_t seed, int material, int content) {
  std::mt19937 random(seed);
  const double length = size_m.x(), depth = size_m.y(), height = size_m.z();
  std::vector<Prism> solids = {
      part(at, {0, -(depth - kBoard_m) / 2}, {length, kBoard_m, height}, 0, material),
      part(at, {-(length - kBoard_m) / 2, 0}, {kBoard_m, depth, height}, 0, material),
      part(at, {(length - kBoard_m) / 2, 0}, {kBoard_m, depth, height}, 0, material),
      part(at, {0, 0}, {length, depth, kBoard_m}, height - kBoard_m, material)};
  const double step = (height - kBoard_m) / boards;
  for (int i = 0; i < boards; ++i) {
    solids.push_back(part(at, {0, 0}, {length, depth, kBoard_m}, i * step, material));
    fill(at, {length - 2 * kBoard_m, depth, step - kBoard_m, i * step + kBoard_m}, filled,
         {0.03, 0.12}, random, content, solids);
  }
  return solids;
}

std::vector<Prism> rack(const Placement& at, const Eigen::Vector3d& size_m, int levels, int bays,
                        double filled, std::uint32_t seed, int material, int content) {
  constexpr double kPost_m = 0.06, kBeam_m = 0.08, kLowest_m = 0.12;
  std::mt19937 random(seed);
  const double length = size_m.x(), depth = size_m.y(), height = size_m.z();
  std::vector<Prism> solids;
  for (int i = 0; i <= bays; ++i)
    for (const double side : {-1.0, 1.0})
      solids.push_back(part(at, {-length / 2 + i * length / bays, side * (depth - kPost_m) / 2},
                            {kPost_m, kPost_m, height}, 0, material));
  const double step = (height - kLowest_m) / levels;
  for (int i = 0; i < levels; ++i) {
    const double bottom = kLowest_m + i * step;
    solids.push_back(part(at, {0, 0}, {length, depth, kBeam_m}, bottom, material));
    fill(at, {length - 2 * kPost_m, depth, step - kBeam_m, bottom + kBeam_m}, filled, {0.35, 0.9},
         random, content, solids);
  }
  return solids;
}

std::vector<Prism> monitor(const Placement& at, double bottom_m, int material, int screen) {
  constexpr double kFoot_m = 0.12, kThickness_m = 0.04;
  return {part(at, {-kThickness_m, 0}, {0.15, 0.2, 0.02}, bottom_m, material),
          part(at, {-kThickness_m, 0}, {0.04, 0.06, kFoot_m}, bottom_m, material),
          part(at, {0, 0}, {kThickness_m, 0.55, 0.33}, bottom_m + kFoot_m, screen)};
}

}  // namespace stereovox
