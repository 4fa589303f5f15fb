#include "stereovox/occupancy/map_input.h"

#include <fmt/format.h>

#include <algorithm>

#include "stereovox/occupancy/byte_buffer.h"
#include "stereovox/occupancy/compression.h"
#include "stereovox/occupancy/crc32c.h"

namespace stereovox {

std::string MapInput::take(std::size_t size) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::string bytes;
  while (bytes.size() < size) {
    const std::size_t old = bytes.size(), piece = std::min(kPiece, size - old);
    bytes.resize(old + piece);
    in_.read(bytes.data() + old, static_cast<std::streamsize>(piece));
    if (static_cast<std::size_t>(in_.gcount()) != piece) fail("is cut off");
  }
  return bytes;
}

std::uint64_t MapInput::size() {
  in_.clear();
  in_.seekg(0, std::ios::end);
  return static_cast<std::uint64_t>(in_.tellg());
}

std::string encode_section(const MapSection& section) {
  const std::string packed = compressed(section.content);
  std::string bytes;
  append_number(bytes, section.blocks);
  append_number(bytes, static_cast<std::uint32_t>(section.content.size()));
  append_number(bytes, static_cast<std::uint32_t>(packed.size()));
  bytes += packed;
  append_number(bytes, crc32c(bytes));
  return bytes;
}

MapSection take_section(MapInput& in, const std::string& part, std::size_t max_bytes) {
  std::string bytes = in.take(3 * sizeof(std::uint32_t));
  ByteReader reader(bytes);
  const auto blocks = reader.number<std::uint32_t>();
  const auto size = reader.number<std::uint32_t>(), packed = reader.number<std::uint32_t>();
  if (size > max_bytes || packed > max_compressed_bytes(size))
    in.fail(fmt::format("{} claims {} bytes, {} compressed; at most {} are possible", part, size,
                        packed, max_bytes));
  bytes += in.take(packed);
  const std::string sum = in.take(sizeof(std::uint32_t));
  if (ByteReader(sum).number<std::uint32_t>() != crc32c(bytes))
    in.fail(part + " is damaged (its checksum does not match)");
  return in.decode(part + " ", [&]() -> MapSection {
    return {blocks, decompressed(std::string_view(bytes).substr(bytes.size() - packed), size)};
  });
}

}  // namespace stereovox
