// What pictures of maps have in common: magnified cells, axes in metres, a legend, a scale bar.
//
//   MapCanvas canvas(grid.geometry);
//   canvas.draw_cells(classes, colours);
//   canvas.draw_axes();
//   canvas.add_to_legend(colours[1], "free");
//   canvas.draw_scale_bar();
//   return canvas.picture();
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

#include "stereovox/core/grid_geometry.h"

namespace stereovox {

// Blue, green, red. Told apart also without colour vision: they differ in lightness.
inline const cv::Vec3b kUnknownColour(196, 190, 184), kFreeColour(255, 255, 255);
inline const cv::Vec3b kOccupiedColour(60, 42, 30);

// x points right, y up. Small maps are magnified to about 900 pixels; of maps over 3000 cells a
// side, several cells share a pixel.
class MapCanvas {
 public:
  // The legend has that many lines, each of which holds about four words.
  explicit MapCanvas(const GridGeometry& grid, int legend_lines = 1);

  // A class for each cell, row-major from cell (0, 0), and a colour for each class. Where cells
  // share a pixel, the largest class shows.
  void draw_cells(std::span<const std::uint8_t> classes, std::span<const cv::Vec3b> colours);
  // From a disc to a square; it may be empty and may leave the map.
  void draw_path(std::span<const Eigen::Vector2d> path_m);
  void draw_axes();
  void draw_scale_bar();  // at the lower right; its length is round

  // Entries stand from left to right.
  void add_to_legend(const cv::Vec3b& colour, const std::string& text);
  void add_path_ends_to_legend();
  void begin_legend_line();

  const cv::Mat3b& picture() const { return picture_; }

 private:
  int px(double units) const;
  int thickness() const;
  cv::Size text_size(const std::string& text) const;
  void draw_text(const std::string& text, cv::Point left_middle);
  void draw_disc(cv::Point centre);
  void draw_square(cv::Point centre);
  cv::Point to_subpixel(const Eigen::Vector2d& p_m) const;
  void write_legend(const std::string& text);
  cv::Point legend_mark() const;

  GridGeometry grid_;
  double pixels_per_cell_ = 1;  // below 1: several cells share a pixel
  double unit_px_ = 1;
  cv::Rect map_;  // the map inside the picture
  cv::Mat3b picture_;
  cv::Point legend_at_;
};

}  // namespace stereovox
