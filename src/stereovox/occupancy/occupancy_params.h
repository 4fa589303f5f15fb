// Everything that can be chosen in the occupancy stage. Presets name the choices together:
// `literal` is what the paper prints, `corrected` repairs it, `tuned` has the formulas of
// `corrected` with other numbers, found on one simulated world. A preset leaves sizes, steps and
// limits alone, but for the surface limit, which the paper does not have.
//
// docs/experiment.md tells what each choice is worth.
#pragma once

#include <span>
#include <string>

#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/homogeneity.h"
#include "stereovox/occupancy/observation_models.h"
#include "stereovox/occupancy/smooth_disparity.h"
#include "stereovox/occupancy/stereo_error_model.h"
#include "stereovox/occupancy/update_rules.h"
#include "stereovox/occupancy/voxel_evidence.h"

namespace stereovox {

enum class OccupancyPreset { literal, corrected, tuned };
std::span<const std::string> names_of(OccupancyPreset);

// Which voxels a frame observes besides those it hits, with O = 0: those that rays to measured
// points cross, walked ray by ray or seen in the image (free_space.h); those inside the field of
// view, hidden or not; or these and every voxel known already.
enum class ObservedSet { raycast, projected, frustum, all };
std::span<const std::string> names_of(ObservedSet);

inline constexpr double kNoSigmaLimit_m = 100.0;

struct OccupancyParams {
  OccupancyPreset preset = OccupancyPreset::corrected;
  double voxel_size_m = 0.05;

  int pixel_step = 0;
  int ray_step_px = 0;
  double min_depth_m = 0.3;
  double max_depth_m = 0.0;     // 0: see with_ranges
  double max_clearing_m = 0.0;  // likewise
  double max_sigma_half_voxels = 3.0;
  double max_sigma_m = kNoSigmaLimit_m;
  double min_height_m = -0.2;
  double max_height_m = 2.0;
  bool follow_floor = false;

  SmoothingParams smoothing;
  StereoErrorModel error_model;
  ObservationModel observation = MinRampObservation{};
  UnionRule union_rule = RankUnion{};
  DensityBonus density = RelativeDensity{};
  double valid_fraction = 1.0;
  ObservedSet observed_set = ObservedSet::raycast;
  double free_margin_sigmas = 1.0;
  HomogeneityParams homogeneity;
  UpdateRule update = SaturatingRule{};
  double initial_state = 0.0;

  void describe(ParameterList& list);
};

// Sets the choices that the preset names.
void apply_preset(OccupancyPreset preset, OccupancyParams& params);

}  // namespace stereovox
