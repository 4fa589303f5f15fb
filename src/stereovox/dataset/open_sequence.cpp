#include "stereovox/dataset/open_sequence.h"

#include <fmt/format.h>

#include <vector>

#include "stereovox/core/error.h"
#include "stereovox/dataset/calibration_file.h"
#include "stereovox/dataset/euroc_layout.h"
#include "stereovox/dataset/folder_sequence.h"
#include "stereovox/dataset/kitti_layout.h"
#include "stereovox/dataset/pairing.h"
#include "stereovox/dataset/plain_layout.h"
#include "stereovox/io/file_kind.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

struct Layout {
  const char* name;
  const char* looks_for;
  bool (*matches)(const fs::path& folder);
  SequenceListing (*list)(const fs::path& folder, const SequenceParams& params);
  StereoRig (*rig)(const fs::path& folder);
  const char* calibration;  // where its rig comes from, for messages
};

constexpr Layout kLayouts[] = {
    {"plain", "left/ and right/", is_plain_layout, list_plain_layout, plain_rig, "calib.yaml"},
    {"KITTI odometry", "image_0/ and image_1/ or image_2/ and image_3/", is_kitti_layout,
     list_kitti_layout, kitti_rig, "calib.txt"},
    {"EuRoC/ASL", "mav0/ or cam0/ and cam1/", is_euroc_layout, list_euroc_layout, euroc_rig,
     "sensor.yaml of cam0 and cam1"},
};

const Layout& layout_of(const fs::path& source) {
  if (!fs::exists(source)) throw Error(source.string() + ": no such folder");
  if (!fs::is_directory(source)) {
    const std::string kind = kind_of_file(source);
    throw Error(fmt::format("{}: is {}, a folder of images is needed", source.string(),
                            kind.empty() ? "a file" : kind));
  }
  std::vector<std::string> looked_for;
  for (const Layout& layout : kLayouts) {
    if (layout.matches(source)) return layout;
    looked_for.push_back(fmt::format("{} ({})", layout.looks_for, layout.name));
  }
  throw Error(fmt::format("{}: is not a stereo sequence; looked for {}", source.string(),
                          fmt::join(looked_for, ", ")));
}

std::unique_ptr<StereoSequence> open_folder(const fs::path& source, const SequenceParams& params,
                                            const std::optional<fs::path>& calibration) {
  const Layout& layout = layout_of(source);
  SequenceListing listing = layout.list(source, params);
  listing.info.layout = layout.name;
  listing.info.path = source;
  const auto image_size = [&] {
    std::vector<fs::path> left;
    for (const ListedPair& pair : listing.pairs) left.push_back(pair.left);
    return first_size_of(left, source);
  };
  const StereoRig rig =
      calibration ? read_calibration(*calibration, image_size) : layout.rig(source);
  validate(rig, (calibration ? *calibration : source / layout.calibration).string());
  return make_folder_sequence(std::move(listing), rig, params);
}

}  // namespace

std::unique_ptr<StereoSequence> open_sequence(const fs::path& source, const SequenceParams& params,
                                              const std::optional<fs::path>& calibration) {
  try {
    return open_folder(source, params, calibration);
  } catch (const fs::filesystem_error& error) {  // no permission, links in a circle
    throw Error(
        fmt::format("{}: cannot be opened ({})", error.path1().string(), error.code().message()));
  }
}

}  // namespace stereovox
