#pragma once

#include <numbers>

namespace stereovox {

inline constexpr double kDegree_rad = std::numbers::pi / 180.0;

}  // namespace stereovox
