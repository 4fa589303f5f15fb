#include "stereovox/evaluation/map_score_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace stereovox {
namespace {

using Value = std::optional<double>;

// A figure of a part of a score.
template <class Part>
struct PartRow {
  const char *key, *label, *unit;
  Better better;
  Value (*value)(const Part&);
};

constexpr auto kHigher = Better::higher, kLower = Better::lower, kNeither = Better::neither;

constexpr PartRow<ValueScore> kValueRows[] = {
    {"correlation", "correlation with T", "", kHigher,
     [](const ValueScore& s) -> Value { return s.correlation.coefficient; }},
    {"correlation_truncated", "the same, truncated as in MapManager", "", kHigher,
     [](const ValueScore& s) -> Value {
       return truncated_to_4_decimals(s.correlation.coefficient);
     }},
    {"correlation_best", "best correlation when shifted", "", kNeither,
     [](const ValueScore& s) -> Value { return s.best_shift.coefficient; }},
    {"shift_x", "shift of that, x", "cells", kNeither,
     [](const ValueScore& s) -> Value { return s.best_shift.shift_cells.x(); }},
    {"shift_y", "shift of that, y", "cells", kNeither,
     [](const ValueScore& s) -> Value { return s.best_shift.shift_cells.y(); }},
    {"map_score_all", "map score, all cells (A.M.Sc)", "%", kLower,
     [](const ValueScore& s) { return s.all.percent(); }},
    {"map_score_all_sum", "raw sum of that", "", kLower,
     [](const ValueScore& s) -> Value { return s.all.sum; }},
    {"map_score_all_cells", "over", "cells", kNeither,
     [](const ValueScore& s) -> Value { return s.all.cells; }},
    {"map_score_occupied", "map score, occupied cells (O.M.Sc)", "%", kLower,
     [](const ValueScore& s) { return s.occupied.percent(); }},
    {"map_score_occupied_sum", "raw sum of that", "", kLower,
     [](const ValueScore& s) -> Value { return s.occupied.sum; }},
    {"map_score_occupied_cells", "over", "cells", kNeither,
     [](const ValueScore& s) -> Value { return s.occupied.cells; }},
    {"match_bits", "Martin-Moravec match", "bits", kHigher,
     [](const ValueScore& s) -> Value { return s.match_bits.sum; }},
    {"match_bits_cells", "over", "cells", kNeither,
     [](const ValueScore& s) -> Value { return s.match_bits.cells; }},
    {"ssim", "SSIM 7x7", "", kHigher, [](const ValueScore& s) { return s.ssim; }},
    {"brier", "Brier score, unknown = 0.5", "", kLower,
     [](const ValueScore& s) { return s.judged.brier; }},
    {"log_loss", "log loss, unknown = 0.5", "nat", kLower,
     [](const ValueScore& s) { return s.judged.log_loss; }},
    {"brier_known", "Brier score of known cells", "", kLower,
     [](const ValueScore& s) { return s.known.brier; }},
    {"log_loss_known", "log loss of known cells", "nat", kLower,
     [](const ValueScore& s) { return s.known.log_loss; }},
    {"auc_known", "AUC of known cells", "", kHigher,
     [](const ValueScore& s) { return s.known.auc; }},
    {"ece_known", "calibration error of known cells", "", kLower,
     [](const ValueScore& s) { return s.known.expected_error; }},
};

constexpr PartRow<CellClasses> kClassRows[] = {
    {"true_positives", "occupied and found", "cells", kHigher,
     [](const CellClasses& c) -> Value { return c.true_positive; }},
    {"false_positives", "free but called occupied", "cells", kLower,
     [](const CellClasses& c) -> Value { return c.false_positive; }},
    {"false_negatives", "occupied but not found", "cells", kLower,
     [](const CellClasses& c) -> Value { return c.false_negative; }},
    {"true_negatives", "free and not called occupied", "cells", kHigher,
     [](const CellClasses& c) -> Value { return c.true_negative; }},
    {"occupied_outside", "occupied where N is unknown", "cells", kNeither,
     [](const CellClasses& c) -> Value { return c.occupied_outside; }},
    {"precision", "precision of occupied", "", kHigher,
     [](const CellClasses& c) { return c.precision; }},
    {"recall", "recall of occupied", "", kHigher, [](const CellClasses& c) { return c.recall; }},
    {"f1", "F1 of occupied", "", kHigher, [](const CellClasses& c) { return c.f1; }},
    {"precision_1", "precision within 1 cell", "", kHigher,
     [](const CellClasses& c) { return c.tolerant_precision; }},
    {"recall_1", "recall within 1 cell", "", kHigher,
     [](const CellClasses& c) { return c.tolerant_recall; }},
    {"f1_1", "F1 within 1 cell", "", kHigher, [](const CellClasses& c) { return c.tolerant_f1; }},
    {"iou_occupied", "IoU of occupied", "", kHigher,
     [](const CellClasses& c) { return c.iou_occupied; }},
    {"iou_free", "IoU of free", "", kHigher, [](const CellClasses& c) { return c.iou_free; }},
    {"macro_f1", "F1, mean of three classes", "", kHigher,
     [](const CellClasses& c) { return c.macro_f1; }},
    {"kappa", "Cohen's kappa", "", kHigher, [](const CellClasses& c) { return c.kappa; }},
    {"mcc", "Matthews correlation", "", kHigher, [](const CellClasses& c) { return c.mcc; }},
    {"false_free_rate", "called free, of occupied cells", "", kLower,
     [](const CellClasses& c) { return c.false_free_rate; }},
    {"coverage", "known, of cells where N is known", "", kHigher,
     [](const CellClasses& c) { return c.coverage; }},
    {"known_fraction", "known, of all cells", "", kNeither,
     [](const CellClasses& c) -> Value { return c.known_fraction; }},
};

constexpr PartRow<ObstacleDistance> kDistanceRows[] = {
    {"ne_to_generated_m", "true obstacles to nearest found", "m", kLower,
     [](const ObstacleDistance& d) { return d.to_generated_m; }},
    {"ne_to_ideal_m", "found obstacles to nearest true", "m", kLower,
     [](const ObstacleDistance& d) { return d.to_ideal_m; }},
    {"chamfer_m", "chamfer (sum of both)", "m", kLower,
     [](const ObstacleDistance& d) { return d.chamfer_m; }},
    {"hausdorff95_m", "Hausdorff 95 %", "m", kLower,
     [](const ObstacleDistance& d) { return d.hausdorff95_m; }},
};

constexpr PartRow<PathCounts> kPathRows[] = {
    {"fp_percent", "paths that hit obstacles (F.Pos)", "%", kLower,
     [](const PathCounts& p) { return p.false_positive_percent(); }},
    {"fp", "number of them", "paths", kLower,
     [](const PathCounts& p) -> Value { return p.false_positives; }},
    {"generated", "of paths in the map", "paths", kHigher,
     [](const PathCounts& p) -> Value { return p.generated_pairs; }},
    {"fn_percent", "paths that are missing (F.Neg)", "%", kLower,
     [](const PathCounts& p) { return p.false_negative_percent(); }},
    {"fn", "number of them", "paths", kLower,
     [](const PathCounts& p) -> Value { return p.false_negatives; }},
    {"ideal", "of paths in the ideal map", "paths", kNeither,
     [](const PathCounts& p) -> Value { return p.ideal_pairs; }},
    {"fn_strict_percent", "ideal paths that the map blocks", "%", kLower,
     [](const PathCounts& p) { return p.strict_false_negative_percent(); }},
    {"fn_strict", "number of them", "paths", kLower,
     [](const PathCounts& p) -> Value { return p.strict_false_negatives; }},
    {"length_ratio", "length against ideal paths", "", kNeither,
     [](const PathCounts& p) { return p.length_ratio(); }},
};

constexpr PartRow<VoronoiScore> kVoronoiRows[] = {
    {"voronoi_fp_percent", "Voronoi paths that hit obstacles", "%", kLower,
     [](const VoronoiScore& v) { return v.false_positive.invalid_percent(); }},
    {"voronoi_fp", "number of them", "paths", kLower,
     [](const VoronoiScore& v) -> Value { return v.false_positive.invalid; }},
    {"voronoi_generated", "of paths in the map", "paths", kNeither,
     [](const VoronoiScore& v) -> Value { return v.false_positive.paths; }},
    {"voronoi_fn_percent", "ideal Voronoi paths that the map blocks", "%", kLower,
     [](const VoronoiScore& v) { return v.false_negative.invalid_percent(); }},
    {"voronoi_fn", "number of them", "paths", kLower,
     [](const VoronoiScore& v) -> Value { return v.false_negative.invalid; }},
    {"voronoi_ideal", "of paths in the ideal map", "paths", kNeither,
     [](const VoronoiScore& v) -> Value { return v.false_negative.paths; }},
};

constexpr PartRow<MapScore> kWholeRows[] = {
    {"free_components", "pieces of free space", "", kNeither,
     [](const MapScore& s) -> Value { return s.free_space.components; }},
    {"free_components_ideal", "in the ideal map", "", kNeither,
     [](const MapScore& s) -> Value { return s.ideal_free_space.components; }},
    {"euler_number", "Euler number of free space", "", kNeither,
     [](const MapScore& s) -> Value { return s.free_space.euler_number; }},
    {"euler_number_ideal", "in the ideal map", "", kNeither,
     [](const MapScore& s) -> Value { return s.ideal_free_space.euler_number; }},
    {"doors_open", "doors open", "", kHigher,
     [](const MapScore& s) { return s.doors ? Value(s.doors->open_doors) : Value(); }},
    {"doors", "of doors", "", kNeither,
     [](const MapScore& s) { return s.doors ? Value(s.doors->doors) : Value(); }},
};

// Lists the rows of a part of the score; `part_of` gives the part, or nullptr when there is none.
template <class Part, std::size_t N, class PartOf>
void append(const PartRow<Part> (&table)[N], const std::string& prefix, const std::string& remark,
            const PartOf& part_of, std::vector<ScoreRow>& rows) {
  for (const PartRow<Part>& row : table)
    rows.push_back({prefix + row.key, row.label + remark, row.unit, row.better,
                    [value = row.value, part_of](const MapScore& score) -> Value {
                      const Part* part = part_of(score);
                      return part == nullptr ? Value() : value(*part);
                    }});
}

template <class CellsOf>
void append_cells(const std::string& prefix, const std::string& remark, const CellsOf& cells_of,
                  std::vector<ScoreRow>& rows) {
  const auto part = [cells_of](auto member) {
    return [cells_of, member](const MapScore& score) {
      const CellScore* cells = cells_of(score);
      return cells == nullptr ? nullptr : &(cells->*member);
    };
  };
  append(kValueRows, prefix + "ternary_", remark + ", ternary", part(&CellScore::ternary), rows);
  append(kValueRows, prefix + "graded_", remark + ", graded", part(&CellScore::graded), rows);
  append(kClassRows, prefix, remark, part(&CellScore::classes), rows);
  append(kDistanceRows, prefix, remark, part(&CellScore::obstacles), rows);
}

std::vector<ScoreRow> all_rows() {
  std::vector<ScoreRow> rows;
  append_cells(
      "", "", [](const MapScore& s) { return &s.cells; }, rows);
  append(
      kPathRows, "paths_", "", [](const MapScore& s) { return &s.paths.unknown_blocked; }, rows);
  append(
      kPathRows, "paths_unknown_free_", ", unknown free",
      [](const MapScore& s) { return &s.paths.unknown_free; }, rows);
  append(
      kVoronoiRows, "", "", [](const MapScore& s) { return &s.voronoi; }, rows);
  append(
      kWholeRows, "", "", [](const MapScore& s) { return &s; }, rows);
  append_cells(
      "visible_", " (in view)",
      [](const MapScore& s) { return s.visible_cells ? &*s.visible_cells : nullptr; }, rows);
  return rows;
}

const char* sign_of(Better better) {
  return better == kHigher ? "+" : better == kLower ? "-" : " ";
}

}  // namespace

std::span<const ScoreRow> map_score_rows() {
  static const std::vector<ScoreRow> rows = all_rows();
  return rows;
}

nlohmann::json to_json(const MapScore& score) {
  nlohmann::json json;
  for (const ScoreRow& row : map_score_rows()) {
    const Value value = row.value(score);
    json[row.key] = value ? nlohmann::json(*value) : nlohmann::json(nullptr);
  }
  json["doors_closed"] = score.doors ? score.doors->closed : std::vector<std::string>{};
  json["doors_unseen"] = score.doors ? score.doors->unseen : std::vector<std::string>{};
  return json;
}

std::string to_text(const MapScore& score) {
  std::string text = fmt::format("{} x {} cells of {:g} m; + higher is better, - lower is better\n",
                                 score.region.width, score.region.height, score.region.cell_size_m);
  for (const ScoreRow& row : map_score_rows())
    if (const Value value = row.value(score))
      text +=
          fmt::format("{} {:<52}{:>12.6g} {}\n", sign_of(row.better), row.label, *value, row.unit);
  if (score.doors)
    for (const std::string& name : score.doors->closed) {
      const bool is_unseen =
          std::ranges::find(score.doors->unseen, name) != score.doors->unseen.end();
      text += (is_unseen ? "  door that was not seen: " : "  closed door: ") + name + "\n";
    }
  return text;
}

std::string csv_header() {
  std::string text;
  for (const ScoreRow& row : map_score_rows()) text += (text.empty() ? "" : ",") + row.key;
  return text + "\n";
}

std::string csv_row(const MapScore& score) {
  std::string text;
  for (const ScoreRow& row : map_score_rows()) {
    const Value value = row.value(score);
    text += (value ? fmt::format("{}", *value) : "") + ",";
  }
  text.back() = '\n';
  return text;
}

}  // namespace stereovox
