// stereovox disparity LEFT RIGHT -o d.pfm: one pair.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <opencv2/core.hpp>

#include "command.h"
#include "stereovox/dataset/calibration_file.h"
#include "stereovox/io/disparity_file.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/pfm.h"
#include "stereovox/pipeline/stage_times.h"
#include "stereovox/stereo/disparity_picture.h"
#include "stereovox/stereo/rectification_check.h"

namespace stereovox {
namespace {

struct DisparityOptions {
  std::string left, right, calibration, output, confidence, picture;
  ConfigOptions config;
};

GrayImage with_warning(const std::string& path, const LoadedImage& loaded) {
  if (!loaded.conversion.empty()) warn(path + ": " + loaded.conversion);
  return loaded.image;
}

void check_size(const std::string& path, const GrayImage& image, int width, int height,
                const std::string& reference) {
  if (image.width() != width || image.height() != height)
    throw Error(fmt::format("{}: size is {} x {}, {} says {} x {}", path, image.width(),
                            image.height(), reference, width, height));
}

// Without a calibration the images are taken as rectified already.
RectifiedPair rectified_pair(const DisparityOptions& options, const RectificationParams& params) {
  int used_bits = 0;
  const LoadedPair loaded = read_gray_pair(options.left, options.right, used_bits);
  const GrayImage left = with_warning(options.left, loaded.left);
  const GrayImage right = with_warning(options.right, loaded.right);
  check_size(options.right, right, left.width(), left.height(), "the left image");
  if (options.calibration.empty()) return {0, left, right, {}, {}};
  const StereoRig rig = read_calibration(options.calibration, [&] { return left.pixels.size(); });
  validate(rig, options.calibration);
  check_size(options.left, left, rig.left.pinhole.width, rig.left.pinhole.height,
             "the calibration");
  return Rectifier(rig, params).rectify({0, 0, options.left, left, right});
}

// 0 where there is no disparity.
void write_confidence(const std::string& path, const DisparityImage& disparity) {
  if (disparity.confidence.empty())
    throw UsageError(
        "--confidence: this matcher has none; take matcher.type=census_sgm or adaptive_window");
  write_pfm(path, disparity.confidence);
}

ExitCode run(const DisparityOptions& options) {
  const PipelineConfig config = options.config.load();
  for (const std::string& output : {options.output, options.confidence, options.picture})
    require_output(output, {options.left, options.right, options.calibration});
  const RectifiedPair pair = rectified_pair(options, config.rectification);
  const std::string warning =
      judge(summarize({measure_corner_offsets(pair)}), config.rectification, options.left);
  if (!warning.empty()) warn(warning);

  Duration duration;
  const DisparityImage disparity =
      timed(duration, [&] { return match(pair, config.matcher, config.thread_count()); });
  if (!options.confidence.empty()) write_confidence(options.confidence, disparity);
  write_disparity(options.output, disparity);
  if (!options.picture.empty()) write_png(options.picture, draw_disparity(disparity));
  std::cout << fmt::format("{}: {} x {}, {:.1f} % of the pixels have a disparity, {:.1f} ms\n",
                           options.output, disparity.width(), disparity.height(),
                           100.0 * cv::countNonZero(disparity.disparity_px) /
                               static_cast<double>(disparity.disparity_px.total()),
                           duration.wall_ms);
  return ExitCode::ok;
}

}  // namespace

void add_disparity(CLI::App& program, Action& action) {
  auto options = std::make_shared<DisparityOptions>();
  CLI::App* command = program.add_subcommand("disparity", "disparity image of one stereo pair");
  command->add_option("LEFT", options->left)->required();
  command->add_option("RIGHT", options->right)->required();
  command
      ->add_option("--calib", options->calibration,
                   "calibration (forms as for run); without it the images are rectified")
      ->type_name("FILE");
  options->config.add_to(*command);
  command->add_option("-o,--output", options->output, ".pfm, or .png in KITTI's form (16 bit)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--confidence", options->confidence,
                   "probability that each disparity is right, .pfm")
      ->type_name("FILE");
  command->add_option("--picture", options->picture, "the disparities in colour, for people")
      ->type_name("FILE");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
