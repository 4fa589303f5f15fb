#include "stereovox/navmap/write_map_server.h"

#include <fmt/format.h>
#include <yaml-cpp/emitter.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "stereovox/io/atomic_file.h"
#include "stereovox/io/image_file.h"

namespace stereovox {
namespace {

int trinary_grey(CellLabel label) {
  switch (label) {
    case CellLabel::free:
      return kFreeGrey;
    case CellLabel::occupied:
      return kOccupiedGrey;
    case CellLabel::unknown:
      break;
  }
  return kUnknownGrey;
}

int raw_value(CellLabel label) {
  switch (label) {
    case CellLabel::free:
      return kRawFree;
    case CellLabel::occupied:
      return kRawOccupied;
    case CellLabel::unknown:
      break;
  }
  return kRawUnknown;
}

// A reader stretches the darkness between the thresholds to 0 .. 100 percent.
int scale_grey(CellLabel label, float state) {
  if (label != CellLabel::free || state <= 0.0F) return trinary_grey(label);
  const double darkness = kFreeThreshold + std::min(static_cast<double>(state), 1.0) *
                                               (kOccupiedThreshold - kFreeThreshold);
  return static_cast<int>(std::lround(kWhite * (1.0 - darkness)));
}

// The image's first row is the one with the largest y.
template <class Pixel, class PixelOf>
cv::Mat_<Pixel> image_of(const OccupancyGrid2D& grid, const PixelOf& pixel_of) {
  const GridGeometry& geometry = grid.geometry;
  cv::Mat_<Pixel> image(geometry.height, geometry.width);
  for (int row = 0; row < image.rows; ++row)
    for (int x = 0; x < image.cols; ++x)
      image(row, x) = pixel_of(grid.position_of({x, geometry.height - 1 - row}));
  return image;
}

void write_pgm(const std::filesystem::path& path, const cv::Mat1b& image) {
  write_file_atomically(path, [&](std::ostream& out) {
    out << fmt::format("P5\n{} {}\n{}\n", image.cols, image.rows, kWhite);
    out.write(reinterpret_cast<const char*>(image.data),
              static_cast<std::streamsize>(image.total()));
  });
}

// Returns the file's name.
std::string write_image(std::filesystem::path path, const OccupancyGrid2D& grid,
                        MapServerMode mode) {
  if (mode == MapServerMode::scale) {
    path.replace_filename(path.stem().string() + "_scale.png");
    write_png(path, image_of<cv::Vec4b>(grid, [&](std::size_t i) {
                const auto grey =
                    cv::saturate_cast<uchar>(scale_grey(grid.labels[i], grid.states[i]));
                const bool is_known = grid.labels[i] != CellLabel::unknown;
                return cv::Vec4b(grey, grey, grey, is_known ? kWhite : 0);
              }));
    return path.filename().string();
  }
  const auto value_of = mode == MapServerMode::raw ? raw_value : trinary_grey;
  path.replace_extension(".pgm");
  write_pgm(path, image_of<uchar>(grid, [&](std::size_t i) {
              return cv::saturate_cast<uchar>(value_of(grid.labels[i]));
            }));
  return path.filename().string();
}

// Nine digits, because 0.0125 with three decimals would be another map; integers for `negate`,
// because ROS 1 reads nothing else.
std::string yaml_of(const std::string& image_name, const GridGeometry& geometry,
                    MapServerMode mode) {
  YAML::Emitter quoted_name;
  quoted_name << image_name;
  return fmt::format(
      "image: {}\nmode: {}\nresolution: {:.9g}\norigin: [{:.9g}, {:.9g}, 0]\nnegate: 0\n"
      "occupied_thresh: {}\nfree_thresh: {}\n",
      quoted_name.c_str(), names_of(mode)[static_cast<std::size_t>(mode)], geometry.cell_size_m,
      geometry.origin_m.x(), geometry.origin_m.y(), kOccupiedThreshold, kFreeThreshold);
}

}  // namespace

void write_map_server(const std::filesystem::path& yaml_path, const OccupancyGrid2D& grid,
                      MapServerMode mode) {
  const std::string image_name = write_image(yaml_path, grid, mode);
  write_file_atomically(
      yaml_path, [&](std::ostream& out) { out << yaml_of(image_name, grid.geometry, mode); });
}

}  // namespace stereovox
