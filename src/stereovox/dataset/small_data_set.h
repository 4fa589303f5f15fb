// Data sets of a few small images, for tests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereovox/dataset/stereo_sequence.h"

namespace stereovox {

inline constexpr int kSmallWidth = 32, kSmallHeight = 20;
inline constexpr const char* kSmallCalibration =
    "width: 32\nheight: 20\nfx: 30.0\nfy: 30.0\ncx: 15.5\ncy: 9.5\nbaseline: 0.12\n";

// A grey image whose first pixel is `mark`.
void write_small_image(const std::filesystem::path& path, int mark, int width = kSmallWidth,
                       int height = kSmallHeight);

// left/000000.png ... with marks 0, 1, ..., right/ with marks 100, 101, ..., calib.yaml, times.txt
// at 10 Hz and poses.txt along z at 1 m/s.
void write_small_plain_set(const std::filesystem::path& folder, int pairs);

void write_text(const std::filesystem::path& path, const std::string& text);

// The name of the i-th image: "000017.png".
std::string image_name(int i);

// The first pixels of the left images that a sequence delivers.
std::vector<int> left_marks(StereoSequence& sequence);

// What opening the folder or reading it to its end says; empty when nothing goes wrong.
std::string complaint_about(const std::filesystem::path& folder, const SequenceParams& params = {});

}  // namespace stereovox
