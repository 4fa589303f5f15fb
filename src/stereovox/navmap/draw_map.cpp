#include "stereovox/navmap/draw_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace stereovox {
namespace {

constexpr int kMagnifiedSide_px = 900, kLargestSide_px = 3000;
constexpr int kMaxMagnification = 60;
constexpr double kFarOutside_px = 1e6;
constexpr int kSubpixelBits = 3;  // of coordinates given to OpenCV's lines

// Blue, green, red. Told apart also without colour vision: they differ in lightness.
const cv::Vec3b kUnknownColour(196, 190, 184), kFreeColour(255, 255, 255);
const cv::Vec3b kOccupiedColour(60, 42, 30);
const cv::Scalar kPaper(250, 250, 250), kInk(60, 60, 60), kPathColour(214, 120, 30);
const cv::Scalar kStartColour(90, 170, 40), kEndColour(50, 50, 220);

// Sizes in units of 1/900 of the picture's longer side, so that large pictures have large letters.
constexpr double kMargin = 16, kLeftMargin = 62, kAxisStrip = 34, kLegendStrip = 44;
constexpr double kTick = 6, kFontScale = 0.5, kMarkRadius = 7, kPathWidth = 2.2;
constexpr double kSwatch = 14, kLegendGap = 18, kShortestPicture = 620;
constexpr double kTickSpacing = 110, kScaleBar = 170;  // at most this long

struct Layout {
  double pixels_per_cell = 1;  // below 1: several cells share a pixel
  double unit_px = 1;
  cv::Rect map;  // the map inside the picture
  cv::Size picture;

  int px(double units) const { return static_cast<int>(std::lround(units * unit_px)); }
  int thickness() const { return std::max(1, px(1.0)); }
};

Layout layout_of(const GridGeometry& grid) {
  Layout layout;
  const int longest = std::max(grid.width, grid.height);
  layout.pixels_per_cell = longest <= kLargestSide_px
                               ? std::clamp(kMagnifiedSide_px / longest, 1, kMaxMagnification)
                               : 1.0 / std::ceil(static_cast<double>(longest) / kLargestSide_px);
  const auto side_px = [&](int cells) {
    return std::max(1, static_cast<int>(std::ceil(cells * layout.pixels_per_cell)));
  };
  const cv::Size map(side_px(grid.width), side_px(grid.height));
  layout.unit_px = std::max(1.0, std::max(map.width, map.height) / double{kMagnifiedSide_px});
  layout.map = {{layout.px(kLeftMargin), layout.px(kMargin)}, map};
  layout.picture = {
      std::max(layout.map.br().x + layout.px(2 * kMargin), layout.px(kShortestPicture)),
      layout.map.br().y + layout.px(kAxisStrip + kLegendStrip)};
  return layout;
}

cv::Vec3b colour_of(CellLabel label) {
  switch (label) {
    case CellLabel::free:
      return kFreeColour;
    case CellLabel::occupied:
      return kOccupiedColour;
    case CellLabel::unknown:
      break;
  }
  return kUnknownColour;
}

// One pixel a cell, or a pixel for `cells_per_pixel`^2 cells: the largest label, which is occupied.
cv::Mat3b cells_as_pixels(const OccupancyGrid2D& grid, int cells_per_pixel) {
  const int width = grid.geometry.width, height = grid.geometry.height;
  const auto pixels = [&](int cells) { return (cells + cells_per_pixel - 1) / cells_per_pixel; };
  cv::Mat1b labels(pixels(height), pixels(width), static_cast<uchar>(0));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      uchar& pixel = labels(labels.rows - 1 - y / cells_per_pixel, x / cells_per_pixel);
      pixel = std::max(pixel, static_cast<uchar>(grid.label_at({x, y})));
    }
  cv::Mat3b picture(labels.size());
  std::ranges::transform(labels, picture.begin(),
                         [](uchar label) { return colour_of(static_cast<CellLabel>(label)); });
  return picture;
}

void draw_cells(const OccupancyGrid2D& grid, const Layout& layout, cv::Mat3b& picture) {
  const bool is_shrunk = layout.pixels_per_cell < 1.0;
  const int cells_per_pixel =
      is_shrunk ? static_cast<int>(std::lround(1.0 / layout.pixels_per_cell)) : 1;
  const cv::Mat3b cells = cells_as_pixels(grid, cells_per_pixel);
  cv::resize(cells, picture(layout.map), layout.map.size(), 0, 0, cv::INTER_NEAREST);
  const cv::Rect frame(layout.map.tl() - cv::Point(1, 1), layout.map.size() + cv::Size(2, 2));
  cv::rectangle(picture, frame, kInk, 1);
}

// The largest of 1, 2, 5 times a power of ten that is at most `length`.
double round_length_below(double length) {
  const double decade = std::pow(10.0, std::floor(std::log10(length)));
  return length >= 5.0 * decade ? 5.0 * decade : length >= 2.0 * decade ? 2.0 * decade : decade;
}

cv::Size text_size(const std::string& text, const Layout& layout) {
  int baseline = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kFontScale * layout.unit_px,
                         layout.thickness(), &baseline);
}

// Begins at `left_middle`, centred in height.
void draw_text(const std::string& text, cv::Point left_middle, const Layout& layout,
               cv::Mat3b& picture) {
  left_middle.y += text_size(text, layout).height / 2;
  cv::putText(picture, text, left_middle, cv::FONT_HERSHEY_SIMPLEX, kFontScale * layout.unit_px,
              kInk, layout.thickness(), cv::LINE_AA);
}

// Multiples of `step` inside [from, to].
std::vector<double> round_values(double from, double to, double step) {
  std::vector<double> values;
  for (auto i = std::llround(std::ceil(from / step)); static_cast<double>(i) * step <= to; ++i)
    values.push_back(static_cast<double>(i) * step);
  return values;
}

void draw_axes(const GridGeometry& grid, const Layout& layout, cv::Mat3b& picture) {
  const double px_per_m = layout.pixels_per_cell / grid.cell_size_m;
  const double step_m = round_length_below(kTickSpacing * layout.unit_px / px_per_m);
  const Eigen::Vector2d end_m =
      grid.origin_m + Eigen::Vector2d(grid.width, grid.height) * grid.cell_size_m;
  const int left = layout.map.x, bottom = layout.map.br().y, tick = layout.px(kTick);

  for (const double x_m : round_values(grid.origin_m.x(), end_m.x(), step_m)) {
    const int u = left + static_cast<int>(std::lround((x_m - grid.origin_m.x()) * px_per_m));
    const std::string text = fmt::format("{:.6g}", x_m);
    cv::line(picture, {u, bottom}, {u, bottom + tick}, kInk, layout.thickness());
    draw_text(text, {u - text_size(text, layout).width / 2, bottom + 3 * tick}, layout, picture);
  }
  for (const double y_m : round_values(grid.origin_m.y(), end_m.y(), step_m)) {
    const int v = bottom - static_cast<int>(std::lround((y_m - grid.origin_m.y()) * px_per_m));
    const std::string text = fmt::format("{:.6g}", y_m);
    cv::line(picture, {left - tick, v}, {left, v}, kInk, layout.thickness());
    draw_text(text, {left - 2 * tick - text_size(text, layout).width, v}, layout, picture);
  }
}

// In units of 2^-kSubpixelBits pixels; what is far outside the picture stays far outside.
cv::Point to_pixel(const Eigen::Vector2d& p_m, const GridGeometry& grid, const Layout& layout) {
  const Eigen::Vector2d pixels = (p_m - grid.origin_m) / grid.cell_size_m * layout.pixels_per_cell;
  const auto fixed_point = [](double px) {
    constexpr double kScale = 1 << kSubpixelBits;
    return static_cast<int>(std::lround(kScale * std::clamp(px, -kFarOutside_px, kFarOutside_px)));
  };
  return {fixed_point(layout.map.x + pixels.x()), fixed_point(layout.map.br().y - pixels.y())};
}

void draw_disc(cv::Point centre, const Layout& layout, cv::Mat3b& picture) {
  cv::circle(picture, centre, layout.px(kMarkRadius), kStartColour, cv::FILLED, cv::LINE_AA);
}

void draw_square(cv::Point centre, const Layout& layout, cv::Mat3b& picture) {
  const int half = layout.px(kMarkRadius * 0.8);
  cv::rectangle(picture, centre - cv::Point(half, half), centre + cv::Point(half, half), kEndColour,
                cv::FILLED, cv::LINE_AA);
}

void draw_path(std::span<const Eigen::Vector2d> path_m, const GridGeometry& grid,
               const Layout& layout, cv::Mat3b& picture) {
  if (path_m.empty()) return;
  std::vector<cv::Point> points;
  for (const Eigen::Vector2d& p_m : path_m) points.push_back(to_pixel(p_m, grid, layout));
  cv::polylines(picture, points, false, kPathColour, std::max(1, layout.px(kPathWidth)),
                cv::LINE_AA, kSubpixelBits);
  constexpr int kHalf = 1 << (kSubpixelBits - 1);
  const auto whole = [](cv::Point p) {
    return cv::Point((p.x + kHalf) >> kSubpixelBits, (p.y + kHalf) >> kSubpixelBits);
  };
  draw_disc(whole(points.front()), layout, picture);
  draw_square(whole(points.back()), layout, picture);
}

// Writes words after marks, from left to right.
class LegendPen {
 public:
  LegendPen(const Layout& layout, cv::Mat3b& picture)
      : layout_(layout),
        picture_(picture),
        at_(layout.map.x, picture.rows - layout.px(kLegendStrip * 0.45)) {}

  void swatch(const cv::Vec3b& colour, const std::string& text) {
    const int side = layout_.px(kSwatch);
    const cv::Rect box(at_.x, at_.y - side / 2, side, side);
    cv::rectangle(picture_, box, cv::Scalar(colour), cv::FILLED);
    cv::rectangle(picture_, box, kInk, layout_.thickness());
    word(text);
  }
  template <class Draw>
  void mark(const Draw& draw, const std::string& text) {
    draw(at_ + cv::Point(layout_.px(kSwatch / 2), 0), layout_, picture_);
    word(text);
  }

 private:
  void word(const std::string& text) {
    at_.x += layout_.px(kSwatch * 1.5);
    draw_text(text, at_, layout_, picture_);
    at_.x += text_size(text, layout_).width + layout_.px(kLegendGap);
  }

  const Layout& layout_;
  cv::Mat3b& picture_;
  cv::Point at_;
};

void draw_legend(bool has_path, const Layout& layout, cv::Mat3b& picture) {
  LegendPen pen(layout, picture);
  pen.swatch(kOccupiedColour, "occupied");
  pen.swatch(kFreeColour, "free");
  pen.swatch(kUnknownColour, "unknown");
  if (!has_path) return;
  pen.mark(draw_disc, "start");
  pen.mark(draw_square, "end");
}

// At the lower right; its length is round.
void draw_scale_bar(const GridGeometry& grid, const Layout& layout, cv::Mat3b& picture) {
  const double px_per_m = layout.pixels_per_cell / grid.cell_size_m;
  const double longest_px =
      std::min<double>(kScaleBar * layout.unit_px, layout.picture.width / 4.0);
  const double length_m = round_length_below(longest_px / px_per_m);
  const std::string text = fmt::format("{:g} m", length_m);
  const int length_px = static_cast<int>(std::lround(length_m * px_per_m));
  const cv::Point right(picture.cols - layout.px(kMargin),
                        picture.rows - layout.px(kLegendStrip * 0.3));
  const cv::Point left = right - cv::Point(length_px, 0), tick(0, layout.px(kTick));
  for (const cv::Point end : {left, right})
    cv::line(picture, end - tick, end, kInk, 2 * layout.thickness());
  cv::line(picture, left, right, kInk, 2 * layout.thickness());
  const int text_x = (left.x + right.x - text_size(text, layout).width) / 2;
  draw_text(text, {text_x, right.y - layout.px(2.2 * kTick)}, layout, picture);
}

}  // namespace

cv::Mat3b draw_map(const OccupancyGrid2D& grid, std::span<const Eigen::Vector2d> robot_path_m) {
  const Layout layout = layout_of(grid.geometry);
  cv::Mat3b picture(layout.picture);
  picture.setTo(kPaper);
  draw_cells(grid, layout, picture);
  draw_path(robot_path_m, grid.geometry, layout, picture);
  draw_axes(grid.geometry, layout, picture);
  draw_legend(!robot_path_m.empty(), layout, picture);
  draw_scale_bar(grid.geometry, layout, picture);
  return picture;
}

}  // namespace stereovox
