#include "stereovox/occupancy/map_parts.h"

#include <fmt/format.h>

#include "stereovox/occupancy/byte_buffer.h"
#include "stereovox/occupancy/crc32c.h"
#include "stereovox/occupancy/voxel_chunk.h"

namespace stereovox {
namespace {

constexpr std::size_t kMaxAttachmentBytes = std::size_t{64} << 20;
constexpr int kMaxBlocksPerChunk = 256;
constexpr const char* kFloorAttachment = "floor";
constexpr std::string_view kEndMark = "STEREOVOX-END\n";

bool has_floor(const VoxelMap& map) { return !map.floor.squares().empty(); }

void check_sum(MapInput& in, std::string_view bytes, const std::string& part) {
  const std::string sum = in.take(sizeof(std::uint32_t));
  if (ByteReader(sum).number<std::uint32_t>() != crc32c(bytes))
    in.fail(part + " is damaged (its checksum does not match)");
}

}  // namespace

std::string encode_attachments(const VoxelMap& map) {
  std::map<std::string, std::string> attachments = map.attachments;
  if (has_floor(map)) attachments[kFloorAttachment] = to_bytes(map.floor);
  std::string bytes;
  for (const auto& [name, blob] : attachments)
    for (const std::string& text : {name, blob}) {
      append_number(bytes, static_cast<std::uint32_t>(text.size()));
      bytes += text;
      if (bytes.size() > kMaxAttachmentBytes)
        throw Error(fmt::format("attachment '{}': attachments exceed {} bytes together", name,
                                kMaxAttachmentBytes));
    }
  return bytes;
}

std::uint32_t attachment_count(const VoxelMap& map) {
  return static_cast<std::uint32_t>(map.attachments.size()) + (has_floor(map) ? 1 : 0);
}

void take_attachments(MapInput& in, std::uint32_t count, VoxelMap& map) {
  if (count == 0) return;
  const MapSection section = take_section(in, "attachments", kMaxAttachmentBytes);
  in.decode("attachments: ", [&] {
    ByteReader reader(section.content);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::string key(reader.take(reader.number<std::uint32_t>()));
      const std::string_view blob = reader.take(reader.number<std::uint32_t>());
      if (key == kFloorAttachment)
        map.floor = floor_from_bytes(blob, map.floor_z_m());
      else
        map.attachments[key] = blob;
    }
    if (!reader.is_at_end() || attachment_count(map) != count)
      throw std::runtime_error(fmt::format("are not {}", count));
  });
}

void take_chunks(MapInput& in, const MapHeader& header, VoxelMap& map) {
  const VoxelFields fields =
      header.version == kVersionWithIgnorance ? VoxelFields::all : VoxelFields::without_ignorance;
  std::uint64_t known = 0;
  std::optional<Eigen::Vector3i> last;
  for (std::uint64_t chunk = 0; map.block_count() < header.blocks; ++chunk) {
    const std::string part = fmt::format("chunk {}", chunk);
    const MapSection section = take_section(in, part, max_chunk_bytes(fields, kMaxBlocksPerChunk));
    const std::uint64_t missing = header.blocks - map.block_count();
    if (section.blocks != std::min<std::uint64_t>(missing, kMaxBlocksPerChunk))
      in.fail(fmt::format("{} holds {} blocks of {} missing ones", part, section.blocks, missing));
    in.decode(part + ": ", [&] {
      const DecodedChunk decoded = decode_chunk(
          section.content, fields, static_cast<int>(section.blocks), last,
          [&](const Eigen::Vector3i& b) -> VoxelBlock& { return map.find_or_create_block(b); });
      known += decoded.known_voxels;
      last = decoded.last_block;
    });
  }
  if (known != header.known_voxels)
    in.fail(fmt::format("holds {} known voxels, its header says {}", known, header.known_voxels));
}

std::string encode_index(const std::vector<TileListing>& tiles) {
  std::string bytes;
  for (const TileListing& tile : tiles) {
    for (const int coordinate : tile.index) append_number(bytes, coordinate);
    append_number(bytes, tile.offset);
    for (const std::uint32_t number : {tile.bytes, tile.blocks, tile.known_voxels})
      append_number(bytes, number);
  }
  append_number(bytes, crc32c(bytes));
  return bytes;
}

std::vector<TileListing> take_index(MapInput& in, std::uint64_t tiles) {
  constexpr std::uint64_t kMaxTiles = std::uint64_t{1} << 48;  // so that no product overflows
  if (tiles > kMaxTiles) in.fail(fmt::format("index claims {} tiles", tiles));
  const std::string bytes = in.take(tiles * kListingBytes);
  check_sum(in, bytes, "index");
  ByteReader reader(bytes);
  std::vector<TileListing> listings(tiles);
  for (TileListing& tile : listings) {
    for (int axis = 0; axis < 3; ++axis) tile.index[axis] = reader.number<std::int32_t>();
    tile.offset = reader.number<std::uint64_t>();
    for (std::uint32_t* const number : {&tile.bytes, &tile.blocks, &tile.known_voxels})
      *number = reader.number<std::uint32_t>();
  }
  return listings;
}

std::string encode_end(const MapEnd& end) {
  std::string bytes = encode_header(end.header);
  append_number(bytes, end.index_offset);
  append_number(bytes, end.tiles);
  append_number(bytes, crc32c(bytes));
  return bytes + std::string(kEndMark);
}

MapEnd take_end(MapInput& in) {
  const std::string bytes = in.take(kMapEndBytes - kEndMark.size() - 4);
  check_sum(in, bytes, "end");
  if (in.take(kEndMark.size()) != kEndMark) in.fail("end has no mark");
  return in.decode("end: ", [&] {
    ByteReader reader(std::string_view(bytes).substr(kMapHeaderBytes));
    const auto offset = reader.number<std::uint64_t>(), tiles = reader.number<std::uint64_t>();
    return MapEnd{decode_header(bytes), offset, tiles};
  });
}

}  // namespace stereovox
