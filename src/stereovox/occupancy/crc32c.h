// CRC-32C (Castagnoli): finds every change of up to 32 bits in a row.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace stereovox {

inline constexpr std::array<std::uint32_t, 256> kCrc32cTable = [] {
  constexpr std::uint32_t kReversedPolynomial = 0x82F63B78U;
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit)
      remainder = remainder >> 1 ^ ((remainder & 1U) != 0 ? kReversedPolynomial : 0U);
    table[byte] = remainder;
  }
  return table;
}();

inline std::uint32_t crc32c(std::string_view bytes) {
  std::uint32_t remainder = ~0U;
  for (const char c : bytes)
    remainder = remainder >> 8 ^ kCrc32cTable[(remainder ^ static_cast<unsigned char>(c)) & 0xFFU];
  return ~remainder;
}

}  // namespace stereovox
