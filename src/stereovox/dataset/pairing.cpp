#include "stereovox/dataset/pairing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <ranges>
#include <set>
#include <tuple>

#include "stereovox/core/error.h"
#include "stereovox/dataset/stamps.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/text_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

// "left/000017.png": enough for the user, who knows which sequence it is.
std::string short_name(const fs::path& path) {
  return (path.parent_path().filename() / path.filename()).string();
}

std::optional<std::int64_t> number_of(const fs::path& image) {
  const std::string stem = image.stem().string();
  const bool is_number = stem.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? parse_integer(stem) : std::nullopt;
}

void drop_repeated_names(Paths& images, std::vector<std::string>& remarks) {
  std::set<std::string> seen;
  std::erase_if(images, [&](const fs::path& image) {
    const bool is_new = seen.insert(image.stem().string()).second;
    if (!is_new) remarks.push_back(short_name(image) + ": ignored, another image has this name");
    return !is_new;
  });
}

// How often neighbours are farther apart than usual, as when numbers are missing.
int count_gaps(std::span<const std::int64_t> increasing) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < increasing.size(); ++i)
    steps.push_back(increasing[i] - increasing[i - 1]);
  if (steps.empty()) return 0;
  std::vector<std::int64_t> sorted = steps;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const std::int64_t usual = sorted[sorted.size() / 2];
  return static_cast<int>(
      std::ranges::count_if(steps, [=](std::int64_t step) { return step - usual > usual / 2; }));
}

void count_numbering_gaps(const Paths& lefts, SequenceInfo& info) {
  std::vector<std::int64_t> numbers;
  for (const fs::path& left : lefts)
    if (const std::optional<std::int64_t> number = number_of(left)) numbers.push_back(*number);
  info.gaps = count_gaps(numbers);
  if (info.gaps > 0)
    info.remarks.push_back(
        fmt::format("the numbering of the left images skips at {} places", info.gaps));
}

void remark_on_partners(const std::string& first_left, const std::string& first_right,
                        SequenceInfo& info) {
  if (info.left_only > 0)
    info.remarks.push_back(
        fmt::format("{} left images have no right image, first: {}", info.left_only, first_left));
  if (info.right_only > 0)
    info.remarks.push_back(
        fmt::format("{} right images have no left image, first: {}", info.right_only, first_right));
}

// Position in the table of times of each left image whose name is a number, counted from 0 or 1.
std::vector<std::size_t> lines_by_number(const Paths& lefts, std::size_t lines) {
  std::vector<std::size_t> found;
  if (!number_of(lefts.back())) return {};
  const std::int64_t first = *number_of(lefts.back()) < static_cast<std::int64_t>(lines) ? 0 : 1;
  for (const fs::path& left : lefts) {
    const std::int64_t line = number_of(left).value_or(-1) - first;
    if (line < 0 || line >= static_cast<std::int64_t>(lines)) return {};
    found.push_back(static_cast<std::size_t>(line));
  }
  return found;
}

std::vector<std::size_t> lines_by_order(const Paths& lefts, const Paths& all) {
  std::vector<std::size_t> found;
  std::size_t line = 0;
  for (const fs::path& left : lefts) {
    while (all[line].stem() != left.stem()) ++line;
    found.push_back(line);
  }
  return found;
}

std::vector<std::size_t> lines_of(const Paths& lefts, const Paths& all, std::size_t lines,
                                  const fs::path& times_file) {
  if (lines == lefts.size()) return lines_by_order(lefts, lefts);
  if (lines == all.size()) return lines_by_order(lefts, all);
  std::vector<std::size_t> found = lines_by_number(lefts, lines);
  if (found.empty())
    throw Error(fmt::format("{}: has {} times for {} left images", times_file.string(), lines,
                            lefts.size()));
  return found;
}

void sort_by_name(Paths& images) {
  using Key = std::tuple<bool, std::int64_t, std::string>;
  std::ranges::sort(images, {}, [](const fs::path& image) {
    const std::optional<std::int64_t> number = number_of(image);
    return Key(!number, number.value_or(0), image.filename().string());
  });
}

// One image of each name that occurs on either side.
Paths union_of(const Paths& lefts, const Paths& rights) {
  std::map<std::string, fs::path> by_name;
  for (const Paths* side : {&lefts, &rights})
    for (const fs::path& image : *side) by_name.emplace(image.stem().string(), image);
  Paths all;
  for (const auto& [name, image] : by_name) all.push_back(image);
  sort_by_name(all);
  return all;
}

template <class Timed>
void drop_backward(std::vector<Timed>& entries, SequenceInfo& info,
                   const std::function<std::string(const Timed&)>& name) {
  std::vector<std::int64_t> stamps_ns;
  stamps_ns.reserve(entries.size());
  for (const Timed& entry : entries) stamps_ns.push_back(entry.stamp_ns);
  const IncreasingStamps increasing = choose_increasing(stamps_ns);
  if (increasing.kept.size() == entries.size()) return;

  std::vector<Timed> kept;
  for (const std::size_t i : increasing.kept) kept.push_back(std::move(entries[i]));
  std::size_t first = 0;  // that is left out
  while (first < increasing.kept.size() && increasing.kept[first] == first) ++first;
  const std::string first_name = name(entries[first]);
  info.duplicates += increasing.duplicates;
  if (increasing.duplicates > 0)
    info.remarks.push_back(
        fmt::format("{} images have the time of another and are left out", increasing.duplicates));
  if (increasing.backwards > 0)
    info.remarks.push_back(fmt::format("{} images go back in time and are left out, first: {}",
                                       increasing.backwards, first_name));
  entries = std::move(kept);
}

void expect_pairs(const std::vector<ListedPair>& pairs, const Paths& lefts, const Paths& rights) {
  if (!pairs.empty()) return;
  throw Error(fmt::format("{}: no image has a partner of the same name in {} (first: {} and {})",
                          lefts.front().parent_path().string(),
                          rights.front().parent_path().string(), lefts.front().filename().string(),
                          rights.front().filename().string()));
}

}  // namespace

Paths images_in(const fs::path& folder) {
  Paths images;
  std::error_code missing, broken_link;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing)) {
    const bool is_hidden = entry.path().filename().string().starts_with('.');
    if (!is_hidden && has_image_name(entry.path()) && !entry.is_directory(broken_link))
      images.push_back(entry.path());
  }
  sort_by_name(images);
  return images;
}

cv::Size first_size_of(const Paths& images, const fs::path& folder) {
  std::string first_reason = folder.string() + ": no left images";
  for (const fs::path& image : images) try {
      return read_image_size(image);
    } catch (const Error& error) {
      if (image == images.front()) first_reason = error.what();
    }
  throw Error(first_reason);
}

void expect_images(const Paths& images, const fs::path& folder, const std::string& side) {
  if (images.empty())
    throw Error(fmt::format("{}: no {} images (PNG, PGM, JPEG, BMP, TIFF)", folder.string(), side));
}

SequenceListing pair_by_name(const NamedImages& images, double assumed_rate_hz) {
  SequenceListing listing;
  SequenceInfo& info = listing.info;
  Paths lefts = images_in(images.left_folder), rights = images_in(images.right_folder);
  expect_images(lefts, images.left_folder, "left");
  expect_images(rights, images.right_folder, "right");
  drop_repeated_names(lefts, info.remarks);
  drop_repeated_names(rights, info.remarks);
  const std::vector<std::int64_t> times_ns =
      read_times(images.times_file, lefts.size(), assumed_rate_hz, info.remarks);
  const std::vector<std::size_t> lines =
      lines_of(lefts, union_of(lefts, rights), times_ns.size(), images.times_file);

  std::map<std::string, fs::path> unpaired_rights;
  for (const fs::path& right : rights) unpaired_rights.emplace(right.stem().string(), right);
  std::string first_lone_left;
  for (std::size_t i = 0; i < lefts.size(); ++i) {
    const auto right = unpaired_rights.extract(lefts[i].stem().string());
    if (right)
      listing.pairs.push_back(
          {times_ns[lines[i]], static_cast<int>(lines[i]), lefts[i], right.mapped()});
    else if (++info.left_only == 1)
      first_lone_left = short_name(lefts[i]);
  }
  info.right_only = static_cast<int>(unpaired_rights.size());
  remark_on_partners(first_lone_left,
                     unpaired_rights.empty() ? "" : short_name(unpaired_rights.begin()->second),
                     info);
  expect_pairs(listing.pairs, lefts, rights);
  count_numbering_gaps(lefts, info);
  drop_backward<ListedPair>(listing.pairs, info,
                            [](const ListedPair& pair) { return short_name(pair.left); });
  return listing;
}

void pair_by_time(std::span<const ListedImage> left, std::span<const ListedImage> right,
                  std::int64_t max_difference_ns, SequenceListing& listing) {
  const auto apart_ns = [&](std::size_t i, std::size_t j) {
    return i < left.size() && j < right.size() ? std::abs(left[i].stamp_ns - right[j].stamp_ns)
                                               : INT64_MAX;
  };
  std::string first_left, first_right;
  const auto lone_left = [&](std::size_t i) {
    if (++listing.info.left_only == 1) first_left = left[i].path.filename().string();
  };
  const auto lone_right = [&](std::size_t j) {
    if (++listing.info.right_only == 1) first_right = right[j].path.filename().string();
  };
  std::size_t i = 0, j = 0;
  while (i < left.size() && j < right.size()) {
    const std::int64_t here_ns = apart_ns(i, j);
    const bool left_is_earlier = left[i].stamp_ns < right[j].stamp_ns;
    // Too far apart, or the later one has a nearer partner to come: the earlier one stays alone.
    if (here_ns <= max_difference_ns && apart_ns(i + 1, j) >= here_ns &&
        apart_ns(i, j + 1) >= here_ns) {
      listing.pairs.push_back({left[i].stamp_ns, left[i].index, left[i].path, right[j].path});
      ++i, ++j;
    } else if (left_is_earlier) {
      lone_left(i++);
    } else {
      lone_right(j++);
    }
  }
  for (; i < left.size(); ++i) lone_left(i);
  for (; j < right.size(); ++j) lone_right(j);
  remark_on_partners(first_left, first_right, listing.info);

  std::vector<std::int64_t> stamps_ns;
  for (const ListedImage& image : left) stamps_ns.push_back(image.stamp_ns);
  listing.info.gaps = count_gaps(stamps_ns);
}

void drop_backward_images(std::vector<ListedImage>& images, SequenceInfo& info) {
  drop_backward<ListedImage>(images, info,
                             [](const ListedImage& image) { return short_name(image.path); });
}

}  // namespace stereovox
