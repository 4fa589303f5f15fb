#include "stereovox/evaluation/cell_classes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stereovox/evaluation/ratio.h"
#include "stereovox/navmap/cell_mask.h"

namespace stereovox {
namespace {

constexpr std::size_t kClasses = 3;

// Cells by their label in the ideal map (first) and in the generated one.
struct Confusion {
  std::array<std::array<std::int64_t, kClasses>, kClasses> cells = {};

  std::int64_t at(CellLabel ideal, CellLabel generated) const {
    return cells[static_cast<std::size_t>(ideal)][static_cast<std::size_t>(generated)];
  }
  std::int64_t ideal_total(std::size_t label) const {
    return cells[label][0] + cells[label][1] + cells[label][2];
  }
  std::int64_t generated_total(std::size_t label) const {
    return cells[0][label] + cells[1][label] + cells[2][label];
  }
};

Confusion confusion_of(const OccupancyGrid2D& ideal, const OccupancyGrid2D& generated) {
  Confusion confusion;
  for (std::size_t i = 0; i < ideal.labels.size(); ++i)
    ++confusion.cells[static_cast<std::size_t>(ideal.labels[i])]
                     [static_cast<std::size_t>(generated.labels[i])];
  return confusion;
}

CellMask grown_by_one(const CellMask& mask) {
  CellMask grown = empty_mask(mask.geometry);
  for (int i = 0; i < cell_count(mask.geometry); ++i) {
    const Eigen::Vector2i cell = cell_in(mask.geometry, i);
    bool is_near = false;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        is_near = is_near || mask.contains(cell + Eigen::Vector2i(dx, dy));
    grown.set(i, is_near);
  }
  return grown;
}

std::int64_t common_cells(const CellMask& a, const CellMask& b) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.cells.size(); ++i) count += a.cells[i] & b.cells[i];
  return count;
}

void score_positives(CellClasses& c) {
  c.precision = ratio(c.true_positive, c.true_positive + c.false_positive);
  c.recall = ratio(c.true_positive, c.true_positive + c.false_negative);
  c.f1 = ratio(2 * c.true_positive, 2 * c.true_positive + c.false_positive + c.false_negative);
  c.iou_occupied = ratio(c.true_positive, c.true_positive + c.false_positive + c.false_negative);
}

// Cohen's kappa and Matthews' correlation coefficient: agreement beyond that of chance.
void score_agreement(CellClasses& c) {
  const auto tp = static_cast<double>(c.true_positive), fp = static_cast<double>(c.false_positive);
  const auto fn = static_cast<double>(c.false_negative), tn = static_cast<double>(c.true_negative);
  const double n = tp + fp + fn + tn;
  if (n == 0.0) return;
  const double by_chance = ((tp + fp) * (tp + fn) + (fn + tn) * (fp + tn)) / (n * n);
  if (by_chance < 1.0) c.kappa = ((tp + tn) / n - by_chance) / (1.0 - by_chance);
  const double margins = (tp + fp) * (tp + fn) * (tn + fp) * (tn + fn);
  if (margins > 0.0) c.mcc = (tp * tn - fp * fn) / std::sqrt(margins);
}

void score_with_tolerance(const OccupancyGrid2D& ideal, const OccupancyGrid2D& generated,
                          CellClasses& c) {
  const CellMask truth = cells_labelled(ideal, CellLabel::occupied);
  const CellMask found = cells_labelled(generated, CellLabel::occupied);
  CellMask judged = found;
  for (std::size_t i = 0; i < judged.cells.size(); ++i)
    judged.cells[i] &= ideal.labels[i] != CellLabel::unknown;
  c.tolerant_precision =
      ratio(common_cells(judged, grown_by_one(truth)), c.true_positive + c.false_positive);
  c.tolerant_recall =
      ratio(common_cells(truth, grown_by_one(found)), c.true_positive + c.false_negative);
  c.tolerant_f1 = harmonic_mean(c.tolerant_precision, c.tolerant_recall);
}

std::optional<double> macro_f1(const Confusion& confusion) {
  double sum = 0.0;
  int classes = 0;
  for (std::size_t label = 0; label < kClasses; ++label) {
    const std::int64_t totals = confusion.ideal_total(label) + confusion.generated_total(label);
    if (totals == 0) continue;
    sum += 2.0 * static_cast<double>(confusion.cells[label][label]) / static_cast<double>(totals);
    ++classes;
  }
  return classes == 0 ? std::nullopt : std::optional(sum / classes);
}

}  // namespace

CellClasses score_classes(const OccupancyGrid2D& ideal, const OccupancyGrid2D& generated) {
  using enum CellLabel;
  const Confusion confusion = confusion_of(ideal, generated);
  const auto row = [&](CellLabel label) {
    return confusion.ideal_total(static_cast<std::size_t>(label));
  };
  CellClasses c;
  c.true_positive = confusion.at(occupied, occupied);
  c.false_positive = confusion.at(free, occupied);
  c.false_negative = row(occupied) - c.true_positive;
  c.true_negative = row(free) - c.false_positive;
  score_positives(c);
  score_agreement(c);
  score_with_tolerance(ideal, generated, c);

  const std::int64_t free_in_both = confusion.at(free, free);
  c.iou_free = ratio(free_in_both, row(free) + confusion.at(occupied, free));
  c.macro_f1 = macro_f1(confusion);
  c.false_free_rate = ratio(confusion.at(occupied, free), row(occupied));
  const std::int64_t judged = row(occupied) + row(free);
  c.coverage =
      ratio(judged - confusion.at(occupied, unknown) - confusion.at(free, unknown), judged);
  const auto cells = static_cast<std::int64_t>(generated.labels.size());
  const auto unknowns = confusion.generated_total(static_cast<std::size_t>(unknown));
  c.known_fraction = ratio(cells - unknowns, cells).value_or(0.0);
  c.occupied_outside = confusion.at(unknown, occupied);
  return c;
}

}  // namespace stereovox
