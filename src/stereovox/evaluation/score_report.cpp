#include "stereovox/evaluation/score_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace stereovox {
namespace {

nlohmann::json to_json(const SegmentScore& score) {
  if (score.segments == 0) return nullptr;
  nlohmann::json json = {{"segments", score.segments},
                         {"t_rel_percent", score.t_rel_percent},
                         {"r_rel_deg_per_m", score.r_rel_deg_per_m}};
  if (score.length_m > 0.0) json["length_m"] = score.length_m;
  return json;
}

nlohmann::json to_json(const BadPixels& bad) {
  nlohmann::json json = {{"d1_percent", bad.d1_percent}};
  for (std::size_t i = 0; i < kBadThresholds_px.size(); ++i)
    json[fmt::format("bad_{:g}_percent", kBadThresholds_px[i])] = bad.bad_percent[i];
  return json;
}

std::string line(const std::string& name, const ErrorStatistics& s) {
  if (s.count == 0) return fmt::format("{:<22}{:>9}\n", name, "-");
  return fmt::format("{:<22}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}{:>9}\n", name, s.rmse, s.mean,
                     s.median, s.std, s.max, s.count);
}

std::string line(const std::string& name, const SegmentScore& s) {
  if (s.segments == 0) return fmt::format("{:<22}{:>9}{:>14}{:>9}\n", name, "-", "-", 0);
  return fmt::format("{:<22}{:>9.3f}{:>14.5f}{:>9}\n", name, s.t_rel_percent, s.r_rel_deg_per_m,
                     s.segments);
}

std::string line(const std::string& name, const BadPixels& b) {
  std::string text = fmt::format("{:<22}", name);
  for (const double percent : b.bad_percent) text += fmt::format("{:>9.2f}", percent);
  return text + fmt::format("{:>9.2f}\n", b.d1_percent);
}

}  // namespace

nlohmann::json to_json(const ErrorStatistics& s) {
  if (s.count == 0) return nullptr;
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"sse", s.sse},       {"count", s.count}};
}

nlohmann::json to_json(const TrajectoryScore& score) {
  nlohmann::json segments = nlohmann::json::array();
  for (const SegmentScore& segment : score.segments)
    if (segment.segments > 0) segments.push_back(to_json(segment));
  return {{"alignment", names_of(Alignment{})[static_cast<std::size_t>(score.alignment)]},
          {"scale", score.scale},
          {"ate_m", to_json(score.ate_m)},
          {"rpe_translation_m", to_json(score.rpe_translation_m)},
          {"rpe_rotation_deg", to_json(score.rpe_rotation_deg)},
          {"segments", segments},
          {"segments_overall", to_json(score.segments_overall)},
          {"path_length_m", score.path_length_m},
          {"end_drift_m", score.end_drift_m},
          {"end_drift_percent",
           score.path_length_m > 0.0 ? nlohmann::json(score.end_drift_percent) : nullptr},
          {"matched", score.matched},
          {"unmatched_truth", score.unmatched_truth},
          {"unmatched_estimate", score.unmatched_estimate}};
}

nlohmann::json to_json(const DisparityScore& score) {
  nlohmann::json json = {{"counted_px", score.counted_px},
                         {"density_percent", score.density_percent},
                         {"missing_is_bad", to_json(score.missing_is_bad)}};
  const bool has_estimates = score.density_percent > 0.0;
  const auto if_any = [&](const nlohmann::json& value) { return has_estimates ? value : nullptr; };
  json["valid_only"] = if_any(to_json(score.valid_only));
  json["mae_px"] = if_any(score.mae_px);
  json["rms_px"] = if_any(score.rms_px);
  json["bias_px"] = if_any(score.bias_px);
  return json;
}

std::string to_text(const TrajectoryScore& score) {
  std::string text =
      fmt::format("{} poses matched; without partner: {} of the truth, {} of the estimate\n",
                  score.matched, score.unmatched_truth, score.unmatched_estimate);
  text += fmt::format("{:<22}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "", "rmse", "mean", "median", "std",
                      "max", "count");
  text += line(
      fmt::format("ATE ({}) m", names_of(Alignment{})[static_cast<std::size_t>(score.alignment)]),
      score.ate_m);
  text += line("RPE translation m", score.rpe_translation_m);
  text += line("RPE rotation deg", score.rpe_rotation_deg);
  text += fmt::format("{:<22}{:>9}{:>14}{:>9}\n", "segments", "t_rel %", "r_rel deg/m", "count");
  for (const SegmentScore& segment : score.segments)
    text += line(fmt::format("  {:g} m", segment.length_m), segment);
  text += line("  all lengths", score.segments_overall);
  text += fmt::format("end drift {:.3f} m", score.end_drift_m);
  if (score.path_length_m > 0.0) text += fmt::format(" = {:.2f} %", score.end_drift_percent);
  return text + fmt::format(" of {:.2f} m\n", score.path_length_m);
}

std::string to_text(const DisparityScore& score) {
  std::string text = fmt::format("{} pixels counted, {:.2f} % of them with a disparity\n",
                                 score.counted_px, score.density_percent);
  text += fmt::format("{:<22}", "wrong pixels %");
  for (const double threshold_px : kBadThresholds_px)
    text += fmt::format("{:>9}", fmt::format("bad-{:g}", threshold_px));
  text += fmt::format("{:>9}\n", "D1");
  text += line("missing counts as bad", score.missing_is_bad);
  if (score.density_percent == 0.0) return text;
  text += line("valid only", score.valid_only);
  return text + fmt::format("error px: mean absolute {:.3f}, rms {:.3f}, bias {:+.3f}\n",
                            score.mae_px, score.rms_px, score.bias_px);
}

}  // namespace stereovox
