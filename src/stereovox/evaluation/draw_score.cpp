#include "stereovox/evaluation/draw_score.h"

#include "stereovox/evaluation/value_grid.h"
#include "stereovox/navmap/map_canvas.h"

namespace stereovox {
namespace {

// In ascending order of importance, which decides where cells share a pixel.
enum class Outcome : std::uint8_t { beyond, unseen, free, hit, missed, invented, wrongly_free };

struct Legend {
  cv::Vec3b colour;
  const char* text;
};
// Colours that keep apart with the usual colour blindness; by Outcome.
const Legend kLegend[] = {
    {kUnknownColour, "beyond"},      {{232, 226, 214}, "unseen"}, {kFreeColour, "free"},
    {kOccupiedColour, "hit"},        {{0, 159, 230}, "missed"},   {{178, 114, 0}, "invented"},
    {{40, 40, 214}, "wrongly free"},
};

Outcome outcome_of(CellLabel plan, CellLabel ideal, CellLabel found) {
  using enum CellLabel;
  if (found == occupied) return plan == occupied ? Outcome::hit : Outcome::invented;
  if (ideal == occupied) return found == free ? Outcome::wrongly_free : Outcome::missed;
  if (ideal == free) return found == free ? Outcome::free : Outcome::unseen;
  return Outcome::beyond;
}

}  // namespace

cv::Mat3b draw_score(const IdealMap& ideal, const OccupancyGrid2D& generated) {
  const GridGeometry region = union_of(ideal.theoretical.geometry, generated.geometry);
  const IdealMap truth = extended_to(ideal, region);
  const OccupancyGrid2D map = extended_to(generated, region);
  std::vector<std::uint8_t> outcomes(map.labels.size());
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    outcomes[i] = static_cast<std::uint8_t>(
        outcome_of(truth.theoretical.labels[i], truth.normalised.labels[i], map.labels[i]));
  std::vector<cv::Vec3b> colours;
  for (const Legend& entry : kLegend) colours.push_back(entry.colour);

  constexpr int kLegendLines = 2;
  constexpr std::size_t kFirstLine = 4;
  MapCanvas canvas(region, kLegendLines);
  canvas.draw_cells(outcomes, colours);
  canvas.draw_axes();
  for (std::size_t i = 0; i < std::size(kLegend); ++i) {
    const Legend& entry = kLegend[std::size(kLegend) - 1 - i];  // the worst first
    if (i == kFirstLine) canvas.begin_legend_line();
    canvas.add_to_legend(entry.colour, entry.text);
  }
  canvas.draw_scale_bar();
  return canvas.picture();
}

}  // namespace stereovox
