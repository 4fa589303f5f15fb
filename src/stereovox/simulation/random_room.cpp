#include "stereovox/simulation/random_room.h"

#include <fmt/format.h>

#include <random>

#include "stereovox/core/error.h"
#include "stereovox/simulation/drive.h"
#include "stereovox/simulation/world_file.h"

namespace stereovox {
namespace {

// std's distributions differ between libraries.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : random_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * (random_() / 4294967296.0);
  }
  template <std::size_t N>
  const char* one_of(const char* const (&choices)[N]) {
    return choices[static_cast<std::size_t>(between(0, N))];
  }

 private:
  std::mt19937 random_;
};

std::string thing_text(Dice& dice, const Eigen::Vector2d& room_m) {
  constexpr const char* kMaterials[] = {"wood",  "veneer",    "metal", "plastic",
                                        "paint", "cardboard", "brick", "fabric"};
  constexpr const char* kShapes[] = {
      "kind: box, size_m: [{0:.2f}, {1:.2f}, {2:.2f}], material: {3}",
      "kind: box, size_m: [{0:.2f}, {1:.2f}, 1.9], material: {3}",
      "kind: table, size_m: [{0:.2f}, {1:.2f}, 0.74], material: {3}",
      "kind: bookcase, size_m: [{0:.2f}, 0.36, 1.9], filled: {1:.2f}",
      "kind: cylinder, radius_m: 0.15, height_m: {2:.2f}, material: {3}",
      "kind: chair",
  };
  const std::string shape =
      fmt::format(fmt::runtime(dice.one_of(kShapes)), dice.between(0.4, 1.6),
                  dice.between(0.3, 0.9), dice.between(0.3, 1.8), dice.one_of(kMaterials));
  return fmt::format("  - {{at: [{:.2f}, {:.2f}], yaw_deg: {:.0f}, {}}}\n",
                     dice.between(0.4, room_m.x() - 0.4), dice.between(0.4, room_m.y() - 0.4),
                     dice.between(0, 360), shape);
}

bool can_be_driven(const World& world) {
  constexpr double kRate_hz = 4.0;
  const std::vector<PlanarPose> poses =
      sample(motions_of(world.drives.at("main"), DriveStyle{}, 0), kRate_hz);
  try {
    check_clearance(world, poses, Clearance{.radius_m = 0.3}, "main", world.name);
  } catch (const Error&) {
    return false;
  }
  return true;
}

}  // namespace

std::string random_room_text(std::uint32_t seed, int things) {
  constexpr const char* kWalls[] = {"plaster", "plaster", "brick", "paint", "wood"};
  constexpr const char* kFloors[] = {"carpet", "parquet", "tiles", "linoleum", "concrete"};
  constexpr int kWaypoints = 4;
  Dice dice(seed);
  const Eigen::Vector2d size_m(dice.between(4, 9), dice.between(4, 8));
  std::string text = fmt::format(
      "name: random room {}\nroom: {{size_m: [{:.2f}, {:.2f}], height_m: 2.6, floor: {}, wall: "
      "{}}}\n"
      "lights: {{ambient: 0.4, power: 1.6, spacing_m: [2.5, 2.5]}}\nthings:\n",
      seed, size_m.x(), size_m.y(), dice.one_of(kFloors), dice.one_of(kWalls));
  for (int i = 0; i < things; ++i) text += thing_text(dice, size_m);
  text += "drives:\n  main:\n    speed_m_s: 0.4\n    rate_hz: 1\n    waypoints:\n";
  for (int i = 0; i < kWaypoints; ++i)
    text += fmt::format("      - {{at: [{:.2f}, {:.2f}], turn_deg: {:.0f}}}\n",
                        dice.between(0.5, size_m.x() - 0.5), dice.between(0.5, size_m.y() - 0.5),
                        dice.between(-180, 180));
  return text;
}

// Rooms whose drive is blocked are thrown away; in the end an emptier one passes.
World random_room(std::uint32_t seed) {
  constexpr int kMostThings = 9, kTriesPerThing = 20;
  for (int tries = 0;; ++tries) {
    const int things = kMostThings - tries / kTriesPerThing;
    if (things < 0) throw Error(fmt::format("random room {}: no drive is clear", seed));
    World world = parse_world(random_room_text(hash_of(tries, 0, 0, seed), things),
                              fmt::format("random room {}", seed));
    if (can_be_driven(world)) return world;
  }
}

}  // namespace stereovox
