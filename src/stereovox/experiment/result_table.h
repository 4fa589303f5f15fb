// The results of an experiment as numbers: one row for each map that was scored.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stereovox/experiment/experiment_config.h"

namespace stereovox {

// Which map it is.
struct MapCase {
  std::string group, world, method;
  int seed = 0;
  PoseSource poses = PoseSource::truth;
  double cell_size_m = 0.0;

  auto operator<=>(const MapCase&) const = default;
};

struct ResultRow {
  MapCase of;
  std::map<std::string, double> values;  // by the keys of map_score_report.h; absent = undefined
};

// One column of the paper's Table 1 and what we add to it.
struct TableColumn {
  std::string key, title;
  double factor = 1.0;  // from the value to the column's unit
  bool higher_is_better = false;
  double published = 0.0;  // of the authors' method, 0 = none
};
std::span<const TableColumn> table_columns();

struct MeanAndDeviation {
  double mean = 0.0, deviation = 0.0;  // of the sample; 0 for one value
  int count = 0;
};
MeanAndDeviation mean_and_deviation(std::span<const double> values);

// A Markdown table of the methods of a group for one cell size and pose source: mean +- standard
// deviation over the runs, and the rank of each mean in its column. `world` empty = all worlds.
std::string to_markdown(std::span<const ResultRow> rows, const MethodGroup& group,
                        double cell_size_m, PoseSource poses, const std::string& world);

// All rows and all figures.
void write_csv(const std::filesystem::path& path, std::span<const ResultRow> rows);

// Rows of one drive, to be found again. Reading throws Error when the file is not what was written.
void write_rows(const std::filesystem::path& path, const std::string& key,
                std::span<const ResultRow> rows);
// Nothing when there is no such file or it was made for another key.
std::optional<std::vector<ResultRow>> read_rows(const std::filesystem::path& path,
                                                const std::string& key);

}  // namespace stereovox
