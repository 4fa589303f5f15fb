// Every parameter of the line from images to maps, and its file form.
#pragma once

#include <yaml-cpp/node/node.h>

#include <filesystem>
#include <string>
#include <vector>

#include "stereovox/core/parameters.h"
#include "stereovox/dataset/stereo_sequence.h"
#include "stereovox/navmap/navmap_params.h"
#include "stereovox/occupancy/occupancy_params.h"
#include "stereovox/odometry/odometry.h"
#include "stereovox/pipeline/world_frame.h"
#include "stereovox/stereo/matcher.h"
#include "stereovox/stereo/rectifier.h"

namespace stereovox {

struct PipelineConfig {
  PipelineConfig();  // the presets `tuned`

  int threads = 0;
  double min_tracked_percent = 50.0;
  double memory_limit_mb = 0.0;
  bool refine = true;
  SequenceParams dataset;
  RectificationParams rectification;
  MatcherParams matcher;
  OdometryParams odometry;
  WorldFrameParams world;
  OccupancyParams occupancy;
  NavmapParams navmap;

  void describe(ParameterList& list) {
    list("threads", threads, {0, 256},
         "worker threads, 0 = one for each core; never changes results");
    list("min_tracked_percent", min_tracked_percent, {0, 100},
         "a run that tracked fewer of its frames is below the quality gate");
    list("memory_limit_mb", memory_limit_mb, {0, 1e7},
         "memory for voxels, 0 = no limit; what is out of view waits on the disk; never changes "
         "results");
    list("refine", refine,
         "map when all frames are tracked, with places seen twice fitted together; otherwise at "
         "once");
    list.section("dataset", dataset);
    list.section("rectification", rectification);
    list.one_of("matcher", matcher, "which matcher finds the disparities");
    list.section("odometry", odometry);
    list.section("world", world);
    list.section("occupancy", occupancy);
    list.section("navmap", navmap);
  }

  int thread_count() const;  // `threads`, or the number of cores
};

// The settings that choose a preset in each stage that has presets: literal, corrected or tuned.
Settings preset_settings(const std::string& name);

// The settings of a YAML file: nested maps of scalars, names joined by dots. Throws Error "path:
// ..." for a file that is no such thing; unknown names are found when they are applied.
Settings read_settings(const std::filesystem::path& path);

// The same from text; `source` is named in errors.
Settings settings_of(const std::string& yaml, const std::string& source);

// The settings below a YAML node, named from there; `source` is named in errors.
Settings settings_of(const YAML::Node& node, const std::string& source);

// "section.field=value"; throws UsageError for anything else.
Settings parse_settings(const std::vector<std::string>& assignments);

// Every parameter as it stands, as YAML with its range and sentence as a comment; read_settings
// reads it back.
std::string to_yaml(PipelineConfig config);

// The reference page: every parameter of every alternative, with default, range and sentence.
std::string parameters_page();

}  // namespace stereovox
