// Time stamps of a recording that may repeat, jump or run backwards.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace stereovox {

// Which stamps to keep so that they strictly increase. A stamp that does not come after the last
// kept one is dropped; when that would drop more than necessary (one stamp far in the future), the
// longest increasing subsequence is kept instead.
struct IncreasingStamps {
  std::vector<std::size_t> kept;  // positions
  int duplicates = 0;             // dropped, equal to a kept one
  int backwards = 0;              // dropped for another reason
};
IncreasingStamps choose_increasing(std::span<const std::int64_t> stamps_ns);

// 0, 1, 2, ... at a rate.
std::vector<std::int64_t> evenly_spaced_ns(std::size_t count, double rate_hz);

// The stamps of a file with one time in seconds per line. A missing file gives `count` stamps, one
// with identical times as many as it has, both evenly spaced at the assumed rate and with a remark.
std::vector<std::int64_t> read_times(const std::filesystem::path& path, std::size_t count,
                                     double assumed_rate_hz, std::vector<std::string>& remarks);

// A remark about intervals that are much longer than usual; empty when there are none.
// Stamps increase.
std::string remark_on_jumps(std::span<const std::int64_t> stamps_ns);

}  // namespace stereovox
