// Scores for programs (JSON) and for people (text tables). What could not be measured, because
// there was nothing to average, is null in JSON and "-" in text, never 0.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "stereovox/evaluation/disparity_score.h"
#include "stereovox/evaluation/trajectory_score.h"

namespace stereovox {

// Keys are the field names; bad-N percentages are keyed "bad_0.5_percent" .. "bad_3_percent".
nlohmann::json to_json(const ErrorStatistics& statistics);
nlohmann::json to_json(const TrajectoryScore& score);
nlohmann::json to_json(const DisparityScore& score);

// Lines of at most 80 columns, each ended by a line feed.
std::string to_text(const TrajectoryScore& score);
std::string to_text(const DisparityScore& score);

}  // namespace stereovox
