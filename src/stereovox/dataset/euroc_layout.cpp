#include "stereovox/dataset/euroc_layout.h"

#include <fmt/format.h>

#include <map>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"
#include "stereovox/dataset/calibration.h"
#include "stereovox/dataset/pairing.h"
#include "stereovox/io/text_file.h"
#include "stereovox/io/trajectory_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

fs::path root_of(const fs::path& folder) {
  return fs::is_directory(folder / "mav0") ? folder / "mav0" : folder;
}

std::vector<ListedImage> images_by_file_name(const std::vector<fs::path>& files) {
  std::vector<ListedImage> images;
  for (const fs::path& file : files) {
    const std::optional<std::int64_t> stamp_ns = parse_integer(file.stem().string());
    if (!stamp_ns)
      throw Error(fmt::format("{}: its name is not a time in nanoseconds, and there is no data.csv",
                              file.string()));
    images.push_back({*stamp_ns, static_cast<int>(images.size()), file});
  }
  return images;
}

// Only names that exist in the folder are taken, so no entry can point elsewhere.
std::vector<ListedImage> images_by_table(const fs::path& table, const std::vector<fs::path>& files,
                                         SequenceInfo& info) {
  std::map<std::string, fs::path> by_name;
  for (const fs::path& file : files) by_name.emplace(file.filename().string(), file);
  std::vector<ListedImage> images;
  int entries = 0, missing = 0;
  std::string first_missing;
  for_each_record(table, [&](const TextRecord& record) {
    record.expect_fields(2);
    const auto found = by_name.find(std::string(record.fields[1]));
    if (found != by_name.end())
      images.push_back({record.integer(0), entries, found->second});
    else if (++missing == 1)
      first_missing = record.fields[1];
    ++entries;
  });
  if (missing > 0)
    info.remarks.push_back(fmt::format("{}/data.csv: {} images are not there, first: {}",
                                       table.parent_path().filename().string(), missing,
                                       first_missing));
  return images;
}

std::vector<ListedImage> list_camera(const fs::path& camera, const std::string& side,
                                     SequenceInfo& info) {
  const std::vector<fs::path> files = images_in(camera / "data");
  expect_images(files, camera / "data", side);
  std::vector<ListedImage> images = fs::exists(camera / "data.csv")
                                        ? images_by_table(camera / "data.csv", files, info)
                                        : images_by_file_name(files);
  drop_backward_images(images, info);
  return images;
}

// Rows of stamp, position, quaternion (w first) and more, of the body in the world.
Trajectory read_truth(const fs::path& table, const SE3& T_body_left) {
  constexpr std::size_t kNeededFields = 8;
  Trajectory truth;
  for_each_record(table, [&](const TextRecord& record) {
    if (record.fields.size() < kNeededFields) record.expect_fields(kNeededFields);
    const auto n = [&](std::size_t field) { return record.number(field); };
    const Eigen::Quaterniond rotation(n(4), n(5), n(6), n(7));
    const std::int64_t stamp_ns = record.integer(0);
    if (rotation.norm() == 0.0) throw Error(record.place() + ": the quaternion is zero");
    if (!truth.empty() && stamp_ns <= truth.back().stamp_ns)
      throw Error(fmt::format("{}: time {} does not come after {}", record.place(), stamp_ns,
                              truth.back().stamp_ns));
    const SE3 T_world_body{rotation.normalized(), {n(1), n(2), n(3)}};
    truth.push_back({stamp_ns, T_world_body * T_body_left});
  });
  return truth;
}

}  // namespace

bool is_euroc_layout(const fs::path& folder) {
  return fs::is_directory(folder / "mav0") || fs::is_directory(folder / "cam0") ||
         fs::is_directory(folder / "cam1");
}

StereoRig euroc_rig(const fs::path& folder) {
  const fs::path root = root_of(folder);
  return stereo_rig(read_asl_camera(root / "cam0" / "sensor.yaml"),
                    read_asl_camera(root / "cam1" / "sensor.yaml"));
}

SequenceListing list_euroc_layout(const fs::path& folder, const SequenceParams& params) {
  const fs::path root = root_of(folder);
  SequenceListing listing;
  const std::vector<ListedImage> left = list_camera(root / "cam0", "left", listing.info);
  const std::vector<ListedImage> right = list_camera(root / "cam1", "right", listing.info);
  pair_by_time(left, right, ns_from_seconds(params.max_stamp_difference_s), listing);
  if (listing.pairs.empty())
    throw Error(fmt::format("{}: no left and right image are within {} s of each other",
                            root.string(), params.max_stamp_difference_s));
  const fs::path truth = root / "state_groundtruth_estimate0" / "data.csv";
  if (fs::exists(truth)) {
    const AslCamera left_camera = read_asl_camera(root / "cam0" / "sensor.yaml");
    listing.truth = read_truth(truth, left_camera.T_body_camera);
  }
  return listing;
}

}  // namespace stereovox
