// The cells of a straight line between two cells (Bresenham 1965): one cell a step along the longer
// axis, each nearest to the line between the two centres.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstdlib>

namespace stereovox {

//   for (CellLine line(a, b); line.cell() != b; line.step()) ...   // a is visited, b is not
class CellLine {
 public:
  CellLine(const Eigen::Vector2i& from, const Eigen::Vector2i& to)
      : cell_(from),
        length_{std::abs(std::int64_t{to.x()} - from.x()),
                std::abs(std::int64_t{to.y()} - from.y())},
        direction_(to.x() > from.x() ? 1 : -1, to.y() > from.y() ? 1 : -1),
        error_(length_[0] - length_[1]) {}

  const Eigen::Vector2i& cell() const { return cell_; }

  void step() {
    const std::int64_t doubled = 2 * error_;
    if (doubled >= -length_[1]) {
      error_ -= length_[1];
      cell_.x() += direction_.x();
    }
    if (doubled <= length_[0]) {
      error_ += length_[0];
      cell_.y() += direction_.y();
    }
  }

 private:
  Eigen::Vector2i cell_;
  std::int64_t length_[2];  // |difference| along x and y
  Eigen::Vector2i direction_;
  std::int64_t error_;  // of the line's position, in units of cell / length
};

}  // namespace stereovox
