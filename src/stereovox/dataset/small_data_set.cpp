#include "stereovox/dataset/small_data_set.h"

#include <fmt/format.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "stereovox/core/error.h"
#include "stereovox/dataset/open_sequence.h"

namespace stereovox {

namespace fs = std::filesystem;

void write_small_image(const fs::path& path, int mark, int width, int height) {
  cv::Mat1b image(height, width);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) image(v, u) = static_cast<unsigned char>(37 * u + 91 * v * v);
  image(0, 0) = static_cast<unsigned char>(mark);
  std::vector<unsigned char> bytes;  // not write_png: syncing each image would take long
  cv::imencode(".png", image, bytes);
  write_text(path, std::string(bytes.begin(), bytes.end()));
}

void write_small_plain_set(const fs::path& folder, int pairs) {
  std::string times, poses;
  for (int i = 0; i < pairs; ++i) {
    write_small_image(folder / "left" / image_name(i), i);
    write_small_image(folder / "right" / image_name(i), 100 + i);
    times += fmt::format("{}.{}\n", i / 10, i % 10);
    poses += fmt::format("{0}.{1} 0 0 {0}.{1} 0 0 0 1\n", i / 10, i % 10);
  }
  write_text(folder / "calib.yaml", kSmallCalibration);
  write_text(folder / "times.txt", times);
  write_text(folder / "poses.txt", poses);
}

void write_text(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

std::string image_name(int i) { return fmt::format("{:06}.png", i); }

std::vector<int> left_marks(StereoSequence& sequence) {
  std::vector<int> marks;
  while (const std::optional<StereoFrame> frame = sequence.next())
    marks.push_back(frame->left.pixels(0, 0));
  return marks;
}

std::string complaint_about(const fs::path& folder, const SequenceParams& params) {
  try {
    left_marks(*open_sequence(folder, params));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace stereovox
