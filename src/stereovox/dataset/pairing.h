// Which left image belongs to which right image. An image without a partner is counted and left
// out; a partner is never guessed.
#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <span>
#include <string>
#include <vector>

#include "stereovox/dataset/listing.h"

namespace stereovox {

// The image files directly in a folder (hidden files and other kinds are ignored): first those
// named by a number, in its order, then the rest by name. A folder that is missing has none.
std::vector<std::filesystem::path> images_in(const std::filesystem::path& folder);

// Of the first of them that can be read. Throws what the first one said when none can, or that the
// folder has no images.
cv::Size first_size_of(const std::vector<std::filesystem::path>& images,
                       const std::filesystem::path& folder);

// Pairs images of the same name (without extension). `times_ns` has one stamp for each left image,
// or, when images were lost, for each image of either side or each number from 0 (or 1) on;
// anything else is an Error that names `times_file`. Fills pairs and what info counts and remarks.
struct NamedImages {
  std::filesystem::path left_folder, right_folder, times_file;
};
SequenceListing pair_by_name(const NamedImages& images, double assumed_rate_hz);

// Pairs images, ordered by time, whose stamps differ by at most `max_difference_ns`, each with its
// nearest. Adds to `listing`.
void pair_by_time(std::span<const ListedImage> left, std::span<const ListedImage> right,
                  std::int64_t max_difference_ns, SequenceListing& listing);

// Throws Error when one of the folders holds no images.
void expect_images(const std::vector<std::filesystem::path>& images,
                   const std::filesystem::path& folder, const std::string& side);

// Drops what does not follow in time, and says so.
void drop_backward_images(std::vector<ListedImage>& images, SequenceInfo& info);

}  // namespace stereovox
