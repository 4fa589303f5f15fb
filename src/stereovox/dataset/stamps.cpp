#include "stereovox/dataset/stamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"
#include "stereovox/io/text_file.h"

namespace stereovox {
namespace {

constexpr std::int64_t kJumpFactor = 10;  // an interval so many times the usual one is a jump
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

std::vector<std::size_t> each_after_the_last_kept(std::span<const std::int64_t> stamps_ns) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i)
    if (kept.empty() || stamps_ns[i] > stamps_ns[kept.back()]) kept.push_back(i);
  return kept;
}

// By patience sorting, in n log n.
std::vector<std::size_t> longest_increasing(std::span<const std::int64_t> stamps_ns) {
  std::vector<std::size_t> smallest_end;  // of the increasing subsequences of each length
  std::vector<std::size_t> before(stamps_ns.size(), kNone);
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    const auto place = std::ranges::lower_bound(smallest_end, stamps_ns[i], {},
                                                [&](std::size_t k) { return stamps_ns[k]; });
    if (place != smallest_end.begin()) before[i] = *std::prev(place);
    if (place == smallest_end.end())
      smallest_end.push_back(i);
    else
      *place = i;
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = smallest_end.empty() ? kNone : smallest_end.back(); i != kNone;
       i = before[i])
    kept.push_back(i);
  std::ranges::reverse(kept);
  return kept;
}

}  // namespace

IncreasingStamps choose_increasing(std::span<const std::int64_t> stamps_ns) {
  IncreasingStamps chosen{each_after_the_last_kept(stamps_ns)};
  std::vector<std::size_t> longest = longest_increasing(stamps_ns);
  if (longest.size() > chosen.kept.size()) chosen.kept = std::move(longest);

  std::vector<std::int64_t> kept_ns;
  for (const std::size_t i : chosen.kept) kept_ns.push_back(stamps_ns[i]);
  std::size_t next_kept = 0;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    if (next_kept < chosen.kept.size() && chosen.kept[next_kept] == i)
      ++next_kept;
    else if (std::ranges::binary_search(kept_ns, stamps_ns[i]))
      ++chosen.duplicates;
    else
      ++chosen.backwards;
  }
  return chosen;
}

std::vector<std::int64_t> evenly_spaced_ns(std::size_t count, double rate_hz) {
  std::vector<std::int64_t> stamps_ns;
  for (std::size_t i = 0; i < count; ++i)
    stamps_ns.push_back(ns_from_seconds(static_cast<double>(i) / rate_hz));
  return stamps_ns;
}

std::vector<std::int64_t> read_times(const std::filesystem::path& path, std::size_t count,
                                     double assumed_rate_hz, std::vector<std::string>& remarks) {
  const std::string name = path.filename().string();
  if (!std::filesystem::exists(path)) {
    remarks.push_back(
        fmt::format("{}: is missing; {} pairs a second are assumed", name, assumed_rate_hz));
    return evenly_spaced_ns(count, assumed_rate_hz);
  }
  std::vector<std::int64_t> stamps_ns;
  for_each_record(path, [&](const TextRecord& record) {
    record.expect_fields(1);
    stamps_ns.push_back(record.stamp_ns(0));
  });
  const bool all_equal =
      std::ranges::adjacent_find(stamps_ns, std::not_equal_to()) == stamps_ns.end();
  if (!all_equal || stamps_ns.size() < 2) return stamps_ns;
  remarks.push_back(fmt::format("{}: all {} times are {} s; {} pairs a second are assumed", name,
                                stamps_ns.size(), seconds_text(stamps_ns[0]), assumed_rate_hz));
  return evenly_spaced_ns(stamps_ns.size(), assumed_rate_hz);
}

std::string remark_on_jumps(std::span<const std::int64_t> stamps_ns) {
  if (stamps_ns.size() < 3) return "";
  std::vector<std::int64_t> intervals_ns;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i)
    intervals_ns.push_back(stamps_ns[i] - stamps_ns[i - 1]);
  std::vector<std::int64_t> sorted_ns = intervals_ns;
  std::ranges::sort(sorted_ns);
  const std::int64_t usual_ns = sorted_ns[sorted_ns.size() / 2];
  const auto is_jump = [=](std::int64_t ns) { return ns / kJumpFactor >= usual_ns; };
  const auto first = std::ranges::find_if(intervals_ns, is_jump);
  if (first == intervals_ns.end()) return "";
  return fmt::format("{} jumps in time, the first of {:.3f} s (usual: {:.3f} s)",
                     std::ranges::count_if(intervals_ns, is_jump), seconds_from_ns(*first),
                     seconds_from_ns(usual_ns));
}

}  // namespace stereovox
