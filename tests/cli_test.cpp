// What a user gets to read when something is wrong: one clear line, the right exit code, no files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "program.h"
#include "stereovox/io/image_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

bool is_empty_or_missing(const fs::path& folder) {
  return !fs::exists(folder) || fs::is_empty(folder);
}

// Maps `source` into a new folder and expects one line of error and nothing else.
void expect_refusal(const fs::path& source, const std::string& options, int exit_code,
                    const std::string& text) {
  const fs::path out = empty_folder("out") / "maps";
  const ProgramResult result =
      run_program("run " + quoted(source) + " -o " + quoted(out) + " -q " + options);
  EXPECT_EQ(result.exit_code, exit_code) << result.output;
  EXPECT_THAT(result.output, HasSubstr("stereovox: error: "));
  EXPECT_THAT(result.output, HasSubstr(text));
  EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << result.output;
  EXPECT_TRUE(is_empty_or_missing(out));
}

TEST(CommandLine, UnknownOptionsAndCommandsNameTheNearestKnownOne) {
  const ProgramResult option = run_program("run data -o out --max-frame 3");
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_THAT(
      option.output,
      HasSubstr("unexpected '--max-frame', did you mean '--max-frames'?; see stereovox run"));
  const ProgramResult command = run_program("rnu data");
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_THAT(command.output, HasSubstr("did you mean 'run'?"));
}

TEST(CommandLine, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(run_program("--version").exit_code, 0);
  for (const char* command : {"run", "disparity", "odometry", "navmap", "score", "score trajectory",
                              "score disparity", "check", "info", "export", "merge"}) {
    const ProgramResult help = run_program(std::string(command) + " --help");
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_THAT(help.output, HasSubstr("Usage")) << command;
  }
}

TEST(CommandLine, UnknownAndImpossibleParametersAreRefusedBeforeAnyWork) {
  const fs::path data = office_extract("data", 3);
  expect_refusal(
      data, "--set occupancy.voxel_size=0.1", 2,
      "unknown parameter 'occupancy.voxel_size', did you mean 'occupancy.voxel_size_m'?");
  expect_refusal(data, "--set occupancy.voxel_size_m=0", 2,
                 "occupancy.voxel_size_m: 0 is outside [");
  expect_refusal(data, "--set occupancy.voxel_size_m=nan", 2, "nan is outside [");
  expect_refusal(data, "--max-frames -4", 2, "dataset.max_frames: -4 is outside [");
}

TEST(CommandLine, AWrongConfigurationFileIsNamed) {
  const fs::path data = office_extract("data", 3);
  const fs::path config = empty_folder("config") / "run.yaml";
  std::ofstream(config) << "occupancy:\n  voxel_sise_m: 0.1\n";
  expect_refusal(data, "--config " + quoted(config), 2,
                 "unknown parameter 'occupancy.voxel_sise_m', did you mean "
                 "'occupancy.voxel_size_m'?");
  std::ofstream(config) << "occupancy: [[[\n";
  expect_refusal(data, "--config " + quoted(config), 3, "run.yaml");
  expect_refusal(data, "--config missing.yaml", 3, "missing.yaml: ");
}

TEST(BadInput, AFolderThatHoldsNoDataSetIsRefused) {
  expect_refusal(empty_folder("data"), "", 3, "data: ");
  expect_refusal("/no/such/folder", "", 3, "/no/such/folder: ");
}

TEST(BadInput, AFolderWithoutRightImagesIsRefused) {
  const fs::path data = office_extract("data", 3);
  fs::remove_all(data / "right");
  fs::create_directory(data / "right");
  expect_refusal(data, "", 3, "right");
}

TEST(BadInput, CalibrationsThatCannotBeTrueAreRefusedWithTheNumber) {
  fs::path data = office_extract("data", 3);
  replace_in(data / "calib.yaml", "baseline: 0.12", "baseline: 0");
  expect_refusal(data, "", 3, "calib.yaml: ");
  data = office_extract("data", 3);
  replace_in(data / "calib.yaml", "fx: 262.4", "fx: .nan");
  expect_refusal(data, "", 3, "calib.yaml");
  data = office_extract("data", 3);
  replace_in(data / "calib.yaml", "baseline: 0.12", "baseline: 120");
  expect_refusal(data, "", 3, "baseline is 120 m, outside [0.005, 10] m; is it in millimetres?");
}

TEST(BadInput, ImagesOfAnotherSizeThanTheCalibrationAreRefused) {
  const fs::path data = office_extract("data", 6);
  replace_in(data / "calib.yaml", "width: 320", "width: 640");
  expect_refusal(data, "", 3, "size is 320 x 240, the calibration says 640 x 240");
}

TEST(BadInput, SwappedImagesAreRecognised) {
  const fs::path data = office_extract("data", 6);
  fs::rename(data / "left", data / "was_left");
  fs::rename(data / "right", data / "left");
  fs::rename(data / "was_left", data / "right");
  expect_refusal(data, "", 3, "left and right images look swapped");
}

TEST(BadInput, TooManyBrokenImagesEndTheRun) {
  const fs::path data = office_extract("data", 8);
  for (const char* name : {"000001.png", "000004.png", "000006.png"}) cut_off(data / "left" / name);
  expect_refusal(data, "", 3, "is cut off");
}

TEST(BadInput, AFewBrokenOrMissingImagesAreSkippedAndReported) {
  const fs::path data = office_extract("data", 45);
  cut_off(data / "left" / "000020.png");
  fs::remove(data / "right" / "000030.png");
  const fs::path out = empty_folder("out");
  const ProgramResult result = run_program("run " + quoted(data) + " -o " + quoted(out));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("000020.png"));
  EXPECT_THAT(result.output, HasSubstr("is cut off"));
  EXPECT_THAT(result.output, HasSubstr("1 pairs skipped"));
  EXPECT_THAT(text_of(out / "report.json"), HasSubstr("\"left_only\": 1"));
}

TEST(BadOutput, AFileInThePlaceOfTheFolderIsAResourceError) {
  const fs::path data = office_extract("data", 3);
  const fs::path file = empty_folder("out") / "file";
  std::ofstream(file) << "x";
  const ProgramResult result = run_program("run " + quoted(data) + " -o " + quoted(file));
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.output, HasSubstr("file: is a file, not a folder"));
  EXPECT_EQ(text_of(file), "x");
}

TEST(BadOutput, AFolderThatCannotBeMadeIsAResourceError) {
  const fs::path data = office_extract("data", 3);
  const ProgramResult result = run_program("run " + quoted(data) + " -o /proc/stereovox/out");
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.output, HasSubstr("/proc/stereovox/out: cannot be made: "));
}

TEST(BadOutput, ResultsAreReplacedOnlyOnRequest) {
  const fs::path data = office_extract("data", 3);
  const fs::path out = empty_folder("out");
  const std::string command = "run " + quoted(data) + " -q -o " + quoted(out);
  ASSERT_EQ(run_program(command).exit_code, 0);
  const ProgramResult again = run_program(command);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.output, HasSubstr("holds the results of a run; give --overwrite"));
  EXPECT_EQ(run_program(command + " --overwrite").exit_code, 0);
}

TEST(BadOutput, FoldersOfTheDataSetAreRefused) {
  const fs::path data = office_extract("data", 3);
  for (const fs::path& out : {data, data / "left"}) {
    const ProgramResult result = run_program("run " + quoted(data) + " -q -o " + quoted(out));
    EXPECT_EQ(result.exit_code, 2) << result.output;
    EXPECT_THAT(result.output, HasSubstr("is a folder of the data set"));
    EXPECT_FALSE(fs::exists(out / "map.svx"));
  }
  EXPECT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(data / "out")).exit_code, 0);
}

TEST(BadOutput, NoCommandReplacesWhatItReads) {
  const fs::path data = office_extract("data", 3), out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out)).exit_code, 0);
  const std::string map = quoted(out / "map.svx"), nav = quoted(out / "nav.yaml"),
                    image = quoted(out / "nav.pgm"), left = quoted(data / "left" / "000000.png"),
                    right = quoted(data / "right" / "000000.png");
  const std::string before =
      text_of(out / "map.svx") + text_of(out / "nav.pgm") + text_of(data / "left" / "000000.png");
  for (const std::string& command :
       {"navmap " + map + " -o " + map, "info " + map + " --picture " + map,
        "info " + nav + " --picture " + image, "score map " + nav + " " + nav + " --json " + nav,
        "disparity " + left + " " + right + " -o " + left}) {
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.exit_code, 2) << command << result.output;
  }
  EXPECT_EQ(before, text_of(out / "map.svx") + text_of(out / "nav.pgm") +
                        text_of(data / "left" / "000000.png"));
}

TEST(BadOutput, AReaderThatGoesAwayCostsNoResults) {
  const fs::path data = office_extract("data", 5), out = empty_folder("out");
  run_program("run " + quoted(data) + " -v -o " + quoted(out) + " | head -n 1");
  EXPECT_TRUE(fs::exists(out / "map.svx"));
}

TEST(Calibration, CamerasThatDifferAndHaveNoDistortionAreRectified) {
  const fs::path data = office_extract("data", 3);
  std::ofstream(data / "calib.yaml", std::ios::app) << "doffs: 4\n";
  const ProgramResult result =
      run_program("run " + quoted(data) + " -q -o " + quoted(empty_folder("out")));
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST(Navmap, ANameWithoutEndingGetsOneAndAnotherEndingIsRefused) {
  const fs::path data = office_extract("data", 3), out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out)).exit_code, 0);
  const std::string command = "navmap " + quoted(out / "map.svx") + " -o ";
  EXPECT_EQ(run_program(command + quoted(out / "site")).exit_code, 0);
  EXPECT_EQ(text_of(out / "site.pgm"), text_of(out / "nav.pgm"));
  const ProgramResult picture = run_program(command + quoted(out / "site.png"));
  EXPECT_EQ(picture.exit_code, 2);
  EXPECT_THAT(picture.output, HasSubstr("ends in .yaml"));
}

TEST(Navmap, HeightsOfWhichNothingIsKnownAreUnknownAndSaid) {
  const fs::path data = office_extract("data", 3), out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out)).exit_code, 0);
  const ProgramResult result = run_program("navmap " + quoted(out / "map.svx") + " -o " +
                                           quoted(out / "high.yaml") + " --min-z 5 --max-z 6");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr(": 0 occupied, 0 free,"));
  EXPECT_THAT(result.output, HasSubstr("nothing was seen often enough from 5 to 6 m"));
}

TEST(Program, ChecksCalibrationsOfOtherForms) {
  const fs::path file = empty_folder("kalibr") / "camchain.yaml";
  const auto check = [&](const std::string& baseline_m) {
    const std::string camera =
        ":\n  camera_model: pinhole\n  intrinsics: [450, 450, 320, 240]\n"
        "  distortion_model: radtan\n  distortion_coeffs: [0.1, 0, 0, 0]\n"
        "  resolution: [640, 480]\n";
    std::ofstream(file) << "cam0" << camera << "cam1" << camera << "  T_cn_cnm1: [[1, 0, 0, -"
                        << baseline_m << "], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";
    return run_program("check " + quoted(file));
  };
  const ProgramResult good = check("0.12");
  EXPECT_EQ(good.exit_code, 0) << good.output;
  EXPECT_THAT(good.output,
              HasSubstr("calibration ok: 640 x 480, fx 450.000 px, baseline 0.1200 m"));
  const ProgramResult in_mm = check("120");
  EXPECT_EQ(in_mm.exit_code, 3);
  EXPECT_THAT(in_mm.output, HasSubstr("is it in millimetres?"));
}

TEST(BadInput, AFileThatIsNoMapAndNoCalibrationIsRefused) {
  const fs::path file = empty_folder("data") / "words.yaml";
  std::ofstream(file) << "just words\n";
  const ProgramResult result = run_program("check " + quoted(file));
  EXPECT_EQ(result.exit_code, 3) << result.output;
  EXPECT_THAT(result.output, HasSubstr("words.yaml"));
  const fs::path bag = empty_folder("bag") / "a.bag";
  std::ofstream(bag) << "#ROSBAG V2.0\n";
  const ProgramResult of_bag = run_program("check " + quoted(bag));
  EXPECT_EQ(of_bag.exit_code, 3) << of_bag.output;
  EXPECT_THAT(of_bag.output,
              HasSubstr("is a ROS 1 bag, a data set, a calibration or a map is needed"));
}

TEST(BadInput, ConversionsOfImagesAreStated) {
  const fs::path data = office_extract("data", 3);
  for (const char* side : {"left", "right"})
    for (const char* name : {"000000.png", "000001.png", "000002.png"}) {
      const cv::Mat grey = read_image(data / side / name);
      cv::Mat deep;
      grey.convertTo(deep, CV_16U, 256.0);
      write_png(data / side / name, deep);
    }
  const ProgramResult result =
      run_program("run " + quoted(data) + " -q -o " + quoted(empty_folder("out")));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("16 bit"));
}

TEST(BadInput, DamagedMapsAreRefused) {
  const fs::path data = office_extract("data", 3);
  const fs::path out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out)).exit_code, 0);
  cut_off(out / "map.svx");
  const ProgramResult result =
      run_program("navmap " + quoted(out / "map.svx") + " -o " + quoted(out / "again.yaml"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.output, HasSubstr("map.svx: "));
  EXPECT_FALSE(fs::exists(out / "again.yaml"));
}

}  // namespace
}  // namespace stereovox
