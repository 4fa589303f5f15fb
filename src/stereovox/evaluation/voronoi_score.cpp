#include "stereovox/evaluation/voronoi_score.h"

#include <algorithm>
#include <random>
#include <span>
#include <utility>

#include "stereovox/core/parallel.h"
#include "stereovox/evaluation/ratio.h"
#include "stereovox/evaluation/value_grid.h"
#include "stereovox/evaluation/voronoi_graph.h"
#include "stereovox/navmap/plan_path.h"

namespace stereovox {
namespace {

using NodePair = std::pair<std::size_t, std::size_t>;  // first < second

std::vector<NodePair> all_pairs(std::size_t nodes) {
  std::vector<NodePair> pairs;
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t b = a + 1; b < nodes; ++b) pairs.emplace_back(a, b);
  return pairs;
}

// Ascending, so that the pairs of one source follow each other; some may be drawn twice.
std::vector<NodePair> node_pairs(std::size_t nodes, const VoronoiScoreParams& params) {
  const auto wanted = static_cast<std::size_t>(params.max_pairs);
  if (nodes < 2) return {};
  if (nodes * (nodes - 1) / 2 <= wanted) return all_pairs(nodes);
  std::mt19937_64 random(params.seed);
  std::vector<NodePair> pairs(wanted);
  for (NodePair& pair : pairs) {
    pair.first = random() % nodes;
    pair.second = random() % (nodes - 1);
    if (pair.second >= pair.first) ++pair.second;
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
  }
  std::ranges::sort(pairs);
  return pairs;
}

struct Counts {
  std::int64_t paths = 0, invalid = 0;
};

Counts count_from(const CostGrid& grid, const VoronoiGraph& graph, const CellMask& refused,
                  std::span<const NodePair> pairs) {
  const ShortestPaths paths = shortest_paths(grid, graph.nodes[pairs.front().first]);
  Counts counts;
  for (const NodePair& pair : pairs) {
    const std::vector<int> path = path_to(paths, graph.nodes[pair.second]);
    counts.paths += !path.empty();
    counts.invalid += std::ranges::any_of(path, [&](int cell) { return refused.has(cell); });
  }
  return counts;
}

VoronoiCounts count_paths(const VoronoiGraph& graph, const CellMask& refused,
                          const VoronoiScoreParams& params) {
  const CostGrid grid = cost_grid_of_lines(graph.lines);
  const std::vector<NodePair> pairs = node_pairs(graph.nodes.size(), params);
  std::vector<Counts> counts(graph.nodes.size());
  parallel_for(0, static_cast<int>(counts.size()), params.threads, [&](int i) {
    const auto own =
        std::ranges::equal_range(pairs, static_cast<std::size_t>(i), {}, &NodePair::first);
    if (!own.empty())
      counts[static_cast<std::size_t>(i)] =
          count_from(grid, graph, refused, {own.begin(), own.end()});
  });
  VoronoiCounts sum{static_cast<int>(graph.nodes.size()), 0, 0};
  for (const Counts& part : counts) {
    sum.paths += part.paths;
    sum.invalid += part.invalid;
  }
  return sum;
}

CellMask refused_by(const OccupancyGrid2D& map, double robot_radius_m, bool unknown_is_free) {
  CellMask refused =
      free_for_robot(map, {.robot_radius_m = robot_radius_m, .unknown_is_free = unknown_is_free});
  for (std::uint8_t& cell : refused.cells) cell ^= 1;
  return refused;
}

}  // namespace

std::optional<double> VoronoiCounts::invalid_percent() const {
  return ratio(100.0 * static_cast<double>(invalid), static_cast<double>(paths));
}

VoronoiScore score_voronoi_paths(const IdealMap& ideal, const OccupancyGrid2D& generated,
                                 const VoronoiScoreParams& params) {
  const GridGeometry region = union_of(ideal.theoretical.geometry, generated.geometry);
  const OccupancyGrid2D plan = extended_to(planning_map(ideal), region);
  const OccupancyGrid2D found = extended_to(generated, region);
  const double radius_m = params.robot_radius_m;
  return {count_paths(voronoi_graph(found, radius_m), refused_by(plan, radius_m, true), params),
          count_paths(voronoi_graph(plan, radius_m), refused_by(found, radius_m, false), params)};
}

}  // namespace stereovox
