// The figures of a map score under their names, once for JSON, text and CSV. A new figure is a row
// of map_score_rows.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "stereovox/evaluation/map_score.h"

namespace stereovox {

enum class Better { higher, lower, neither };

struct ScoreRow {
  std::string key;    // in JSON and CSV
  std::string label;  // for people
  std::string unit;   // "%", "m", "cells", ...; empty for a plain number
  Better better = Better::neither;
  std::function<std::optional<double>(const MapScore&)> value;
};

// Every figure, in the order in which they are shown. Values that a score does not have are absent;
// the rows are the same for every score.
std::span<const ScoreRow> map_score_rows();

// {key: number or null}, and "doors_closed": [names].
nlohmann::json to_json(const MapScore& score);

// A line a figure that the score has: label, value, unit, and whether higher (+) or lower (-) is
// better.
std::string to_text(const MapScore& score);

// The keys, and the values in their order; a missing value is empty.
std::string csv_header();
std::string csv_row(const MapScore& score);

}  // namespace stereovox
