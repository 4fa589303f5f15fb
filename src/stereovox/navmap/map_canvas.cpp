#include "stereovox/navmap/map_canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace stereovox {
namespace {

constexpr int kMagnifiedSide_px = 900, kLargestSide_px = 3000;
constexpr int kMaxMagnification = 60;
constexpr double kFarOutside_px = 1e6;
constexpr int kSubpixelBits = 3;  // of coordinates given to OpenCV's lines

const cv::Scalar kPaper(250, 250, 250), kInk(60, 60, 60), kPathColour(214, 120, 30);
const cv::Scalar kStartColour(90, 170, 40), kEndColour(50, 50, 220);

// Sizes in units of 1/900 of the picture's longer side, so that large pictures have large letters.
constexpr double kMargin = 16, kLeftMargin = 62, kAxisStrip = 34, kLegendStrip = 44;
constexpr double kLegendLine = 22, kLegendMiddle = kLegendStrip * 0.45;  // from the lower edge
constexpr double kTick = 6, kFontScale = 0.5, kMarkRadius = 7, kPathWidth = 2.2;
constexpr double kSwatch = 14, kLegendGap = 18, kShortestPicture = 620;
constexpr double kTickSpacing = 110, kScaleBar = 170;  // at most this long

double magnification_of(const GridGeometry& grid) {
  const int longest = std::max(grid.width, grid.height);
  return longest <= kLargestSide_px
             ? std::clamp(kMagnifiedSide_px / longest, 1, kMaxMagnification)
             : 1.0 / std::ceil(static_cast<double>(longest) / kLargestSide_px);
}

// The largest of 1, 2, 5 times a power of ten that is at most `length`.
double round_length_below(double length) {
  const double decade = std::pow(10.0, std::floor(std::log10(length)));
  return length >= 5.0 * decade ? 5.0 * decade : length >= 2.0 * decade ? 2.0 * decade : decade;
}

// Multiples of `step` inside [from, to].
std::vector<double> round_values(double from, double to, double step) {
  std::vector<double> values;
  for (auto i = std::llround(std::ceil(from / step)); static_cast<double>(i) * step <= to; ++i)
    values.push_back(static_cast<double>(i) * step);
  return values;
}

// One pixel a cell, or a pixel for `cells_per_pixel`^2 cells: the largest class among them. The
// first row of cells is the last of pixels.
cv::Mat1b cells_as_pixels(std::span<const std::uint8_t> classes, const GridGeometry& grid,
                          int cells_per_pixel) {
  const auto pixels = [&](int cells) { return (cells + cells_per_pixel - 1) / cells_per_pixel; };
  cv::Mat1b largest(pixels(grid.height), pixels(grid.width), static_cast<uchar>(0));
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      uchar& pixel = largest(largest.rows - 1 - y / cells_per_pixel, x / cells_per_pixel);
      pixel = std::max(pixel,
                       classes[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width) +
                               static_cast<std::size_t>(x)]);
    }
  return largest;
}

}  // namespace

MapCanvas::MapCanvas(const GridGeometry& grid, int legend_lines)
    : grid_(grid), pixels_per_cell_(magnification_of(grid)) {
  const auto side_px = [&](int cells) {
    return std::max(1, static_cast<int>(std::ceil(cells * pixels_per_cell_)));
  };
  const cv::Size map(side_px(grid.width), side_px(grid.height));
  unit_px_ = std::max(1.0, std::max(map.width, map.height) / double{kMagnifiedSide_px});
  map_ = {{px(kLeftMargin), px(kMargin)}, map};
  const double below = kAxisStrip + kLegendStrip + (legend_lines - 1) * kLegendLine;
  picture_.create(map_.br().y + px(below),
                  std::max(map_.br().x + px(2 * kMargin), px(kShortestPicture)));
  picture_.setTo(kPaper);
  legend_at_ = {map_.x, picture_.rows - px(kLegendMiddle + (legend_lines - 1) * kLegendLine)};
}

int MapCanvas::px(double units) const { return static_cast<int>(std::lround(units * unit_px_)); }

int MapCanvas::thickness() const { return std::max(1, px(1.0)); }

void MapCanvas::draw_cells(std::span<const std::uint8_t> classes,
                           std::span<const cv::Vec3b> colours) {
  const bool is_shrunk = pixels_per_cell_ < 1.0;
  const int cells_per_pixel = is_shrunk ? static_cast<int>(std::lround(1.0 / pixels_per_cell_)) : 1;
  const cv::Mat1b pixels = cells_as_pixels(classes, grid_, cells_per_pixel);
  cv::Mat3b cells(pixels.size());
  std::ranges::transform(pixels, cells.begin(), [&](uchar c) { return colours[c]; });
  cv::resize(cells, picture_(map_), map_.size(), 0, 0, cv::INTER_NEAREST);
  const cv::Rect frame(map_.tl() - cv::Point(1, 1), map_.size() + cv::Size(2, 2));
  cv::rectangle(picture_, frame, kInk, 1);
}

cv::Size MapCanvas::text_size(const std::string& text) const {
  int baseline = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kFontScale * unit_px_, thickness(),
                         &baseline);
}

// Begins at `left_middle`, centred in height.
void MapCanvas::draw_text(const std::string& text, cv::Point left_middle) {
  left_middle.y += text_size(text).height / 2;
  cv::putText(picture_, text, left_middle, cv::FONT_HERSHEY_SIMPLEX, kFontScale * unit_px_, kInk,
              thickness(), cv::LINE_AA);
}

void MapCanvas::draw_axes() {
  const double px_per_m = pixels_per_cell_ / grid_.cell_size_m;
  const double step_m = round_length_below(kTickSpacing * unit_px_ / px_per_m);
  const Eigen::Vector2d end_m =
      grid_.origin_m + Eigen::Vector2d(grid_.width, grid_.height) * grid_.cell_size_m;
  const int left = map_.x, bottom = map_.br().y, tick = px(kTick);

  for (const double x_m : round_values(grid_.origin_m.x(), end_m.x(), step_m)) {
    const int u = left + static_cast<int>(std::lround((x_m - grid_.origin_m.x()) * px_per_m));
    const std::string text = fmt::format("{:.6g}", x_m);
    cv::line(picture_, {u, bottom}, {u, bottom + tick}, kInk, thickness());
    draw_text(text, {u - text_size(text).width / 2, bottom + 3 * tick});
  }
  for (const double y_m : round_values(grid_.origin_m.y(), end_m.y(), step_m)) {
    const int v = bottom - static_cast<int>(std::lround((y_m - grid_.origin_m.y()) * px_per_m));
    const std::string text = fmt::format("{:.6g}", y_m);
    cv::line(picture_, {left - tick, v}, {left, v}, kInk, thickness());
    draw_text(text, {left - 2 * tick - text_size(text).width, v});
  }
}

// In units of 2^-kSubpixelBits pixels; what is far outside the picture stays far outside.
cv::Point MapCanvas::to_subpixel(const Eigen::Vector2d& p_m) const {
  const Eigen::Vector2d pixels = (p_m - grid_.origin_m) / grid_.cell_size_m * pixels_per_cell_;
  const auto fixed_point = [](double px) {
    constexpr double kScale = 1 << kSubpixelBits;
    return static_cast<int>(std::lround(kScale * std::clamp(px, -kFarOutside_px, kFarOutside_px)));
  };
  return {fixed_point(map_.x + pixels.x()), fixed_point(map_.br().y - pixels.y())};
}

void MapCanvas::draw_disc(cv::Point centre) {
  cv::circle(picture_, centre, px(kMarkRadius), kStartColour, cv::FILLED, cv::LINE_AA);
}

void MapCanvas::draw_square(cv::Point centre) {
  const int half = px(kMarkRadius * 0.8);
  cv::rectangle(picture_, centre - cv::Point(half, half), centre + cv::Point(half, half),
                kEndColour, cv::FILLED, cv::LINE_AA);
}

void MapCanvas::draw_path(std::span<const Eigen::Vector2d> path_m) {
  if (path_m.empty()) return;
  std::vector<cv::Point> points;
  for (const Eigen::Vector2d& p_m : path_m) points.push_back(to_subpixel(p_m));
  cv::polylines(picture_, points, false, kPathColour, std::max(1, px(kPathWidth)), cv::LINE_AA,
                kSubpixelBits);
  constexpr int kHalf = 1 << (kSubpixelBits - 1);
  const auto whole = [](cv::Point p) {
    return cv::Point((p.x + kHalf) >> kSubpixelBits, (p.y + kHalf) >> kSubpixelBits);
  };
  draw_disc(whole(points.front()));
  draw_square(whole(points.back()));
}

cv::Point MapCanvas::legend_mark() const { return legend_at_ + cv::Point(px(kSwatch / 2), 0); }

void MapCanvas::write_legend(const std::string& text) {
  legend_at_.x += px(kSwatch * 1.5);
  draw_text(text, legend_at_);
  legend_at_.x += text_size(text).width + px(kLegendGap);
}

void MapCanvas::add_to_legend(const cv::Vec3b& colour, const std::string& text) {
  const int side = px(kSwatch);
  const cv::Rect box(legend_at_.x, legend_at_.y - side / 2, side, side);
  cv::rectangle(picture_, box, cv::Scalar(colour), cv::FILLED);
  cv::rectangle(picture_, box, kInk, thickness());
  write_legend(text);
}

void MapCanvas::add_path_ends_to_legend() {
  draw_disc(legend_mark());
  write_legend("start");
  draw_square(legend_mark());
  write_legend("end");
}

void MapCanvas::begin_legend_line() { legend_at_ = {map_.x, legend_at_.y + px(kLegendLine)}; }

void MapCanvas::draw_scale_bar() {
  const double px_per_m = pixels_per_cell_ / grid_.cell_size_m;
  const double longest_px = std::min<double>(kScaleBar * unit_px_, picture_.cols / 4.0);
  const double length_m = round_length_below(longest_px / px_per_m);
  const std::string text = fmt::format("{:g} m", length_m);
  const int length_px = static_cast<int>(std::lround(length_m * px_per_m));
  const cv::Point right(picture_.cols - px(kMargin), picture_.rows - px(kLegendStrip * 0.3));
  const cv::Point left = right - cv::Point(length_px, 0), tick(0, px(kTick));
  for (const cv::Point end : {left, right})
    cv::line(picture_, end - tick, end, kInk, 2 * thickness());
  cv::line(picture_, left, right, kInk, 2 * thickness());
  const int text_x = (left.x + right.x - text_size(text).width) / 2;
  draw_text(text, {text_x, right.y - px(2.2 * kTick)});
}

}  // namespace stereovox
