// Bayes' rule for a voxel that is either occupied or free, on probabilities: adding log(p / (1 -
// p)) to a voxel's log-odds is one division here and takes no logarithm. A voxel keeps its
// probability as a float; between the default limits that changes its log-odds by less than 3e-6 an
// update.
#pragma once

#include <algorithm>

#include "stereovox/core/parameters.h"

namespace stereovox {

// P(occupied) after evidence that alone, from 0.5, would give `evidence`. Both in (0, 1).
inline double bayes(double prior, double evidence) {
  const double occupied = prior * evidence;
  return occupied / (occupied + (1.0 - prior) * (1.0 - evidence));
}

// How sure a voxel may become, which bounds how long it takes to change its mind. The defaults are
// OctoMap's: log-odds of -2 and 3.5 (method.md E.1).
struct ProbabilityLimits {
  double min_probability = 0.1192;
  double max_probability = 0.971;

  void describe(ParameterList& list) {
    list("min_probability", min_probability, {0.001, 0.5}, "no voxel is believed freer than this");
    list("max_probability", max_probability, {0.5, 0.999}, "nor more occupied than this");
  }
  double clamp(double probability) const {
    return std::clamp(probability, min_probability, max_probability);
  }
};

}  // namespace stereovox
