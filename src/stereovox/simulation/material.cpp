#include "stereovox/simulation/material.h"

#include <algorithm>
#include <cmath>

namespace stereovox {
namespace {

constexpr double kSmallestScale_m = 0.008;  // finer detail no camera here resolves
// Makes lattice_noise have variance one: trilinear interpolation of values uniform in [-1, 1] with
// smooth weights has a standard deviation of 0.37 on average.
constexpr float kNoiseGain = 2.72F;
// Odd numbers without a pattern in their bits, one for each axis.
constexpr std::uint32_t kAxisFactors[] = {0x85EBCA6BU, 0xC2B2AE35U, 0x27D4EB2FU};
constexpr std::uint32_t kSeedFactor = 0x9E3779B9U;

float smooth_step(float t) { return t * t * (3 - 2 * t); }

// Uniform in [-1, 1).
float signed_unit(std::uint32_t bits) {
  return static_cast<float>(static_cast<std::int32_t>(bits)) * 0x1p-31F;
}

float mix(float a, float b, float t) { return a + (b - a) * t; }

std::uint32_t scaled(int coordinate, int axis) {
  return static_cast<std::uint32_t>(coordinate) * kAxisFactors[axis];
}

std::uint32_t mixed(std::uint32_t h) {
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12)) * 0x297A2D39U;
  return h ^ (h >> 15);
}

// 1 for detail much larger than a pixel, 0 for detail that a pixel averages out.
double visible_share(double wavelength_m, double footprint_m) {
  return std::clamp(wavelength_m / (2 * footprint_m) - 1.0, 0.0, 1.0);
}

double detail_at(const Material& material, const Eigen::Vector3d& p, double footprint_m) {
  double sum = 0.0, variance = 0.0, amplitude = 1.0, scale = material.scale_m;
  for (std::uint32_t octave = 0; scale >= kSmallestScale_m; ++octave, scale /= 2) {
    variance += amplitude * amplitude;
    const double share = visible_share(scale, footprint_m);
    if (share > 0) sum += amplitude * share * lattice_noise(p * (1 / scale), octave);
    amplitude *= material.persistence;
  }
  return variance > 0 ? sum / std::sqrt(variance) : 0.0;
}

// The two coordinates of a surface: along and up a wall, x and y on a floor.
Eigen::Vector2d surface_coordinates(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
  constexpr double kSteep = 0.7;  // of 45 degrees and less lies flat
  if (std::abs(normal.z()) > kSteep) return {p.x(), p.y()};
  return {normal.x() * p.y() - normal.y() * p.x(), p.z()};
}

struct Element {
  int column, row;
  double to_joint;  // smallest distance to the element's edge, in elements
};

// Rows of elements `aspect` times as long as high, each row shifted against the one below.
Element element_at(const Eigen::Vector2d& q, double size_m, double aspect, double shift) {
  const double y = q.y() / (size_m / aspect);
  const int row = static_cast<int>(std::floor(y));
  const double x = q.x() / size_m + shift * (row % 2 == 0 ? 0.0 : 1.0);
  const int column = static_cast<int>(std::floor(x));
  const double in_x = x - column, in_y = y - row;
  return {column, row, std::min({in_x, 1 - in_x, in_y / aspect, (1 - in_y) / aspect})};
}

// In [-1, 1]: a brightness of each element, dark joints between them.
double jointed(const Eigen::Vector2d& q, double size_m, double aspect, double shift) {
  constexpr double kJointWidth = 0.03;
  const Element element = element_at(q, size_m, aspect, shift);
  if (element.to_joint < kJointWidth) return -1.0;
  return 0.6 * signed_unit(hash_of(element.column, element.row, 0, 77));
}

// Words on lines: blocks of two sizes, dark on light.
double printed(const Eigen::Vector2d& q, double size_m) {
  const auto block = [&](double size, std::uint32_t seed) {
    return signed_unit(hash_of(static_cast<int>(std::floor(q.x() / size)),
                               static_cast<int>(std::floor(q.y() / size)), 0, seed));
  };
  return 0.6 * block(size_m, 3) + 0.4 * block(size_m / 4, 4);
}

double pattern_at(const Material& material, const Eigen::Vector2d& q) {
  switch (material.pattern) {
    case Pattern::none:
      return 0.0;
    case Pattern::bricks:
      return jointed(q, material.pattern_size_m, 3.0, 0.5);
    case Pattern::tiles:
      return jointed(q, material.pattern_size_m, 1.0, 0.0);
    case Pattern::planks:
      return jointed(q, material.pattern_size_m, 8.0, 0.37);
    case Pattern::print:
      return printed(q, material.pattern_size_m);
  }
  return 0.0;
}

}  // namespace

std::span<const std::string> names_of(Pattern) {
  static const std::vector<std::string> names = {"none", "bricks", "tiles", "planks", "print"};
  return names;
}

void Material::describe(ParameterList& list) {
  list("albedo", albedo, {0, 1}, "mean brightness");
  list("contrast", contrast, {0, 1}, "standard deviation of the detail relative to the mean");
  list("scale_m", scale_m, {0.005, 10}, "wavelength of the largest detail");
  list("persistence", persistence, {0, 1.5}, "amplitude of detail of half the size");
  list("pattern", pattern, "regular elements on the surface");
  list("pattern_size_m", pattern_size_m, {0.01, 10}, "length of an element");
  list("pattern_contrast", pattern_contrast, {0, 1}, "brightness differences between elements");
  list("reflectivity", reflectivity, {0, 1}, "share of the light that a mirror would send");
  list("emission", emission, {0, 10}, "brightness of its own");
}

std::uint32_t hash_of(int x, int y, int z, std::uint32_t seed) {
  return mixed(seed * kSeedFactor ^ scaled(x, 0) ^ scaled(y, 1) ^ scaled(z, 2));
}

// Trilinear between the values of the eight corners. The products of the hash are shared by them:
// this is where rendering spends most of its time.
float lattice_noise(const Eigen::Vector3d& p, std::uint32_t seed) {
  std::uint32_t low[3], high[3];
  float t[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double floor = std::floor(p[axis]);
    t[axis] = smooth_step(static_cast<float>(p[axis] - floor));
    low[axis] = scaled(static_cast<int>(floor), axis);
    high[axis] = scaled(static_cast<int>(floor) + 1, axis);
  }
  const std::uint32_t begin = seed * kSeedFactor;
  const auto edge = [&](std::uint32_t y, std::uint32_t z) {
    return mix(signed_unit(mixed(begin ^ low[0] ^ y ^ z)),
               signed_unit(mixed(begin ^ high[0] ^ y ^ z)), t[0]);
  };
  return kNoiseGain * mix(mix(edge(low[1], low[2]), edge(high[1], low[2]), t[1]),
                          mix(edge(low[1], high[2]), edge(high[1], high[2]), t[1]), t[2]);
}

double albedo_at(const Material& material, const Eigen::Vector3d& p_m,
                 const Eigen::Vector3d& normal, double footprint_m) {
  double relative = 1.0 + material.contrast * detail_at(material, p_m, footprint_m);
  if (material.pattern != Pattern::none)
    relative += material.pattern_contrast * visible_share(material.pattern_size_m, footprint_m) *
                pattern_at(material, surface_coordinates(p_m, normal));
  return std::max(0.0, material.albedo * relative);
}

// Contrasts as estimated from photographs of offices: painted plaster shows a few percent, mostly
// at the scale of a roller's stripes; screens and metal next to nothing.
std::vector<Material> common_materials() {
  using enum Pattern;
  return {
      {.name = "plaster", .albedo = 0.62, .contrast = 0.08, .scale_m = 0.3, .persistence = 0.9},
      {.name = "paint", .albedo = 0.68, .contrast = 0.03, .scale_m = 0.5, .persistence = 0.8},
      {.name = "carpet", .albedo = 0.34, .contrast = 0.25, .scale_m = 0.15, .persistence = 0.95},
      {.name = "concrete", .albedo = 0.45, .contrast = 0.16, .scale_m = 0.5, .persistence = 0.85},
      {.name = "ceiling",
       .albedo = 0.75,
       .contrast = 0.05,
       .scale_m = 0.2,
       .persistence = 0.8,
       .pattern = tiles,
       .pattern_size_m = 0.6,
       .pattern_contrast = 0.1},
      {.name = "linoleum",
       .albedo = 0.42,
       .contrast = 0.08,
       .scale_m = 0.25,
       .persistence = 0.8,
       .pattern = none,
       .reflectivity = 0.12},
      {.name = "parquet",
       .albedo = 0.40,
       .contrast = 0.10,
       .scale_m = 0.2,
       .persistence = 0.8,
       .pattern = planks,
       .pattern_size_m = 0.9,
       .pattern_contrast = 0.25,
       .reflectivity = 0.05},
      {.name = "tiles",
       .albedo = 0.55,
       .contrast = 0.05,
       .scale_m = 0.3,
       .persistence = 0.7,
       .pattern = tiles,
       .pattern_size_m = 0.3,
       .pattern_contrast = 0.15,
       .reflectivity = 0.08},
      {.name = "brick",
       .albedo = 0.38,
       .contrast = 0.12,
       .scale_m = 0.2,
       .persistence = 0.8,
       .pattern = bricks,
       .pattern_size_m = 0.24,
       .pattern_contrast = 0.35},
      {.name = "wood", .albedo = 0.36, .contrast = 0.2, .scale_m = 0.3, .persistence = 0.85},
      {.name = "veneer", .albedo = 0.52, .contrast = 0.06, .scale_m = 0.5, .persistence = 0.8},
      {.name = "fabric", .albedo = 0.30, .contrast = 0.14, .scale_m = 0.15, .persistence = 0.9},
      {.name = "cardboard",
       .albedo = 0.48,
       .contrast = 0.08,
       .scale_m = 0.3,
       .persistence = 0.8,
       .pattern = print,
       .pattern_size_m = 0.2,
       .pattern_contrast = 0.2},
      {.name = "books",
       .albedo = 0.40,
       .contrast = 0.10,
       .scale_m = 0.1,
       .persistence = 0.8,
       .pattern = print,
       .pattern_size_m = 0.05,
       .pattern_contrast = 0.5},
      {.name = "poster",
       .albedo = 0.55,
       .contrast = 0.06,
       .scale_m = 0.2,
       .persistence = 0.8,
       .pattern = print,
       .pattern_size_m = 0.12,
       .pattern_contrast = 0.5},
      {.name = "plastic", .albedo = 0.25, .contrast = 0.05, .scale_m = 0.3, .persistence = 0.8},
      {.name = "metal",
       .albedo = 0.40,
       .contrast = 0.025,
       .scale_m = 0.3,
       .persistence = 0.8,
       .pattern = none,
       .reflectivity = 0.25},
      {.name = "screen",
       .albedo = 0.04,
       .contrast = 0.02,
       .scale_m = 0.3,
       .persistence = 0.8,
       .pattern = none,
       .reflectivity = 0.10},
      {.name = "lamp", .albedo = 0.9, .contrast = 0.0, .emission = 1.2},
      {.name = "clothes", .albedo = 0.28, .contrast = 0.2, .scale_m = 0.25, .persistence = 0.85},
  };
}

}  // namespace stereovox
