#include "stereovox/io/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"
#include "stereovox/io/file_bytes.h"

namespace stereovox {
namespace {

constexpr std::uint64_t kMaxTextBytes = 256ULL << 20;
constexpr std::size_t kMaxQuotedLength = 40;
constexpr std::string_view kSeparators = " \t\r,\v\f";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr int kDecimalsOfNanoseconds = 9;
constexpr int kMaxExponent = 400;  // beyond what any double can hold

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t begin = line.find_first_not_of(kSeparators);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kSeparators, end);
  }
}

std::string_view without_plus(std::string_view text) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
  return has_plus ? text.substr(1) : text;
}

template <class Number>
std::optional<Number> parse_whole(std::string_view text) {
  text = without_plus(text);
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

// A decimal number as its digits and the place of the point: "-12.5e1" is {true, "125", 3}.
struct Decimal {
  bool is_negative = false;
  std::string digits;
  int digits_before_point = 0;
};

std::optional<Decimal> parse_decimal(std::string_view text) {
  Decimal decimal;
  decimal.is_negative = text.starts_with('-');
  if (decimal.is_negative) text.remove_prefix(1);
  const std::size_t exponent_at = text.find_first_of("eE");
  std::int64_t exponent = 0;
  if (exponent_at != std::string_view::npos) {
    const std::optional<std::int64_t> given = parse_integer(text.substr(exponent_at + 1));
    if (!given || std::abs(*given) > kMaxExponent) return std::nullopt;
    exponent = *given;
    text = text.substr(0, exponent_at);
  }
  const std::size_t point_at = std::min(text.find('.'), text.size());
  decimal.digits = text.substr(0, point_at);
  decimal.digits_before_point = static_cast<int>(point_at + exponent);
  if (point_at < text.size()) decimal.digits += text.substr(point_at + 1);
  const bool is_valid = !decimal.digits.empty() &&
                        decimal.digits.find_first_not_of("0123456789") == std::string::npos;
  return is_valid ? std::optional(decimal) : std::nullopt;
}

}  // namespace

std::string TextRecord::place() const { return fmt::format("{}:{}", path, line); }

void TextRecord::expect_fields(std::size_t count) const {
  if (fields.size() != count)
    throw Error(fmt::format("{}: has {} fields, {} are needed", place(), fields.size(), count));
}

double TextRecord::number(std::size_t field) const {
  const std::optional<double> value = parse_number(fields[field]);
  if (!value || !std::isfinite(*value))
    throw Error(fmt::format("{}: field {} is {}, not a finite number", place(), field + 1,
                            in_quotes(fields[field])));
  return *value;
}

std::int64_t TextRecord::integer(std::size_t field) const {
  const std::optional<std::int64_t> value = parse_integer(fields[field]);
  if (!value)
    throw Error(fmt::format("{}: field {} is {}, not a whole number", place(), field + 1,
                            in_quotes(fields[field])));
  return *value;
}

std::int64_t TextRecord::stamp_ns(std::size_t field) const {
  const std::optional<std::int64_t> value = parse_seconds_as_ns(fields[field]);
  if (!value)
    throw Error(fmt::format("{}: field {} is {}, not a time in seconds", place(), field + 1,
                            in_quotes(fields[field])));
  return *value;
}

void for_each_record(const std::filesystem::path& path,
                     const std::function<void(const TextRecord&)>& use) {
  const std::string text = read_file(path, kMaxTextBytes);
  const std::string name = path.string();
  std::string_view rest = text;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  std::vector<std::string_view> fields;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    split(rest.substr(0, end), fields);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!fields.empty() && !fields.front().starts_with('#')) use({name, line, fields});
  }
}

std::optional<double> parse_number(std::string_view text) { return parse_whole<double>(text); }

std::optional<std::int64_t> parse_integer(std::string_view text) {
  return parse_whole<std::int64_t>(text);
}

std::optional<std::int64_t> parse_seconds_as_ns(std::string_view text) {
  std::optional<Decimal> decimal = parse_decimal(without_plus(text));
  if (!decimal) return std::nullopt;
  const int wanted = decimal->digits_before_point + kDecimalsOfNanoseconds;
  if (wanted < 0) return 0;
  const auto count = static_cast<std::size_t>(wanted);
  const bool round_up = count < decimal->digits.size() && decimal->digits[count] >= '5';
  decimal->digits.resize(count, '0');
  const std::optional<std::int64_t> value =
      decimal->digits.empty() ? 0 : parse_integer(decimal->digits);
  if (!value || *value == INT64_MAX) return std::nullopt;
  const std::int64_t magnitude = *value + (round_up ? 1 : 0);
  return decimal->is_negative ? -magnitude : magnitude;
}

std::string seconds_text(std::int64_t stamp_ns) {
  const std::int64_t seconds = stamp_ns / kNanosecondsPerSecond;
  const std::int64_t rest_ns = stamp_ns % kNanosecondsPerSecond;
  return fmt::format("{}{}.{:09}", stamp_ns < 0 ? "-" : "", std::abs(seconds), std::abs(rest_ns));
}

std::string in_quotes(std::string_view text) {
  std::string shown(text.substr(0, kMaxQuotedLength));
  std::ranges::replace_if(
      shown, [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return "'" + shown + (text.size() > kMaxQuotedLength ? "...'" : "'");
}

}  // namespace stereovox
