#include "stereovox/experiment/write_report.h"

#include <fmt/format.h>

#include <algorithm>

#include <ostream>

#include "stereovox/core/version.h"
#include "stereovox/experiment/figures.h"
#include "stereovox/experiment/map_drive.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/image_file.h"
#include "stereovox/navmap/read_map_server.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

constexpr int kMapsInARow = 4;

const std::string& name_of(PoseSource poses) {
  return names_of(poses)[static_cast<std::size_t>(poses)];
}

OccupancyGrid2D load(const fs::path& output, const std::string& name) {
  return read_map_server(output / "maps" / (name + ".yaml")).grid;
}

// All parameters of all methods: what was used, not what was asked for.
std::string parameters_text(const ExperimentConfig& config) {
  std::string text = fmt::format("stereovox {}\n\n", version());
  const auto add = [&](const std::string& title, auto params) {
    text += fmt::format("# {}\n", title);
    const ParameterList list = parameters_of(params);
    for (const Parameter& p : list.parameters()) text += fmt::format("{}={}\n", p.path, p.get());
    text += "\n";
  };
  add("simulation", config.simulation);
  add("pipeline", config.pipeline);
  add("scan", config.scan);
  add("score", config.score);
  for (const MethodGroup& group : config.groups)
    for (const NamedMethod& method : group.methods)
      text += fmt::format("# {}: {}\n{}\n", group.title, method.name, method.settings);
  return text;
}

std::string published_table() {
  return "The paper's Table 1, one real office, for comparison:\n\n"
         "| method | A Corr. % | B A.M.Sc % | C O.M.Sc % | D F.Pos % | E F.Neg % |\n"
         "|---|---|---|---|---|---|\n"
         "| authors | 53.56 | 17.21 | 19.63 | 44.47 | 14.93 |\n"
         "| Moravec & Elfes 85 | 39.18 | 33.73 | 23.56 | 72.84 | 21.34 |\n"
         "| Matthies & Elfes 88 | 40.69 | 28.27 | 24.82 | 69.17 | 25.91 |\n"
         "| Thrun 93 | 38.34 | 25.97 | 29.71 | 77.13 | 27.93 |\n"
         "| Konolige 97 | 40.54 | 20.25 | 19.69 | 63.45 | 22.64 |\n"
         "| Thrun 01 | 50.13 | 18.56 | 17.39 | 50.15 | 16.68 |\n\n";
}

// The maps of every method of a group, and the ideal ones, of one drive.
void write_figures(const MethodGroup& group, const DriveCase& of, double cell_size_m,
                   PoseSource poses, const fs::path& output, std::string& report) {
  const std::string ideal = ideal_file_name(of, cell_size_m);
  std::vector<TitledMap> maps = {{"ideal", load(output, ideal + "_theoretical")},
                                 {"normalised", load(output, ideal)}};
  const std::string name = fmt::format(
      "{}_{}", file_name({group.title, of.world, "maps", of.seed, poses, cell_size_m}), "fig9.png");
  write_png(output / "figures" / (ideal + "_fig8.png"), draw_side_by_side(maps, 2));
  for (const NamedMethod& method : group.methods)
    maps.push_back({method.name, load(output, file_name({group.title, of.world, method.name,
                                                         of.seed, poses, cell_size_m}))});
  write_png(output / "figures" / name, draw_side_by_side(maps, kMapsInARow));
  report += fmt::format("![maps of {} by all methods](figures/{})\n\n", of.world, name);
}

bool has_drive(std::span<const ResultRow> rows, const MethodGroup& group, const DriveCase& of,
               double cell_size_m, PoseSource poses) {
  return std::ranges::any_of(rows, [&](const ResultRow& row) {
    return row.of.group == group.title && row.of.world == of.world && row.of.seed == of.seed &&
           row.of.cell_size_m == cell_size_m && row.of.poses == poses;
  });
}

std::string group_report(const ExperimentConfig& config, const MethodGroup& group,
                         std::span<const ResultRow> rows, const fs::path& output) {
  std::string report = fmt::format("## {}\n\n", group.title);
  for (const double cell_size_m : group.cell_sizes_m)
    for (const PoseSource poses : group.pose_sources) {
      report += fmt::format("### Cells of {:g} m, {} poses\n\nAll worlds:\n\n{}\n", cell_size_m,
                            name_of(poses), to_markdown(rows, group, cell_size_m, poses, ""));
      for (const ExperimentWorld& world : config.worlds) {
        report += fmt::format("{}:\n\n{}\n", world.name,
                              to_markdown(rows, group, cell_size_m, poses, world.name));
        const DriveCase first{world.name, group.seeds.front()};
        if (has_drive(rows, group, first, cell_size_m, poses))
          write_figures(group, first, cell_size_m, poses, output, report);
      }
    }
  return report;
}

}  // namespace

void write_report(const ExperimentConfig& config, std::span<const ResultRow> rows,
                  const fs::path& output) {
  std::vector<std::string> worlds;
  for (const ExperimentWorld& world : config.worlds) worlds.push_back(world.name);
  std::string report = fmt::format(
      "# {}\n\nstereovox {}; worlds {}; mean ± standard deviation over the runs (rank). Cells are "
      "compared with the normalised ideal map, correlation with the theoretical one. Parameters "
      "were tuned on {} only.\n\n",
      config.name, version(), fmt::join(worlds, ", "),
      config.development_world.empty() ? "no world"
                                       : "the world '" + config.development_world + "'");
  report += published_table();
  for (const MethodGroup& group : config.groups)
    report += group_report(config, group, rows, output);
  write_csv(output / "results.csv", rows);
  write_text_atomically(output / "experiment.yaml", config.source_text);
  write_text_atomically(output / "parameters.txt", parameters_text(config));
  write_text_atomically(output / "report.md", report);
}

}  // namespace stereovox
