// Little-endian numbers in a string of bytes.
#pragma once

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace stereovox {

template <class Number>
using BitsOf = std::conditional_t<
    sizeof(Number) == 8, std::uint64_t,
    std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                       std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;

template <class Number>
void append_number(std::string& bytes, Number value) {
  const auto bits = std::bit_cast<BitsOf<Number>>(value);
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    bytes.push_back(static_cast<char>(static_cast<std::uint64_t>(bits) >> (8 * i)));
}

// Takes numbers and strings from the front. Throws std::out_of_range when the bytes run out.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) throw std::out_of_range("bytes run out");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  template <class Number>
  Number number() {
    std::uint64_t bits = 0;
    const std::string_view taken = take(sizeof(Number));
    for (std::size_t i = 0; i < sizeof(Number); ++i)
      bits |= std::uint64_t{static_cast<unsigned char>(taken[i])} << (8 * i);
    return std::bit_cast<Number>(static_cast<BitsOf<Number>>(bits));
  }

  bool is_at_end() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

}  // namespace stereovox
