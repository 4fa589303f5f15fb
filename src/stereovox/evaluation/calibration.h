// Whether the values of a map mean what they say: of cells with value 0.8, four fifths should be
// occupied. (The paper's credibility state is no probability; these figures show how far it is
// one.)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace stereovox {

struct JudgedCell {
  double value = 0;  // in [0, 1]
  bool is_occupied = false;
};

struct Calibration {
  std::int64_t cells = 0;
  std::optional<double> brier;     // mean squared error
  std::optional<double> log_loss;  // mean of -ln(value given to the truth), clipped at 0.01
  // Chance that an occupied cell has a larger value than a free one, ties counting half; absent
  // unless there are both.
  std::optional<double> auc;
  // Mean |value - share of occupied| over ten bins of equal width, weighted by their cells.
  std::optional<double> expected_error;
};

Calibration score_calibration(const std::vector<JudgedCell>& cells);

}  // namespace stereovox
