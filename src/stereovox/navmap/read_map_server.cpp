#include "stereovox/navmap/read_map_server.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "stereovox/core/error.h"
#include "stereovox/core/nearest_name.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/yaml_file.h"

namespace stereovox {
namespace {

constexpr double kMaxCellSize_m = 1000.0;
constexpr double kMaxYaw_rad = 1e-6;  // of a map that counts as not turned
constexpr double kPercent = 100.0;
constexpr float kOccupiedState = 0.5F;  // graded cells above it are occupied
constexpr double k16To8Bit = 1.0 / 257.0;
constexpr int kAlpha = 3;  // its channel

struct MapHeader {
  std::filesystem::path image_path;
  MapServerMode mode = MapServerMode::trinary;
  GridGeometry geometry;  // without width and height
  bool negate = false;
  double occupied_threshold = 0, free_threshold = 0;
};

MapServerMode read_mode(const YAML::Node& yaml, const std::string& source) {
  if (!yaml["mode"]) return MapServerMode::trinary;
  const std::string text = yaml_text(yaml, "mode", source);
  const auto names = names_of(MapServerMode{});
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == text) return static_cast<MapServerMode>(i);
  throw Error(fmt::format("{}: mode '{}' is none of {}{}", source, text, fmt::join(names, " | "),
                          did_you_mean(text, names)));
}

bool read_negate(const YAML::Node& yaml, const std::string& source) {
  const std::string text = yaml_text(yaml, "negate", source);
  if (text == "0" || text == "false" || text == "False") return false;
  if (text == "1" || text == "true" || text == "True") return true;
  throw Error(fmt::format("{}: negate '{}' is none of 0 | 1 | false | true", source, text));
}

void read_thresholds(const YAML::Node& yaml, const std::string& source, MapHeader& header) {
  header.occupied_threshold = yaml_number(yaml, "occupied_thresh", source);
  header.free_threshold = yaml_number(yaml, "free_thresh", source);
  if (!(0.0 <= header.free_threshold && header.free_threshold <= header.occupied_threshold &&
        header.occupied_threshold <= 1.0))
    throw Error(fmt::format("{}: free_thresh {} and occupied_thresh {} are not in order in [0, 1]",
                            source, header.free_threshold, header.occupied_threshold));
}

void read_geometry(const YAML::Node& yaml, const std::string& source, GridGeometry& geometry) {
  geometry.cell_size_m = yaml_number(yaml, "resolution", source);
  if (!(geometry.cell_size_m > 0.0 && geometry.cell_size_m <= kMaxCellSize_m))
    throw Error(fmt::format("{}: resolution {} is not in (0, {}] m", source, geometry.cell_size_m,
                            kMaxCellSize_m));
  const std::vector<double> origin = yaml_numbers(yaml, "origin", 3, source);
  if (std::abs(origin[2]) > kMaxYaw_rad)
    throw Error(fmt::format("{}: the origin has a yaw of {} rad; turned maps cannot be read",
                            source, origin[2]));
  geometry.origin_m = {origin[0], origin[1]};
}

// An absolute path is often that of the machine which made the map.
std::filesystem::path find_image(const std::filesystem::path& yaml_path, const std::string& text,
                                 std::vector<std::string>& remarks) {
  const std::filesystem::path named(text), beside = yaml_path.parent_path() / named.filename();
  if (!named.has_filename()) throw Error(yaml_path.string() + ": 'image' names no file");
  if (named.is_relative()) return yaml_path.parent_path() / named;
  if (std::filesystem::exists(named) || !std::filesystem::exists(beside)) return named;
  remarks.push_back(
      fmt::format("{} is not there; {} beside the map is used", text, named.filename().string()));
  return beside;
}

MapHeader read_header(const std::filesystem::path& yaml_path, std::vector<std::string>& remarks) {
  const std::string source = yaml_path.string();
  const YAML::Node yaml = load_yaml(yaml_path);
  if (!yaml.IsMap()) throw Error(source + ": is not a list of 'key: value' lines");
  MapHeader header;
  header.image_path = find_image(yaml_path, yaml_text(yaml, "image", source), remarks);
  header.mode = read_mode(yaml, source);
  header.negate = read_negate(yaml, source);
  read_thresholds(yaml, source, header);
  read_geometry(yaml, source, header.geometry);
  return header;
}

struct MapPixels {
  cv::Mat1b grey;
  cv::Mat1b alpha;  // empty: all opaque
};

// map_server averages the colour channels; a picture reader would weigh them.
cv::Mat1b mean_of_colours(const cv::Mat& pixels) {
  cv::Mat mean;
  cv::transform(pixels, mean,
                pixels.channels() == 4 ? cv::Mat1f(cv::Matx14f(1.0F / 3, 1.0F / 3, 1.0F / 3, 0.0F))
                                       : cv::Mat1f(cv::Matx13f(1.0F / 3, 1.0F / 3, 1.0F / 3)));
  return mean;
}

MapPixels read_pixels(const std::filesystem::path& path) {
  cv::Mat pixels = read_image(path);
  if (pixels.channels() == 1) return {read_gray_image(path).image.pixels, {}};
  if (pixels.depth() == CV_16U) pixels.convertTo(pixels, CV_8U, k16To8Bit);
  MapPixels result{mean_of_colours(pixels), {}};
  if (pixels.channels() == 4) cv::extractChannel(pixels, result.alpha, kAlpha);
  return result;
}

struct Cell {
  CellLabel label = CellLabel::unknown;
  float state = 0;
};

Cell graded_cell(double state) {
  const auto s = static_cast<float>(state);
  return {s > kOccupiedState ? CellLabel::occupied : CellLabel::free, s};
}

// `darkness` in [0, 1]: a grey value as occupancy, or percent / 100 in raw mode.
Cell cell_of(double darkness, const MapHeader& header) {
  if (darkness > header.occupied_threshold) return {CellLabel::occupied, 1.0F};
  if (darkness < header.free_threshold) return {CellLabel::free, 0.0F};
  if (header.mode == MapServerMode::trinary) return {};
  if (header.mode == MapServerMode::raw) return graded_cell(darkness);
  const double range = header.occupied_threshold - header.free_threshold;
  return graded_cell(range > 0.0 ? (darkness - header.free_threshold) / range : darkness);
}

// What each of the 256 grey values means.
std::array<Cell, kWhite + 1> meanings(const MapHeader& header) {
  std::array<Cell, kWhite + 1> cells;
  for (int grey = 0; grey <= kWhite; ++grey) {
    Cell& cell = cells[static_cast<std::size_t>(grey)];
    const bool is_raw = header.mode == MapServerMode::raw;
    if (is_raw && grey > kRawOccupied) continue;
    const int shade = header.negate ? grey : kWhite - grey;
    cell = cell_of(is_raw ? grey / kPercent : static_cast<double>(shade) / kWhite, header);
  }
  return cells;
}

OccupancyGrid2D grid_of(const MapPixels& pixels, const MapHeader& header) {
  GridGeometry geometry = header.geometry;
  geometry.width = pixels.grey.cols;
  geometry.height = pixels.grey.rows;
  OccupancyGrid2D grid = unknown_grid(geometry, header.image_path.string());
  const auto cells = meanings(header);
  for (int row = 0; row < geometry.height; ++row)
    for (int x = 0; x < geometry.width; ++x) {
      if (!pixels.alpha.empty() && pixels.alpha(row, x) < kWhite) continue;
      const std::size_t position = grid.position_of({x, geometry.height - 1 - row});
      const Cell& cell = cells[pixels.grey(row, x)];
      grid.labels[position] = cell.label;
      grid.states[position] = cell.state;
    }
  return grid;
}

std::string convention_of(const MapHeader& header) {
  const std::string mode(names_of(MapServerMode{})[static_cast<std::size_t>(header.mode)]);
  if (header.mode == MapServerMode::raw)
    return fmt::format("raw: percent; occupied above {:g}, free below {:g}, unknown above 100",
                       kPercent * header.occupied_threshold, kPercent * header.free_threshold);
  return fmt::format("{}: {} = occupied; occupied above {:g}, free below {:g}, {} between", mode,
                     header.negate ? "white" : "black", header.occupied_threshold,
                     header.free_threshold,
                     header.mode == MapServerMode::scale ? "graded" : "unknown");
}

// Cells whose grey gives exactly a threshold, which Nav2 counts in since Jazzy.
int cells_on_thresholds(const cv::Mat1b& greys, const MapHeader& header) {
  int count = 0;
  for (const uchar grey : greys) {
    const double darkness = static_cast<double>(header.negate ? grey : kWhite - grey) / kWhite;
    count += darkness == header.occupied_threshold || darkness == header.free_threshold ? 1 : 0;
  }
  return count;
}

void add_remarks(const MapPixels& pixels, const MapHeader& header,
                 std::vector<std::string>& remarks) {
  if (header.mode == MapServerMode::raw) {
    if (header.negate) remarks.push_back("negate is ignored in raw mode; ROS 1 applies it");
    return;
  }
  const double unknown_darkness = static_cast<double>(kWhite - kUnknownGrey) / kWhite;
  if (!header.negate && unknown_darkness < header.free_threshold &&
      cv::countNonZero(pixels.grey == kUnknownGrey) > 0)
    remarks.push_back(
        fmt::format("free_thresh {:g} makes the grey 205 free, with which map savers write unknown",
                    header.free_threshold));
  if (header.mode == MapServerMode::trinary && !pixels.alpha.empty() &&
      cv::countNonZero(pixels.alpha < kWhite) > 0)
    remarks.push_back(
        "transparent pixels are unknown; ROS 1 and Nav2 before Jazzy mix alpha into the grey");
  if (const int count = cells_on_thresholds(pixels.grey, header); count > 0)
    remarks.push_back(
        fmt::format("{} cells lie exactly on a threshold; Nav2 since Jazzy takes them in", count));
}

}  // namespace

LoadedMap read_map_server(const std::filesystem::path& yaml_path) {
  LoadedMap map;
  const MapHeader header = read_header(yaml_path, map.remarks);
  const MapPixels pixels = read_pixels(header.image_path);
  map.grid = grid_of(pixels, header);
  map.image_path = header.image_path;
  map.mode = header.mode;
  map.convention = convention_of(header);
  add_remarks(pixels, header, map.remarks);
  return map;
}

}  // namespace stereovox
