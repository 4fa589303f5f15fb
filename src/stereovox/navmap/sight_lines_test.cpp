#include "stereovox/navmap/sight_lines.h"

#include <gtest/gtest.h>

#include <random>

#include "stereovox/core/error.h"
#include "stereovox/navmap/cell_line.h"
#include "stereovox/navmap/drawn_map_for_test.h"
#include "stereovox/navmap/project_to_2d.h"

namespace stereovox {
namespace {

using Voxels = std::vector<Eigen::Vector3i>;

// What a frame saw, drawn: '#' occupied, 'h' occupied and hit, 'R' the robot, '?' unknown.
struct Scene {
  VoxelMap map{kDrawnVoxelSize_m};
  Eigen::Vector2d robot_xy = {0, 0};
  Voxels hits;
};

Scene drawn_scene(const Drawing& drawing) {
  Scene scene{drawn_voxels(drawing), {}, {}};
  for_each_drawn(drawing, [&](const Eigen::Vector2i& cell, char c) {
    const Eigen::Vector3i voxel(cell.x(), cell.y(), kDrawnLayer);
    if (c == 'R') scene.robot_xy = (cell.cast<double>().array() + 0.5) * kDrawnVoxelSize_m;
    if (c == 'h') set_voxel(scene.map, voxel, kOccupiedState);
    if (c == 'h') scene.hits.push_back(voxel);
  });
  return scene;
}

Drawing observed(const Drawing& drawing, const NavmapParams& params = {}) {
  const Scene scene = drawn_scene(drawing);
  SightLines sight_lines;
  sight_lines.observe(scene.map, scene.robot_xy, scene.hits, params);
  return drawing_of(project_to_2d(scene.map, sight_lines, params));
}

const NavmapParams kAsPrinted{.label_rule = LabelRule::as_printed};

TEST(CellLine, GoesTheSameWayAsTheNearestCellsOfTheLine) {
  std::string drawn;
  const Eigen::Vector2i end(7, 3);
  for (CellLine line({0, 0}, end); line.cell() != end; line.step())
    drawn += std::to_string(line.cell().y());
  EXPECT_EQ(drawn, "0011223");
}

TEST(CellLine, ReachesItsEndInAsManyStepsAsTheLongerSideInAllDirections) {
  for (int x = -4; x <= 4; ++x)
    for (int y = -4; y <= 4; ++y) {
      const Eigen::Vector2i end(x, y);
      CellLine line({0, 0}, end);
      for (int i = 0; i < std::max(std::abs(x), std::abs(y)); ++i) line.step();
      EXPECT_EQ(line.cell(), end);
    }
}

TEST(SightLines, TheWayToAnOccupiedCellThatWasHitIsFree) {
  EXPECT_EQ(observed({"????????h",  //
                      "?????????",  //
                      "R????????"}),
            (Drawing{"??????..#",  //
                     "??....???",  //
                     "..???????"}));
}

TEST(SightLines, OccupiedCellsThatThisFrameDidNotHitSayNothing) {
  EXPECT_EQ(observed({"R?????#",  //
                      "???????",  //
                      "??????h"}),
            (Drawing{"..????#",  //
                     "??...??",  //
                     "?????.#"}));
}

TEST(SightLines, NothingBehindTheFirstOccupiedCellBecomesFree) {
  EXPECT_EQ(observed({"R??#??h"}), Drawing{"...#??#"});
}

TEST(SightLines, AsPrintedLinesCrossObstaclesAndNeedNoHit) {
  EXPECT_EQ(observed({"R??#??#"}, kAsPrinted), Drawing{"...#..#"});
}

TEST(SightLines, HitsThatAreNotOccupiedYetSayNothing) {
  Scene scene = drawn_scene({"R???h"});
  set_voxel(scene.map, scene.hits[0], 0.4F);
  SightLines sight_lines;
  sight_lines.observe(scene.map, scene.robot_xy, scene.hits, {});
  EXPECT_TRUE(sight_lines.free_cells().tiles().empty());
}

TEST(SightLines, HitsOnTheFloorSayNothing) {
  Scene scene = drawn_scene({"R????"});
  const Voxels floor = {{4, 0, 0}};
  set_voxel(scene.map, floor[0], kOccupiedState);
  SightLines sight_lines;
  sight_lines.observe(scene.map, scene.robot_xy, floor, {});
  EXPECT_TRUE(sight_lines.free_cells().tiles().empty());
}

TEST(SightLines, ARobotInAnOccupiedCellStillSees) {
  Scene scene = drawn_scene({"R???h"});
  set_voxel(scene.map, {0, 0, kDrawnLayer}, kOccupiedState);
  SightLines sight_lines;
  sight_lines.observe(scene.map, scene.robot_xy, scene.hits, {});
  EXPECT_EQ(drawing_of(project_to_2d(scene.map, sight_lines, {})), Drawing{"#...#"});
}

TEST(SightLines, FreeCellsOfSeveralFramesAddUp) {
  Scene scene = drawn_scene({"R??h??R"});
  SightLines sight_lines;
  for (const double x : {0.05, 0.65}) sight_lines.observe(scene.map, {x, 0.05}, scene.hits, {});
  EXPECT_EQ(drawing_of(project_to_2d(scene.map, sight_lines, {})), Drawing{"...#..."});
}

TEST(SightLines, HysteresisKeepsACellOccupiedUntilItsStateIsWellBelowTheThreshold) {
  const NavmapParams params{.hysteresis = 0.15};
  VoxelMap map(kDrawnVoxelSize_m);
  const Voxels hit = {{0, 0, kDrawnLayer}};
  SightLines sight_lines;
  std::string labels;
  for (const float state : {0.4F, 0.6F, 0.4F, 0.3F, 0.4F}) {
    set_voxel(map, hit[0], state);
    sight_lines.observe(map, {0.05, 0.05}, state > 0.5F ? hit : Voxels{}, params);
    labels += drawing_of(project_to_2d(map, sight_lines, params))[0];
  }
  EXPECT_EQ(labels, ".##..");
}

constexpr int kFirstLayer = 1, kLastLayer = 14;  // centres at 0.15 and 1.45 m

// The definition, cell by cell, with look-ups of single voxels.
CellSet slow_visible(const Scene& scene, const NavmapParams& params) {
  const auto is_occupied = [&](const Eigen::Vector2i& cell) {
    for (int z = kFirstLayer; z <= kLastLayer; ++z)
      if (const Voxel v = scene.map.at({cell.x(), cell.y(), z});
          v.observations >= params.min_observations && v.state > params.threshold)
        return true;
    return false;
  };
  const Eigen::Vector2i robot = (scene.robot_xy / kDrawnVoxelSize_m).array().floor().cast<int>();
  CellSet free;
  for (const Eigen::Vector3i& hit : scene.hits) {
    const Eigen::Vector2i target = hit.head<2>();
    if (!is_occupied(target) || hit.z() < kFirstLayer || hit.z() > kLastLayer) continue;
    for (CellLine line(robot, target); line.cell() != target; line.step()) {
      if (is_occupied(line.cell()) && line.cell() != robot) break;
      if (!is_occupied(line.cell()))
        free.insert(tile_of(line.cell()), std::uint64_t{1} << position_in_tile(line.cell()));
    }
  }
  return free;
}

TEST(SightLines, AreThoseOfThePlainDefinitionInRandomScenes) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> coordinate(-40, 40), layer(0, 16), observations(1, 6);
  std::uniform_real_distribution<float> state(0.0F, 1.0F);
  for (int round = 0; round < 20; ++round) {
    Scene scene;
    scene.robot_xy = {coordinate(random) * 0.01, coordinate(random) * 0.01};
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3i voxel(coordinate(random), coordinate(random), layer(random));
      set_voxel(scene.map, voxel, state(random), static_cast<std::uint16_t>(observations(random)));
      if (i % 2 == 0) scene.hits.push_back(voxel);
    }
    SightLines sight_lines;
    sight_lines.observe(scene.map, scene.robot_xy, scene.hits, {});
    EXPECT_EQ(sight_lines.free_cells(), slow_visible(scene, {})) << "round " << round;
  }
}

SightLines some_sight_lines() {
  const NavmapParams params{.hysteresis = 0.15};
  const Scene scene = drawn_scene({"h???????????R????????h"});
  SightLines sight_lines;
  sight_lines.observe(scene.map, scene.robot_xy, scene.hits, params);
  return sight_lines;
}

TEST(SightLines, SurviveTheirBytes) {
  const SightLines before = some_sight_lines();
  const SightLines after = sight_lines_from_bytes(to_bytes(before), "map.svx");
  EXPECT_EQ(before, after);
  EXPECT_EQ(after.free_cells().tiles().size(), 3U);
  EXPECT_EQ(after.held_cells().tiles().size(), 2U);
  EXPECT_EQ(sight_lines_from_bytes(to_bytes(SightLines{}), "map.svx"), SightLines{});
}

std::string complaint_about_lines(const std::string& bytes) {
  try {
    sight_lines_from_bytes(bytes, "map.svx");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SightLines, DamagedBytesAreErrors) {
  const std::string good = to_bytes(some_sight_lines());
  EXPECT_EQ(complaint_about_lines(""),
            "map.svx: the sight lines do not begin with 'sight lines 1'");
  EXPECT_EQ(complaint_about_lines(good + "x"), "map.svx: 1 bytes too many after the sight lines");
  std::string many = good;
  many[15] = '\x7f';
  EXPECT_EQ(complaint_about_lines(many), "map.svx: a set of 32515 tiles is cut off");
  std::string unordered = good;
  unordered[18] = '\x05';  // the first tile comes after the second
  EXPECT_EQ(complaint_about_lines(unordered), "map.svx: tile 1 of a set of cells is damaged");
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_NE(complaint_about_lines(good.substr(0, length)), "") << length;
}

TEST(SightLines, OfAnotherBandSayNothingWhereNothingWasSeen) {
  Scene scene = drawn_scene({"R??.?h"});
  SightLines sight_lines;
  sight_lines.observe(scene.map, scene.robot_xy, scene.hits, {});
  sight_lines.keep_seen(scene.map, {});
  EXPECT_EQ(drawing_of(project_to_2d(scene.map, sight_lines, {})), (Drawing{".?#"}));
  sight_lines.keep_seen(scene.map, {.min_height_m = 5.0, .max_height_m = 6.0});
  EXPECT_TRUE(sight_lines.free_cells().tiles().empty());
}

SE3 placed(double x_m, double y_m, double yaw_rad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())),
          {x_m, y_m, 0.0}};
}

SightLines along_x(int cells) {
  VoxelMap map(kDrawnVoxelSize_m);
  const Eigen::Vector3i target(cells, 0, kDrawnLayer);
  set_voxel(map, target, kOccupiedState);
  SightLines sight_lines;
  sight_lines.observe(map, {0.5 * kDrawnVoxelSize_m, 0.5 * kDrawnVoxelSize_m},
                      std::vector<Eigen::Vector3i>{target}, {});
  return sight_lines;
}

std::size_t count_free(const SightLines& sight_lines) {
  std::size_t count = 0;
  for_each_cell(sight_lines.free_cells(), [&](const Eigen::Vector2i&) { ++count; });
  return count;
}

TEST(SightLines, OfAnotherMapMoveWithIt) {
  SightLines merged = along_x(3);
  merged.merge(along_x(4), placed(10 * kDrawnVoxelSize_m, 0.0, 0.0), kDrawnVoxelSize_m);
  EXPECT_EQ(count_free(merged), 3U + 4U);
  for (const int x : {0, 1, 2, 10, 11, 12, 13})
    EXPECT_TRUE(merged.free_cells().contains({x, 0})) << x;
}

TEST(SightLines, LeaveNoGapsWhereAMapIsTurned) {
  constexpr double kQuarter = 1.5707963267948966;
  SightLines turned;
  turned.merge(along_x(5), placed(kDrawnVoxelSize_m, 0.0, kQuarter), kDrawnVoxelSize_m);
  for (int y = 0; y < 5; ++y) EXPECT_TRUE(turned.free_cells().contains({0, y})) << y;
  SightLines aslant;
  aslant.merge(along_x(200), placed(0.3, 0.1, 0.5), kDrawnVoxelSize_m);
  EXPECT_NEAR(static_cast<double>(count_free(aslant)), 200.0, 10.0) << "the area stays";
}

}  // namespace
}  // namespace stereovox
