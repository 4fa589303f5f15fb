#include "stereovox/occupancy/occupancy_params.h"

#include <vector>

namespace stereovox {
namespace {

// The paper integrates every point; this only bounds how many voxels one of them can reach.
constexpr double kNoSigmaLimit_half_voxels = 30.0;

OccupancyParams literal_params() {
  OccupancyParams p;
  p.preset = OccupancyPreset::literal;
  p.max_sigma_half_voxels = kNoSigmaLimit_half_voxels;
  p.error_model.noise = NoiseReading::printed;
  p.error_model.depth_variance = DepthVariance::printed;
  p.observation = LiteralObservation{};
  p.union_rule = MaxUnion{};
  p.density = PrintedDensity{};
  p.observed_set = ObservedSet::frustum;
  p.homogeneity = {.neighbours = Neighbourhood::faces,
                   .unobserved = UnobservedNeighbours::count_as_zero,
                   .min_homogeneity = 0.0};
  p.update = LiteralRule{};
  return p;
}

// A neutral start needs fewer frames to decide; rays that end farther before the surface, and
// points that must be a tenth of those near a voxel, keep surfaces thin. What is measured from so
// far that it may lie a hand's breadth away is left to be seen again from nearer.
// Homogeneity is left out: it kept thin things from ever entering the map. Free space is read from
// the image as a whole, which costs a fraction of the rays and clears no voxel that few rays graze.
// Points of one surface are averaged a little, which their noise, but no edge, notices.
OccupancyParams tuned_params() {
  OccupancyParams p;
  p.preset = OccupancyPreset::tuned;
  p.observed_set = ObservedSet::projected;
  p.smoothing.radius_px = 2;
  p.max_sigma_half_voxels = 4.0;
  p.max_sigma_m = 0.0;
  p.follow_floor = true;
  p.free_margin_sigmas = 2.0;
  p.union_rule = RankUnion{.quantile = 0.01, .majority = 0.1};
  p.homogeneity.min_homogeneity = 1.0;
  p.density = RelativeDensity{.lambda = 0.3};
  p.update = SaturatingRule{.max_credibility = 0.12};
  p.initial_state = 0.5;
  return p;
}

OccupancyParams params_of(OccupancyPreset preset) {
  switch (preset) {
    case OccupancyPreset::literal:
      return literal_params();
    case OccupancyPreset::tuned:
      return tuned_params();
    case OccupancyPreset::corrected:
      break;
  }
  return OccupancyParams{};
}

void describe_selection(OccupancyParams& p, ParameterList& list) {
  list("voxel_size_m", p.voxel_size_m, {0.005, 2}, "edge length of a voxel");
  list("pixel_step", p.pixel_step, {0, 64},
       "every n-th pixel and row marks surfaces; 0 = half the step of the rays");
  list("ray_step_px", p.ray_step_px, {0, 64},
       "every n-th pixel and row clears the space before it; 0 = rays a voxel apart at "
       "max_clearing_m");
  list("min_depth_m", p.min_depth_m, {0.01, 10}, "nearer measurements are ignored");
  list("max_depth_m", p.max_depth_m, {0, 200},
       "farther measurements only clear space; 0 = up to disparities of 8 px, at least 8 m");
  list("max_clearing_m", p.max_clearing_m, {0, 200},
       "space farther away is never cleared; 0 = up to disparities of 13 px and errors of two "
       "voxels, at least 5 m");
  list("max_sigma_half_voxels", p.max_sigma_half_voxels, {0.1, kNoSigmaLimit_half_voxels},
       "measurements with a larger error of the range only clear space; in half voxel edges");
  list(
      "max_sigma_m", p.max_sigma_m, {0, kNoSigmaLimit_m},
      "likewise, but errors below half a voxel always count; 0 = the error of half a pixel at 4 m, "
      "or of a quarter of one at disparities of 11 px");
  list("min_height_m", p.min_height_m, {-100, 100},
       "measurements lower above the floor are ignored, as mirror images");
  list("max_height_m", p.max_height_m, {-100, 100}, "space higher above the floor is left alone");
  list("follow_floor", p.follow_floor,
       "heights count from the floor that is seen, not from a level one, where it rises or falls");
}

}  // namespace

std::span<const std::string> names_of(OccupancyPreset) {
  static const std::vector<std::string> names = {"literal", "corrected", "tuned"};
  return names;
}

std::span<const std::string> names_of(ObservedSet) {
  static const std::vector<std::string> names = {"raycast", "projected", "frustum", "all"};
  return names;
}

std::span<const std::string> names_of(AgeMode) {
  static const std::vector<std::string> names = {"discount_new", "prior_decay"};
  return names;
}

std::span<const std::string> names_of(ConflictRule) {
  static const std::vector<std::string> names = {"dempster", "yager"};
  return names;
}

void apply_preset(OccupancyPreset preset, OccupancyParams& params) {
  const OccupancyParams chosen = params_of(preset);
  params.preset = preset;
  params.smoothing = chosen.smoothing;
  params.max_sigma_half_voxels = chosen.max_sigma_half_voxels;
  params.max_sigma_m = chosen.max_sigma_m;
  params.follow_floor = chosen.follow_floor;
  params.error_model.noise = chosen.error_model.noise;
  params.error_model.depth_variance = chosen.error_model.depth_variance;
  params.observation = chosen.observation;
  params.union_rule = chosen.union_rule;
  params.density = chosen.density;
  params.observed_set = chosen.observed_set;
  params.free_margin_sigmas = chosen.free_margin_sigmas;
  params.homogeneity = chosen.homogeneity;
  params.update = chosen.update;
  params.initial_state = chosen.initial_state;
}

void OccupancyParams::describe(ParameterList& list) {
  list.preset("preset", preset,
              "the paper as printed, as corrected, or that with parameters for fine voxels",
              [this](OccupancyPreset chosen) { apply_preset(chosen, *this); });
  describe_selection(*this, list);
  list.section("smoothing", smoothing);
  list.section("error_model", error_model);
  list.one_of("observation", observation,
              "eq. (12): evidence of one point for one voxel; continuous_log_odds has its own");
  list.one_of("union", union_rule, "eq. (13): how the points of a frame are joined");
  list.one_of("density", density, "eq. (13): bonus for the number of points");
  list("valid_fraction", valid_fraction, {0.01, 1}, "share of the pixels that have a disparity");
  list("observed_set", observed_set, "which voxels a frame observes besides those it hits");
  list("free_margin_sigmas", free_margin_sigmas, {0, 10},
       "rays stop this many standard deviations before the surface, at least half a voxel");
  list.section("homogeneity", homogeneity);
  list.one_of("update", update,
              "how an observation changes a voxel: weighed by eq. (16), or by another model");
  list("initial_state", initial_state, {0, 1},
       "state before the first observation where eq. (16) weighs; other rules begin at 0.5");
}

}  // namespace stereovox
