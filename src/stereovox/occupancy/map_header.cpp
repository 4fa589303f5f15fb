#include "stereovox/occupancy/map_header.h"

#include <fmt/format.h>

#include <stdexcept>

#include "stereovox/occupancy/byte_buffer.h"
#include "stereovox/occupancy/crc32c.h"

namespace stereovox {
namespace {

// Visits the fields after the version in the order of the file.
template <class Header, class Visit>
void for_each_field(Header& header, Visit visit) {
  visit(header.voxel_size_m);
  visit(header.floor_z_m);
  visit(header.has_epoch);
  visit(header.epoch_ns);
  visit(header.frames_integrated);
  visit(header.blocks);
  visit(header.known_voxels);
  visit(header.attachments);
}

}  // namespace

std::string encode_header(const MapHeader& header) {
  std::string bytes(kMapMagic);
  append_number(bytes, header.version);
  for_each_field(header, [&](auto value) { append_number(bytes, value); });
  append_number(bytes, crc32c(bytes));
  return bytes;
}

std::uint16_t decode_version(std::string_view bytes) {
  ByteReader reader(bytes);
  if (reader.take(kMapMagic.size()) != kMapMagic)
    throw std::runtime_error("is not a stereovox map");
  const auto version = reader.number<std::uint16_t>();
  if (version < kFirstMapVersion || version > kVersionWithTiles)
    throw std::runtime_error(
        fmt::format("has format version {}, this program reads versions {} to {}", version,
                    kFirstMapVersion, kVersionWithTiles));
  return version;
}

MapHeader decode_header(std::string_view bytes) {
  MapHeader header;
  header.version = decode_version(bytes);
  ByteReader reader(bytes.substr(kMapStartBytes));
  for_each_field(header, [&](auto& value) {
    value = reader.number<std::remove_reference_t<decltype(value)>>();
  });
  if (reader.number<std::uint32_t>() != crc32c(bytes.substr(0, kMapHeaderBytes - 4)))
    throw std::runtime_error("header is damaged (its checksum does not match)");
  return header;
}

VoxelMap empty_map(const MapHeader& header) {
  if (header.has_epoch > 1)
    throw std::runtime_error("header: flag of the epoch is neither 0 nor 1");
  try {
    VoxelMap map(header.voxel_size_m, header.floor_z_m);
    if (header.has_epoch != 0) map.epoch_ns = header.epoch_ns;
    map.frames_integrated = header.frames_integrated;
    return map;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string("header: ") + error.what());
  }
}

}  // namespace stereovox
