#include "stereovox/experiment/figures.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace stereovox {
namespace {

constexpr int kMapSide_px = 360;  // of the longest side of the largest map, at least
constexpr int kMargin_px = 14, kTitle_px = 26;

const cv::Vec3b& color_of(CellLabel label) {
  static const cv::Vec3b unknown(190, 190, 190), free(255, 255, 255), occupied(0, 0, 0);
  return label == CellLabel::occupied ? occupied : label == CellLabel::free ? free : unknown;
}

cv::Mat3b drawn(const OccupancyGrid2D& map, int scale) {
  cv::Mat3b picture(map.geometry.height * scale, map.geometry.width * scale);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      picture(picture.rows - 1 - y, x) = color_of(map.label_at({x / scale, y / scale}));
  return picture;
}

void write_title(cv::Mat3b& picture, const std::string& title, const cv::Point& at, int width_px) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  double size = 0.5;
  int baseline = 0;
  const int wide = cv::getTextSize(title, kFont, size, 1, &baseline).width;
  size *= std::min(1.0, static_cast<double>(width_px) / std::max(wide, 1));
  cv::putText(picture, title, at, kFont, size, {0, 0, 0}, 1, cv::LINE_AA);
}

}  // namespace

cv::Mat3b draw_side_by_side(const std::vector<TitledMap>& maps, int columns) {
  int width = 1, height = 1;
  for (const TitledMap& m : maps) {
    width = std::max(width, m.map.geometry.width);
    height = std::max(height, m.map.geometry.height);
  }
  const int scale = std::max(1, kMapSide_px / std::max(width, height));
  const int step_x = width * scale + kMargin_px, step_y = height * scale + kMargin_px + kTitle_px;
  const int count = static_cast<int>(maps.size());
  const int rows = (count + columns - 1) / columns;
  cv::Mat3b picture(rows * step_y + kMargin_px, std::min(columns, count) * step_x + kMargin_px,
                    cv::Vec3b(255, 255, 255));
  for (int i = 0; i < count; ++i) {
    const TitledMap& m = maps[static_cast<std::size_t>(i)];
    const cv::Point corner(kMargin_px + i % columns * step_x, kMargin_px + i / columns * step_y);
    write_title(picture, m.title, corner + cv::Point(0, kTitle_px - kMargin_px / 2),
                step_x - kMargin_px);
    const cv::Mat3b map = drawn(m.map, scale);
    const cv::Rect place(corner + cv::Point(0, kTitle_px), map.size());
    map.copyTo(picture(place));
    cv::rectangle(picture, place, {120, 120, 120});
  }
  return picture;
}

}  // namespace stereovox
