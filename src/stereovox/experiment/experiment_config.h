// What an experiment compares with what, as its YAML file says. docs/experiment.md describes the
// form; experiments/table1.yaml is the paper's.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "stereovox/baselines/octomap_baseline.h"
#include "stereovox/baselines/paradigms.h"
#include "stereovox/evaluation/map_score.h"
#include "stereovox/pipeline/pipeline_config.h"
#include "stereovox/simulation/ideal.h"
#include "stereovox/simulation/simulated_sequence.h"

namespace stereovox {

enum class PoseSource { truth, estimated };
std::span<const std::string> names_of(PoseSource);

// The system of the paper, or one of its variants.
struct OccupancyMethod {
  static constexpr const char* kName = "stereovox";

  OccupancyParams occupancy;
  NavmapParams navmap;

  void describe(ParameterList& list) {
    list.section("occupancy", occupancy);
    list.section("navmap", navmap);
  }
};

using MappingMethod =
    std::variant<OccupancyMethod, OctomapBaselineParams, MoravecElfes1985Params,
                 MatthiesElfes1988Params, Thrun1993Params, Konolige1997Params, Thrun2001Params>;

struct NamedMethod {
  std::string name;
  MappingMethod method;
  std::string settings;  // every parameter, as text
};

// Methods that share a table, and what they are tried on.
struct MethodGroup {
  std::string title;
  std::vector<double> cell_sizes_m;
  std::vector<PoseSource> pose_sources;
  std::vector<int> seeds;
  std::vector<NamedMethod> methods;
};

struct ExperimentWorld {
  std::string name;
  std::filesystem::path path;
  std::string drive;
};

struct ExperimentConfig {
  std::string name;
  std::string source_text;        // the file, as read
  std::string development_world;  // what parameters were tuned on; told in the report
  std::vector<ExperimentWorld> worlds;
  SimulationParams simulation;
  PipelineConfig pipeline;  // matcher and odometry; each method brings its own mapping
  PseudoScanParams scan;
  MapScoreParams score;
  HeightBand band;
  double visible_range_m = 5.0;  // for what could have been seen
  std::vector<MethodGroup> groups;

  std::vector<int> seeds() const;  // of all groups, each once, ascending
};

// Paths in the file are relative to it. Throws Error "<path>:<line>: ..." and UsageError.
ExperimentConfig read_experiment(const std::filesystem::path& path);

}  // namespace stereovox
