// Tables of numbers in plain text: times, poses, lists. Independent of the locale.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace stereovox {

// One line that holds something. Its accessors throw Error "<path>:<line>: ..." for what does not
// fit; fields count from 0 here and from 1 in messages.
struct TextRecord {
  std::string_view path;
  int line = 0;  // counts from 1
  std::span<const std::string_view> fields;

  std::string place() const;                       // "<path>:<line>"
  void expect_fields(std::size_t count) const;     // exactly so many
  double number(std::size_t field) const;          // finite
  std::int64_t integer(std::size_t field) const;   // 64 bit
  std::int64_t stamp_ns(std::size_t field) const;  // from decimal seconds
};

// Calls `use` for each line of the file that is neither blank nor a comment (`#`). Fields are
// separated by blanks, tabs or commas; CR LF and a byte order mark are accepted. Files over 256 MiB
// are refused.
void for_each_record(const std::filesystem::path& path,
                     const std::function<void(const TextRecord&)>& use);

// The whole text as a number ("1", "-0.5", "1.5e-3", with or without a leading plus), or nothing.
std::optional<double> parse_number(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);

// Nanoseconds of a time in decimal seconds, exact to the nanosecond (later digits are rounded), as
// "1403636584.763555765" or "1.037359e-01"; nothing when it is no number or beyond 64 bits.
std::optional<std::int64_t> parse_seconds_as_ns(std::string_view text);

// A time in seconds with nine decimals, exact.
std::string seconds_text(std::int64_t stamp_ns);

// The text in quotes, shortened and without control characters, for messages.
std::string in_quotes(std::string_view text);

}  // namespace stereovox
