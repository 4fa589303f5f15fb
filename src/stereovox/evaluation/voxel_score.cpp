#include "stereovox/evaluation/voxel_score.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "stereovox/core/error.h"
#include "stereovox/evaluation/nearest_voxel.h"
#include "stereovox/evaluation/ratio.h"

namespace stereovox {
namespace {

using Voxels = std::vector<Eigen::Vector3i>;

constexpr double kVoxelSizeTolerance = 1e-6;  // relative

// What a map says of a voxel.
class Knowledge {
 public:
  Knowledge(const VoxelMap& map, int min_observations, double threshold)
      : map_(map), min_observations_(min_observations), threshold_(threshold) {}

  bool knows(const Voxel& v) const { return is_known(v) && v.observations >= min_observations_; }
  bool is_occupied(const Voxel& v) const { return knows(v) && v.state > threshold_; }
  bool is_free(const Voxel& v) const { return knows(v) && !(v.state > threshold_); }
  Voxel at(const Eigen::Vector3i& index) const { return map_.at(index); }

  // Calls visit(index, voxel) for each known voxel, in the canonical order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const VoxelBlock* block : map_.sorted_blocks())
      for (int i = 0; i < kVoxelsPerBlock; ++i) {
        const Voxel voxel = block->voxels[static_cast<std::size_t>(i)];
        if (knows(voxel)) visit(voxel_at(block->index, i), voxel);
      }
  }

 private:
  const VoxelMap& map_;
  int min_observations_;
  double threshold_;
};

template <class Accept>
bool any_face_neighbour(const Eigen::Vector3i& voxel, const Accept& accept) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1})
      if (accept(Eigen::Vector3i(voxel + side * Eigen::Vector3i::Unit(axis)))) return true;
  return false;
}

bool is_near_occupied(const Knowledge& map, const Eigen::Vector3i& voxel) {
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (map.is_occupied(map.at(voxel + Eigen::Vector3i(dx, dy, dz)))) return true;
  return false;
}

struct Comparison {
  const Knowledge &ideal, &generated;
  VoxelScore score = {};
  std::int64_t found_near = 0, surface_near = 0;
  Voxels occupied = {}, surface = {}, surface_in_view = {};

  void run() {
    generated.for_each([&](const Eigen::Vector3i& i, const Voxel& v) { add_generated(i, v); });
    ideal.for_each([&](const Eigen::Vector3i& i, const Voxel& v) { add_ideal(i, v); });
  }

  void add_generated(const Eigen::Vector3i& index, const Voxel& voxel) {
    const bool is_found = generated.is_occupied(voxel);
    if (is_found) occupied.push_back(index);
    const Voxel truth = ideal.at(index);
    if (!ideal.knows(truth)) return;
    ++score.compared;
    if (!is_found) return;
    ++(ideal.is_occupied(truth) ? score.true_positives : score.false_positives);
    found_near += is_near_occupied(ideal, index);
  }

  void add_ideal(const Eigen::Vector3i& index, const Voxel& voxel) {
    const auto is_free = [&](const Eigen::Vector3i& i) { return ideal.is_free(ideal.at(i)); };
    if (!ideal.is_occupied(voxel) || !any_face_neighbour(index, is_free)) return;
    surface.push_back(index);
    const auto is_seen = [&](const Eigen::Vector3i& i) { return generated.knows(generated.at(i)); };
    if (is_seen(index) || any_face_neighbour(index, is_seen)) surface_in_view.push_back(index);
    if (!is_seen(index)) return;
    ++score.surface;
    score.surface_missed += !generated.is_occupied(generated.at(index));
    surface_near += is_near_occupied(generated, index);
  }
};

void score_classes(const Comparison& c, VoxelScore& s) {
  const std::int64_t found = s.true_positives + s.false_positives;
  s.precision = ratio(s.true_positives, found);
  s.recall = ratio(s.surface - s.surface_missed, s.surface);
  s.f1 = harmonic_mean(s.precision, s.recall);
  s.iou = ratio(s.true_positives, found + s.surface_missed);
  s.tolerant_precision = ratio(c.found_near, found);
  s.tolerant_recall = ratio(c.surface_near, s.surface);
  s.tolerant_f1 = harmonic_mean(s.tolerant_precision, s.tolerant_recall);
}

struct Distances {
  double mean_m = 0, share_within_voxel = 0;
};

Distances distances(const Voxels& from, const Voxels& to, double voxel_size_m) {
  const NearestVoxel nearest(to);
  double sum = 0.0;
  std::int64_t within = 0;
  for (const Eigen::Vector3i& voxel : from) {
    const std::int64_t squared = nearest.squared_distance(voxel);
    sum += std::sqrt(static_cast<double>(squared));
    within += squared <= 1;
  }
  const auto count = static_cast<double>(from.size());
  return {sum / count * voxel_size_m, static_cast<double>(within) / count};
}

void score_surfaces(const Comparison& c, VoxelScore& s) {
  s.occupied = static_cast<std::int64_t>(c.occupied.size());
  s.surface_in_view = static_cast<std::int64_t>(c.surface_in_view.size());
  if (c.occupied.empty() || c.surface_in_view.empty()) return;
  const Distances to_ideal = distances(c.occupied, c.surface, s.voxel_size_m);
  const Distances to_map = distances(c.surface_in_view, c.occupied, s.voxel_size_m);
  s.accuracy_m = to_ideal.mean_m;
  s.completeness = to_map.share_within_voxel;
  s.chamfer_m = (to_ideal.mean_m + to_map.mean_m) / 2.0;
  s.f_score = harmonic_mean(to_ideal.share_within_voxel, to_map.share_within_voxel);
}

struct VoxelRow {
  const char *key, *label, *unit;
  std::optional<double> (*value)(const VoxelScore&);
};

constexpr VoxelRow kRows[] = {
    {"voxel_size_m", "voxel edge", "m",
     [](const VoxelScore& s) { return std::optional(s.voxel_size_m); }},
    {"compared", "known in both maps", "voxels",
     [](const VoxelScore& s) { return std::optional<double>(s.compared); }},
    {"true_positives", "occupied in both", "voxels",
     [](const VoxelScore& s) { return std::optional<double>(s.true_positives); }},
    {"false_positives", "free but called occupied", "voxels",
     [](const VoxelScore& s) { return std::optional<double>(s.false_positives); }},
    {"surface", "surface, known in both maps", "voxels",
     [](const VoxelScore& s) { return std::optional<double>(s.surface); }},
    {"surface_missed", "of it, called free", "voxels",
     [](const VoxelScore& s) { return std::optional<double>(s.surface_missed); }},
    {"precision", "precision", "", [](const VoxelScore& s) { return s.precision; }},
    {"recall", "recall", "", [](const VoxelScore& s) { return s.recall; }},
    {"f1", "F1", "", [](const VoxelScore& s) { return s.f1; }},
    {"iou", "IoU", "", [](const VoxelScore& s) { return s.iou; }},
    {"precision_1", "precision within 1 voxel", "",
     [](const VoxelScore& s) { return s.tolerant_precision; }},
    {"recall_1", "recall within 1 voxel", "",
     [](const VoxelScore& s) { return s.tolerant_recall; }},
    {"f1_1", "F1 within 1 voxel", "", [](const VoxelScore& s) { return s.tolerant_f1; }},
    {"occupied", "occupied in the map", "voxels",
     [](const VoxelScore& s) { return std::optional<double>(s.occupied); }},
    {"surface_in_view", "surface in view", "voxels",
     [](const VoxelScore& s) { return std::optional<double>(s.surface_in_view); }},
    {"accuracy_m", "accuracy (map to surface)", "m",
     [](const VoxelScore& s) { return s.accuracy_m; }},
    {"completeness", "completeness within a voxel", "",
     [](const VoxelScore& s) { return s.completeness; }},
    {"chamfer_m", "chamfer (mean of both ways)", "m",
     [](const VoxelScore& s) { return s.chamfer_m; }},
    {"f_score", "F-score within a voxel", "", [](const VoxelScore& s) { return s.f_score; }},
};

}  // namespace

void VoxelScoreParams::describe(ParameterList& list) {
  list("min_observations", min_observations, {1, 65535},
       "voxels of the map observed less often are not known");
  list("threshold", threshold, {0.0, 1.0}, "a state above it is occupied");
}

VoxelScore score_voxels(const VoxelMap& ideal, const VoxelMap& generated,
                        const VoxelScoreParams& params) {
  const double size_m = ideal.voxel_size_m();
  if (std::abs(generated.voxel_size_m() - size_m) > kVoxelSizeTolerance * size_m)
    throw Error(fmt::format("voxel maps: voxels of {:.9g} m and of {:.9g} m cannot be compared",
                            size_m, generated.voxel_size_m()));
  const Knowledge truth(ideal, 1, params.threshold);
  const Knowledge map(generated, params.min_observations, params.threshold);
  Comparison comparison{truth, map};
  comparison.run();
  VoxelScore score = comparison.score;
  score.voxel_size_m = size_m;
  score_classes(comparison, score);
  score_surfaces(comparison, score);
  return score;
}

nlohmann::json to_json(const VoxelScore& score) {
  nlohmann::json json;
  for (const VoxelRow& row : kRows) {
    const std::optional<double> value = row.value(score);
    json[row.key] = value ? nlohmann::json(*value) : nlohmann::json(nullptr);
  }
  return json;
}

std::string to_text(const VoxelScore& score) {
  std::string text;
  for (const VoxelRow& row : kRows)
    if (const std::optional<double> value = row.value(score))
      text += fmt::format("{:<32}{:>12.6g} {}\n", row.label, *value, row.unit);
  return text;
}

}  // namespace stereovox
