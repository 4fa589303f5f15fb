// Room on disk for disparities that wait to be mapped, in a file without a name.
#pragma once

#include <filesystem>
#include <vector>

#include "stereovox/core/image.h"
#include "stereovox/occupancy/tile_store.h"

namespace stereovox {

// Disparities come back bit by bit, their standard deviations to the next 1/256 px (at most 256
// px), confidences not at all.
class DisparityStore {
 public:
  // Throws ResourceError when the folder cannot hold a file.
  explicit DisparityStore(const std::filesystem::path& folder) : store_(folder, "frame store") {}

  std::size_t size() const { return images_.size(); }
  // Throws ResourceError, for example when the disk is full; nothing is then stored.
  void push_back(const DisparityImage& image);
  // In the order in which they were stored. Throws ResourceError when it cannot be read.
  DisparityImage read(std::size_t index) const;

 private:
  struct StoredImage {
    StoredPlace place;
    cv::Size size;
  };

  TileStore store_;
  std::vector<StoredImage> images_;
};

}  // namespace stereovox
