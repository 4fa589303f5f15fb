#include "stereovox/navmap/read_map_server.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "stereovox/core/error.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/temporary_folder.h"
#include "stereovox/navmap/drawn_map_for_test.h"
#include "stereovox/navmap/write_map_server.h"

namespace stereovox {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Drawing kDrawing = {"##.?", "#..?", "??.."};

// Yaml text with one line replaced; "" leaves the key out.
std::string yaml_with(const std::string& key = "", const std::string& line = "") {
  std::string text;
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{"image", "map.pgm"},
                                                        {"resolution", "0.05"},
                                                        {"origin", "[-1.5, 2, 0.0]"},
                                                        {"negate", "0"},
                                                        {"occupied_thresh", "0.65"},
                                                        {"free_thresh", "0.196"}})
    text += name == key ? line + "\n" : fmt::format("{}: {}\n", name, value);
  return text;
}

// Four pixels in a row: black, the grey of unknown, light grey, white.
const std::string kPgm("P5\n4 1\n255\n\x00\xcd\xdc\xff", 15);

LoadedMap read(const std::string& yaml, const std::string& pgm = kPgm) {
  const TemporaryFolder folder;
  folder.write("map.pgm", pgm);
  return read_map_server(folder.write("map.yaml", yaml));
}

std::string row_read(const std::string& yaml, const std::string& pgm = kPgm) {
  return drawing_of(read(yaml, pgm).grid)[0];
}

TEST(ReadMapServer, ReadsWhatWasWrittenInEveryMode) {
  const TemporaryFolder folder;
  const OccupancyGrid2D grid = drawn_grid(kDrawing, 0.0125, {-0.0375, 2.5});
  for (const auto mode : {MapServerMode::trinary, MapServerMode::scale, MapServerMode::raw}) {
    write_map_server(folder.path() / "nav.yaml", grid, mode);
    const LoadedMap map = read_map_server(folder.path() / "nav.yaml");
    EXPECT_EQ(drawing_of(map.grid), kDrawing);
    EXPECT_EQ(map.grid.geometry, grid.geometry);
    EXPECT_EQ(map.mode, mode);
    EXPECT_THAT(map.remarks, IsEmpty());
  }
}

TEST(ReadMapServer, AMissingModeIsTrinaryAndTheConventionIsSaid) {
  const LoadedMap map = read(yaml_with());
  EXPECT_EQ(drawing_of(map.grid), Drawing{"#?.."});
  EXPECT_EQ(map.grid.geometry, (GridGeometry{{-1.5, 2.0}, 0.05, 4, 1}));
  EXPECT_EQ(map.convention,
            "trinary: black = occupied; occupied above 0.65, free below 0.196, unknown between");
}

TEST(ReadMapServer, NegateMayBeANumberOrATruthValue) {
  for (const char* const value : {"1", "true", "\"1\""})
    EXPECT_EQ(row_read(yaml_with("negate", fmt::format("negate: {}", value))), ".###") << value;
  for (const char* const value : {"0", "false"})
    EXPECT_EQ(row_read(yaml_with("negate", fmt::format("negate: {}", value))), "#?..") << value;
}

TEST(ReadMapServer, NumbersMayBeQuoted) {
  EXPECT_EQ(read(yaml_with("resolution", "resolution: \"0.3\"")).grid.geometry.cell_size_m, 0.3);
}

TEST(ReadMapServer, TheGreyOfUnknownIsFreeUnderAHighFreeThresholdAndThatIsSaid) {
  const LoadedMap map = read(yaml_with("free_thresh", "free_thresh: 0.25"));
  EXPECT_EQ(drawing_of(map.grid), Drawing{"#..."});
  EXPECT_THAT(map.remarks, ElementsAre(HasSubstr("free_thresh 0.25 makes the grey 205 free")));
}

TEST(ReadMapServer, CellsOnAThresholdAreUnknownAndThatIsSaid) {
  const LoadedMap map =
      read(yaml_with("free_thresh", "free_thresh: 0.2"), std::string("P5\n2 1\n255\n\xcc\xff", 13));
  EXPECT_EQ(drawing_of(map.grid), Drawing{"?."});
  EXPECT_THAT(map.remarks, ElementsAre(HasSubstr("1 cells lie exactly on a threshold")));
}

TEST(ReadMapServer, ScaleAndRawHaveStatesBetweenTheThresholds) {
  const LoadedMap scale =
      read("mode: scale\n" + yaml_with(), std::string("P5\n2 1\n255\n\x80\xb4", 13));
  EXPECT_EQ(drawing_of(scale.grid), Drawing{"#."});
  EXPECT_NEAR(scale.grid.states[1], (75.0 / 255 - 0.196) / (0.65 - 0.196), 1e-6);
  const LoadedMap raw =
      read("mode: raw\n" + yaml_with(), std::string("P5\n4 1\n255\n\x00\x28\x64\x65", 15));
  EXPECT_EQ(drawing_of(raw.grid), Drawing{"..#?"});
  EXPECT_FLOAT_EQ(raw.grid.states[1], 0.4F);
}

TEST(ReadMapServer, ColoursAreAveragedAndTransparentPixelsAreUnknown) {
  const TemporaryFolder folder;
  cv::Mat4b image(1, 3, cv::Vec4b(255, 255, 255, 255));
  image(0, 0) = cv::Vec4b(0, 0, 255, 255);  // mean 85: darkness 0.67
  image(0, 2) = cv::Vec4b(255, 255, 255, 0);
  write_png(folder.path() / "map.png", image);
  const LoadedMap map =
      read_map_server(folder.write("m.yaml", yaml_with("image", "image: map.png")));
  EXPECT_EQ(drawing_of(map.grid), Drawing{"#.?"});
  EXPECT_THAT(map.remarks, ElementsAre(HasSubstr("transparent pixels are unknown")));
}

TEST(ReadMapServer, AnAbsoluteImagePathFromAnotherMachineMeansTheImageBesideTheMap) {
  const LoadedMap map = read(yaml_with("image", "image: /nowhere/at/all/map.pgm"));
  EXPECT_EQ(drawing_of(map.grid), Drawing{"#?.."});
  EXPECT_THAT(map.remarks,
              ElementsAre("/nowhere/at/all/map.pgm is not there; map.pgm beside the map is used"));
}

// What is said after the file's name.
std::string complaint_about(const std::string& yaml, const std::string& pgm = kPgm) {
  try {
    read(yaml, pgm);
  } catch (const Error& error) {
    const std::string text = error.what();
    return text.substr(text.find("/map.") + 1);
  }
  return "";
}

TEST(ReadMapServer, WrongHeadersAreErrorsThatNameTheKeyAndTheValue) {
  EXPECT_EQ(complaint_about(""), "map.yaml: is not a list of 'key: value' lines");
  EXPECT_EQ(complaint_about(yaml_with("image")), "map.yaml: 'image' is missing");
  EXPECT_EQ(complaint_about(yaml_with("image", "image: /")), "map.yaml: 'image' names no file");
  EXPECT_EQ(complaint_about(yaml_with("negate", "negate: 2")),
            "map.yaml: negate '2' is none of 0 | 1 | false | true");
  EXPECT_EQ(complaint_about("mode: trinery\n" + yaml_with()),
            "map.yaml: mode 'trinery' is none of trinary | scale | raw, did you mean 'trinary'?");
  EXPECT_EQ(complaint_about(yaml_with("free_thresh", "free_thresh: 0.7")),
            "map.yaml: free_thresh 0.7 and occupied_thresh 0.65 are not in order in [0, 1]");
  EXPECT_EQ(complaint_about(yaml_with("resolution", "resolution: 0")),
            "map.yaml: resolution 0 is not in (0, 1000] m");
  EXPECT_EQ(complaint_about(yaml_with("origin", "origin: [0, 0, 0.3]")),
            "map.yaml: the origin has a yaw of 0.3 rad; turned maps cannot be read");
  EXPECT_THAT(complaint_about(yaml_with("origin", "origin: [0, 0, -nan]")), HasSubstr("'origin'"));
  EXPECT_THAT(complaint_about(yaml_with("origin", "origin: [0, 0]")), HasSubstr("2 numbers"));
  EXPECT_THAT(complaint_about(yaml_with("resolution", "resolution: 0,05")), HasSubstr("0,05"));
}

TEST(ReadMapServer, BrokenImagesAreErrors) {
  EXPECT_THAT(complaint_about(yaml_with(), ""), HasSubstr("map.pgm: is empty"));
  EXPECT_THAT(complaint_about(yaml_with(), kPgm.substr(0, 13)), HasSubstr("map.pgm: is cut off"));
  EXPECT_THAT(complaint_about(yaml_with(), "P5\n30000 30000\n255\nxx"),
              HasSubstr("map.pgm: is cut"));
  EXPECT_THAT(complaint_about(yaml_with("image", "image: map.none")), HasSubstr("map.none"));
}

TEST(ReadMapServer, ReadsTheIdealMapsOfTheOffice) {
  const std::filesystem::path path = STEREOVOX_SHARED_DIR "/data/office_a/ideal_025cm.yaml";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const LoadedMap map = read_map_server(path);
  EXPECT_EQ(map.grid.geometry.cell_size_m, 0.25);
  EXPECT_EQ(map.grid.geometry.origin_m, Eigen::Vector2d(-0.5, -0.5));
  EXPECT_THAT(map.remarks, IsEmpty());
}

}  // namespace
}  // namespace stereovox
