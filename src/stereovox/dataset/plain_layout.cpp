#include "stereovox/dataset/plain_layout.h"

#include "stereovox/dataset/calibration_file.h"
#include "stereovox/dataset/pairing.h"
#include "stereovox/io/trajectory_file.h"

namespace stereovox {

namespace fs = std::filesystem;

bool is_plain_layout(const fs::path& folder) {
  return fs::is_directory(folder / "left") || fs::is_directory(folder / "right");
}

StereoRig plain_rig(const fs::path& folder) {
  return read_calibration(folder / "calib.yaml", [&] {
    return first_size_of(images_in(folder / "left"), folder / "left");
  });
}

SequenceListing list_plain_layout(const fs::path& folder, const SequenceParams& params) {
  SequenceListing listing = pair_by_name({folder / "left", folder / "right", folder / "times.txt"},
                                         params.assumed_rate_hz);
  if (fs::exists(folder / "poses.txt")) listing.truth = read_tum(folder / "poses.txt");
  return listing;
}

}  // namespace stereovox
