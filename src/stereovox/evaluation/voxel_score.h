// How right a 3D map is (method.md, B.7, 3D). The ideal map knows occupied (state 1) and free
// (state 0) voxels, the insides of solids being occupied too; no camera can see those, so what must
// be found is the surface: occupied voxels with a free face neighbour.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

struct VoxelScoreParams {
  int min_observations = 3;  // voxels of the generated map observed less often are not known
  double threshold = 0.5;    // a state above it is occupied, in both maps

  void describe(ParameterList& list);
};

// Figures without anything to average over are absent.
struct VoxelScore {
  double voxel_size_m = 0;
  // Over voxels known in both maps.
  std::int64_t compared = 0;
  std::int64_t true_positives = 0;   // occupied in both
  std::int64_t false_positives = 0;  // free in the ideal map, occupied in the generated one
  std::int64_t surface = 0;          // compared voxels of the ideal surface
  std::int64_t surface_missed = 0;   // of them, free in the generated map
  // precision = TP / (TP + FP); recall = found share of the compared surface;
  // iou = TP / (TP + FP + missed). The tolerant ones accept a partner among the 26 neighbours.
  std::optional<double> precision, recall, f1, iou;
  std::optional<double> tolerant_precision, tolerant_recall, tolerant_f1;

  // Distances between voxel centres. All known occupied voxels of the generated map, against the
  // part of the ideal surface that was in view: that itself or a face neighbour is known.
  std::int64_t occupied = 0, surface_in_view = 0;
  std::optional<double> accuracy_m;    // mean distance from the map to the ideal surface
  std::optional<double> completeness;  // share of the surface in view within a voxel of the map
  std::optional<double> chamfer_m;     // mean of accuracy and its reverse
  std::optional<double> f_score;       // of the shares within a voxel, both ways
};

// Throws Error, with the numbers, when the voxel sizes differ.
VoxelScore score_voxels(const VoxelMap& ideal, const VoxelMap& generated,
                        const VoxelScoreParams& params);

// Keys are the field names; absent figures are null.
nlohmann::json to_json(const VoxelScore& score);
std::string to_text(const VoxelScore& score);

}  // namespace stereovox
