// What surfaces look like: brightness as a function of the place in the world, so that both
// cameras and all times see the same. Detail is a sum of noise octaves from a material's largest
// scale down to a centimetre; plain walls, screens and metal have hardly any, as real ones do.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "stereovox/core/parameters.h"

namespace stereovox {

enum class Pattern { none, bricks, tiles, planks, print };
std::span<const std::string> names_of(Pattern);

struct Material {
  std::string name;
  double albedo = 0.5;       // mean brightness
  double contrast = 0.1;     // standard deviation of the detail, relative to the mean
  double scale_m = 0.5;      // wavelength of the largest octave
  double persistence = 0.7;  // amplitude of each octave relative to the one of twice its size
  Pattern pattern = Pattern::none;
  double pattern_size_m = 0.25;
  double pattern_contrast = 0.0;  // relative brightness difference between neighbouring elements
  double reflectivity = 0.0;      // share of the light that a mirror would send
  double emission = 0.0;          // brightness of its own, lamps and screens

  void describe(ParameterList& list);
};

// The materials that a world may name without describing them.
std::vector<Material> common_materials();

// Brightness without light, at least 0, of a point. `normal` chooses the plane that patterns lie
// in; `footprint_m` is the width of a pixel on the surface: finer detail averages out.
double albedo_at(const Material& material, const Eigen::Vector3d& p_m,
                 const Eigen::Vector3d& normal, double footprint_m);

// Smooth noise on a unit lattice: mean 0, variance about 1, the same on every machine.
float lattice_noise(const Eigen::Vector3d& p, std::uint32_t seed);

// Well mixed bits of three whole numbers and a seed.
std::uint32_t hash_of(int x, int y, int z, std::uint32_t seed);

}  // namespace stereovox
