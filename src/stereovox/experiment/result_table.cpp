#include "stereovox/experiment/result_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/file_bytes.h"

namespace stereovox {
namespace {

constexpr std::uint64_t kMaxRowsBytes = 256ULL << 20;

std::vector<double> values_of(std::span<const ResultRow> rows, const MapCase& like,
                              const std::string& key) {
  std::vector<double> values;
  for (const ResultRow& row : rows) {
    const MapCase& of = row.of;
    if (of.group != like.group || of.method != like.method || of.poses != like.poses ||
        of.cell_size_m != like.cell_size_m || (!like.world.empty() && of.world != like.world))
      continue;
    if (const auto found = row.values.find(key); found != row.values.end())
      values.push_back(found->second);
  }
  return values;
}

// 1 = best; equal means share a rank; nothing without a value.
std::vector<int> ranks(const std::vector<MeanAndDeviation>& means, bool higher_is_better) {
  std::vector<int> ranks;
  for (const MeanAndDeviation& mine : means) {
    int rank = 1;
    for (const MeanAndDeviation& other : means)
      if (other.count > 0 && (higher_is_better ? other.mean > mine.mean : other.mean < mine.mean))
        ++rank;
    ranks.push_back(mine.count > 0 ? rank : 0);
  }
  return ranks;
}

std::string cell_text(const MeanAndDeviation& value, int rank, double factor) {
  if (value.count == 0) return "n/a";
  const std::string text =
      fmt::format("{:.2f} ± {:.2f}", value.mean * factor, value.deviation * factor);
  return rank == 1 ? fmt::format("**{}** (1)", text) : fmt::format("{} ({})", text, rank);
}

nlohmann::json to_json(const ResultRow& row) {
  return {{"group", row.of.group},
          {"world", row.of.world},
          {"method", row.of.method},
          {"seed", row.of.seed},
          {"poses", static_cast<int>(row.of.poses)},
          {"cell_size_m", row.of.cell_size_m},
          {"values", row.values}};
}

ResultRow row_from_json(const nlohmann::json& json) {
  return {{.group = json.at("group"),
           .world = json.at("world"),
           .method = json.at("method"),
           .seed = json.at("seed"),
           .poses = json.at("poses").get<int>() == 0 ? PoseSource::truth : PoseSource::estimated,
           .cell_size_m = json.at("cell_size_m")},
          json.at("values").get<std::map<std::string, double>>()};
}

std::string in_csv(const std::string& text) {
  return text.find_first_of(",\"\n") == std::string::npos ? text : nlohmann::json(text).dump();
}

}  // namespace

std::span<const TableColumn> table_columns() {
  static const std::vector<TableColumn> columns = {
      {"ternary_correlation", "A Corr. %", 100.0, true, 53.56},
      {"ternary_map_score_all", "B A.M.Sc %", 1.0, false, 17.21},
      {"ternary_map_score_occupied", "C O.M.Sc %", 1.0, false, 19.63},
      {"paths_fp_percent", "D F.Pos %", 1.0, false, 44.47},
      {"paths_fn_percent", "E F.Neg %", 1.0, false, 14.93},
      {"false_free_rate", "false free %", 100.0, false},
      {"f1_1", "F1 within 1 cell %", 100.0, true},
      {"coverage", "coverage %", 100.0, true},
  };
  return columns;
}

MeanAndDeviation mean_and_deviation(std::span<const double> values) {
  MeanAndDeviation result{.count = static_cast<int>(values.size())};
  if (values.empty()) return result;
  for (const double value : values) result.mean += value / result.count;
  if (values.size() < 2) return result;
  double squares = 0.0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.deviation = std::sqrt(squares / (result.count - 1));
  return result;
}

std::string to_markdown(std::span<const ResultRow> rows, const MethodGroup& group,
                        double cell_size_m, PoseSource poses, const std::string& world) {
  std::string header = "| method |", rule = "|---|";
  std::vector<std::string> lines;
  for (const NamedMethod& method : group.methods) lines.push_back("| " + method.name + " |");
  for (const TableColumn& column : table_columns()) {
    header += " " + column.title + " |";
    rule += "---|";
    std::vector<MeanAndDeviation> means;
    for (const NamedMethod& method : group.methods)
      means.push_back(mean_and_deviation(values_of(rows,
                                                   {.group = group.title,
                                                    .world = world,
                                                    .method = method.name,
                                                    .poses = poses,
                                                    .cell_size_m = cell_size_m},
                                                   column.key)));
    const std::vector<int> rank = ranks(means, column.higher_is_better);
    for (std::size_t i = 0; i < means.size(); ++i)
      lines[i] += " " + cell_text(means[i], rank[i], column.factor) + " |";
  }
  return fmt::format("{}\n{}\n{}\n", header, rule, fmt::join(lines, "\n"));
}

void write_csv(const std::filesystem::path& path, std::span<const ResultRow> rows) {
  std::set<std::string> keys;
  for (const ResultRow& row : rows)
    for (const auto& [key, value] : row.values) keys.insert(key);
  write_file_atomically(path, [&](std::ostream& out) {
    out << fmt::format("group,world,seed,poses,cell_size_m,method,{}\n", fmt::join(keys, ","));
    for (const ResultRow& row : rows) {
      out << fmt::format("{},{},{},{},{},{}", in_csv(row.of.group), in_csv(row.of.world),
                         row.of.seed,
                         names_of(row.of.poses)[static_cast<std::size_t>(row.of.poses)],
                         row.of.cell_size_m, in_csv(row.of.method));
      for (const std::string& key : keys) {
        const auto found = row.values.find(key);
        out << (found == row.values.end() ? std::string(",") : fmt::format(",{}", found->second));
      }
      out << "\n";
    }
  });
}

void write_rows(const std::filesystem::path& path, const std::string& key,
                std::span<const ResultRow> rows) {
  nlohmann::json json{{"key", key}, {"rows", nlohmann::json::array()}};
  for (const ResultRow& row : rows) json["rows"].push_back(to_json(row));
  write_text_atomically(path, json.dump(1) + "\n");
}

std::optional<std::vector<ResultRow>> read_rows(const std::filesystem::path& path,
                                                const std::string& key) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  try {
    const nlohmann::json json = nlohmann::json::parse(read_file(path, kMaxRowsBytes));
    if (json.at("key") != key) return std::nullopt;
    std::vector<ResultRow> rows;
    for (const nlohmann::json& row : json.at("rows")) rows.push_back(row_from_json(row));
    return rows;
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("{}: is damaged; remove it ({})", path.string(), error.what()));
  }
}

}  // namespace stereovox
