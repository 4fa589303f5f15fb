// What a run shows while it works: one changing line on a terminal, a line every ten seconds in a
// log, or a JSON object a frame for programs.
#pragma once

#include <chrono>
#include <string>

#include "stereovox/pipeline/build_maps.h"

namespace stereovox {

enum class DisplayMode { quiet, automatic, verbose, json };

class RunDisplay {
 public:
  explicit RunDisplay(DisplayMode mode);

  void frame_done(const Progress& progress);
  void warn(const std::string& text);
  void end();  // closes the changing line

 private:
  bool is_due(const Progress& progress);

  DisplayMode mode_;
  bool is_terminal_;
  bool was_tracked_ = true;
  std::size_t line_length_ = 0;
  std::chrono::steady_clock::time_point last_shown_;
};

}  // namespace stereovox
