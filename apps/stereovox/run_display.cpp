#include "run_display.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command.h"

namespace stereovox {
namespace {

constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr std::chrono::seconds kLogPeriod{10};

double frames_per_second(const Progress& p) {
  return p.elapsed_s > 0.0 ? p.frame / p.elapsed_s : 0.0;
}

std::string time_to_go(const Progress& p) {
  const double rate = frames_per_second(p);
  if (rate <= 0.0) return "?";
  const long seconds = std::lround((p.frames - p.frame) / rate);
  return fmt::format("{}:{:02}", seconds / 60, seconds % 60);
}

std::string line(const Progress& p) {
  if (p.stage == RunStage::mapping)
    return fmt::format("mapped {}/{}  {:.1f} fps  map {:.0f} ms  {} blocks  {} to go", p.frame,
                       p.frames, frames_per_second(p), p.occupancy_ms, p.voxel_blocks,
                       time_to_go(p));
  return fmt::format(
      "frame {}/{}  {:.1f} fps  match {:.0f} ms  odometry {:.0f} ms  map {:.0f} ms  {} inliers  {} "
      " "
      "{} blocks  {} to go",
      p.frame, p.frames, frames_per_second(p), p.match_ms, p.odometry_ms, p.occupancy_ms, p.inliers,
      p.is_tracked ? "TRACKING" : "LOST", p.voxel_blocks, time_to_go(p));
}

std::string json_line(const Progress& p) {
  return nlohmann::ordered_json{{"stage", p.stage == RunStage::tracking ? "tracking" : "mapping"},
                                {"frame", p.frame},
                                {"frames", p.frames},
                                {"fps", frames_per_second(p)},
                                {"match_ms", p.match_ms},
                                {"odometry_ms", p.odometry_ms},
                                {"occupancy_ms", p.occupancy_ms},
                                {"inliers", p.inliers},
                                {"state", p.is_tracked ? "tracking" : "lost"},
                                {"voxel_blocks", p.voxel_blocks},
                                {"elapsed_s", p.elapsed_s}}
      .dump();
}

}  // namespace

RunDisplay::RunDisplay(DisplayMode mode)
    : mode_(mode),
      is_terminal_(isatty(STDOUT_FILENO) == 1),
      last_shown_(std::chrono::steady_clock::now()) {}

void RunDisplay::frame_done(const Progress& progress) {
  if (!is_due(progress)) return;
  if (mode_ == DisplayMode::json) {
    std::cout << json_line(progress) << std::endl;
  } else if (is_terminal_ && mode_ == DisplayMode::automatic) {
    const std::string text = line(progress);
    std::cout << fmt::format("\r{:<{}}", text, line_length_) << std::flush;
    line_length_ = text.size();
  } else {
    std::cout << line(progress) << std::endl;
  }
}

// A change between tracking and lost is always worth a line.
bool RunDisplay::is_due(const Progress& progress) {
  if (mode_ == DisplayMode::quiet) return false;
  if (mode_ != DisplayMode::automatic) return true;
  const bool has_changed = progress.is_tracked != was_tracked_;
  was_tracked_ = progress.is_tracked;
  const auto now = std::chrono::steady_clock::now();
  const auto period = is_terminal_ ? kTerminalPeriod : std::chrono::milliseconds(kLogPeriod);
  if (!has_changed && now - last_shown_ < period) return false;
  last_shown_ = now;
  return true;
}

void RunDisplay::warn(const std::string& text) {
  end();
  stereovox::warn(text);
}

void RunDisplay::end() {
  if (line_length_ > 0) std::cout << "\n";
  line_length_ = 0;
}

}  // namespace stereovox
