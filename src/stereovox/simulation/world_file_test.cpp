#include "stereovox/simulation/world_file.h"

#include <gmock/gmock.h>

#include "stereovox/core/error.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/simulation/ideal.h"
#include "stereovox/simulation/room_for_test.h"
#include "stereovox/simulation/simulated_sequence.h"

namespace stereovox {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& text) {
  try {
    parse_world(text, "w.yaml");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(ReadWorld, ARoomHasFloorCeilingFourWallsAndItsThings) {
  const World world = room_for_test();
  EXPECT_EQ(world.name, "room");
  std::map<std::string, int> count;
  for (const Prism& solid : world.solids) ++count[solid.name];
  EXPECT_EQ(count["floor"], 1);
  EXPECT_EQ(count["ceiling"], 1);
  EXPECT_EQ(count["outer wall"], 4);
  EXPECT_EQ(count["box"], 1);
  EXPECT_EQ(count["lamp"], 6);
  EXPECT_EQ(world.lamps.size(), 6U);
  EXPECT_EQ(world.drives.at("main").waypoints.size(), 2U);
}

TEST(ReadWorld, DoorsLeaveAGapUnderALintelAndAreListed) {
  const World world = room_for_test(
      "walls: [{from: [3, 0], to: [3, 4], doors: [{name: d, at_m: 1, width_m: 0.8, height_m: "
      "2}]}]");
  ASSERT_EQ(world.doorways.size(), 1U);
  EXPECT_EQ(world.doorways[0].a_m, Eigen::Vector2d(3, 0.6));
  EXPECT_EQ(world.doorways[0].b_m, Eigen::Vector2d(3, 1.4));
  const auto blocked = [&](double y, double z) {
    return std::ranges::any_of(world.solids, [&](const Prism& solid) {
      return solid.name == "wall" && contains(solid.base_m, {3, y}) && solid.bottom_m <= z &&
             z < solid.top_m;
    });
  };
  EXPECT_FALSE(blocked(1.0, 1.0));
  EXPECT_TRUE(blocked(1.0, 2.2));
  EXPECT_TRUE(blocked(0.5, 1.0));
  EXPECT_TRUE(blocked(1.5, 1.0));
}

TEST(ReadWorld, CountRepeatsAThing) {
  const World world = room_for_test("");
  const World three = parse_world(
      replaced(room_text(), "material: poster", "material: poster, count: 3, step_m: [0, 0.2]"),
      "w");
  EXPECT_EQ(three.solids.size(), world.solids.size() + 2);
}

TEST(ReadWorld, MistakesAreNamedWithTheirLine) {
  EXPECT_THAT(error_of(replaced(room_text(), "kind: box", "kind: tabel")),
              HasSubstr("w.yaml:6: things 1: there is no kind 'tabel', did you mean 'table'?"));
  EXPECT_THAT(error_of(replaced(room_text(), "material: poster", "material: postre")),
              HasSubstr("there is no material 'postre', did you mean 'poster'?"));
  EXPECT_THAT(error_of(replaced(room_text(), "material: poster", "matrial: poster")),
              HasSubstr("unknown field 'matrial', did you mean 'material'?"));
  EXPECT_THAT(error_of(replaced(room_text(), "name: room", "nam: room")),
              HasSubstr("world: 'name' is missing"));
  EXPECT_THAT(error_of(replaced(room_text(), "[1, 1, 1]", "[1, 1, -1]")),
              HasSubstr("'size_m' is [1, 1, -1], each must be in [0.001, 500]"));
  EXPECT_THAT(error_of(replaced(room_text(), "rate_hz: 2", "rate_hz: 0")),
              HasSubstr("drive 'main': 'rate_hz' is 0, outside [0.1, 1000]"));
  EXPECT_THAT(error_of(replaced(room_text(), "[[1, 2], [2.5, 2]]", "[]")),
              HasSubstr("drive 'main': has no waypoints"));
  EXPECT_THAT(
      error_of(room_text("walls: [{from: [3, 0], to: [3, 4], doors: [{at_m: 3.9, width_m: 1}]}]")),
      HasSubstr("door: does not fit into a wall of 4 m"));
  EXPECT_THAT(error_of(room_text("materials: [{name: a, albedo: 3}]")),
              HasSubstr("materials 1: albedo: 3 is outside [0, 1]"));
  EXPECT_THAT(error_of("[1, 2]"), HasSubstr("world: is not a map of fields"));
}

TEST(ReadWorld, MaterialsMayBeAddedAndReplaced) {
  const World world = room_for_test("materials: [{name: poster, albedo: 0.9}, {name: mine}]");
  EXPECT_EQ(std::ranges::count(world.materials, "poster", &Material::name), 1);
  EXPECT_EQ(std::ranges::find(world.materials, "poster", &Material::name)->albedo, 0.9);
  EXPECT_EQ(std::ranges::count(world.materials, "mine", &Material::name), 1);
}

TEST(DriveOf, NamesTheDrivesThatAWorldHas) {
  try {
    drive_of(room_for_test(), "none", "room.yaml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "room.yaml: has no drive 'none', only main");
  }
}

TEST(WorldFile, TheOneInTheDocumentationCanBeDriven) {
  const std::string page =
      read_file(STEREOVOX_SOURCE_DIR "/docs/simulation.md", std::uint64_t{1} << 20);
  const std::size_t begin = page.find("name: studio");
  ASSERT_NE(begin, std::string::npos);
  const World world = parse_world(page.substr(begin, page.find("```", begin) - begin), "page");
  EXPECT_NO_THROW(Simulation(world, "main", SimulationParams{}, "page", 1));
}

class ShippedWorld : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedWorld, CanBeDrivenWithAnySeed) {
  const World world = read_world(GetParam());
  for (const auto& [name, plan] : world.drives)
    for (const int seed : {1, 2, 3, 4, 5}) {
      SimulationParams params;
      params.seed = seed;
      EXPECT_NO_THROW(Simulation(world, name, params, GetParam().string(), 1)) << name;
    }
}

std::vector<std::filesystem::path> shipped_worlds() {
  std::vector<std::filesystem::path> worlds;
  for (const auto& entry : std::filesystem::directory_iterator(STEREOVOX_SOURCE_DIR "/data/worlds"))
    if (entry.path().extension() == ".yaml") worlds.push_back(entry.path());
  std::ranges::sort(worlds);
  return worlds;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedWorld, testing::ValuesIn(shipped_worlds()),
                         [](const auto& world) { return world.param.stem().string(); });

}  // namespace
}  // namespace stereovox
