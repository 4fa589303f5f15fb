#include "stereovox/occupancy/tile_section.h"

#include <stdexcept>

#include "stereovox/occupancy/byte_buffer.h"
#include "stereovox/occupancy/compression.h"
#include "stereovox/occupancy/crc32c.h"

namespace stereovox {
namespace {

constexpr int kMaxTileCoordinate = (kMaxBlockCoordinate + 1) >> kTileSideLog2;

void check(const TileHead& head) {
  if ((head.index.array() < -kMaxTileCoordinate).any() ||
      (head.index.array() >= kMaxTileCoordinate).any())
    throw std::runtime_error("tile lies outside the lattice");
  if (head.blocks < 1 || head.blocks > kBlocksPerTile || head.known_voxels < head.blocks ||
      head.known_voxels > head.blocks * kVoxelsPerBlock)
    throw std::runtime_error("tile has an impossible number of blocks or voxels");
  if (head.content_bytes > max_chunk_bytes(head.fields, static_cast<int>(head.blocks)) ||
      head.compressed_bytes > max_compressed_bytes(head.content_bytes))
    throw std::runtime_error("tile claims more bytes than its blocks can have");
}

std::string encode_head(const TileHead& head) {
  std::string bytes(kTileMark);
  for (const int coordinate : head.index) append_number(bytes, coordinate);
  append_number(bytes, static_cast<std::uint8_t>(head.fields == VoxelFields::all));
  for (const std::uint32_t number :
       {head.blocks, head.known_voxels, head.content_bytes, head.compressed_bytes})
    append_number(bytes, number);
  append_number(bytes, crc32c(bytes));
  return bytes;
}

bool any_ignorance(std::span<const VoxelBlock* const> blocks) {
  for (const VoxelBlock* const block : blocks)
    if (block->voxels.has_ignorance()) return true;
  return false;
}

}  // namespace

std::size_t TileHead::bytes() const { return kTileHeadBytes + compressed_bytes + kChecksumBytes; }

std::string encode_tile(const Eigen::Vector3i& tile, std::span<const VoxelBlock* const> blocks) {
  TileHead head{.index = tile};
  std::vector<const VoxelBlock*> full;
  for (const VoxelBlock* const block : blocks)
    if (const std::size_t known = block->voxels.known_count(); known > 0) {
      full.push_back(block);
      head.known_voxels += static_cast<std::uint32_t>(known);
    }
  if (full.empty()) return {};
  head.blocks = static_cast<std::uint32_t>(full.size());
  head.fields = any_ignorance(full) ? VoxelFields::all : VoxelFields::without_ignorance;
  const std::string content = encode_chunk(full, head.fields);
  const std::string body = compressed(content);
  head.content_bytes = static_cast<std::uint32_t>(content.size());
  head.compressed_bytes = static_cast<std::uint32_t>(body.size());
  std::string bytes = encode_head(head) + body;
  append_number(bytes, crc32c(body));
  return bytes;
}

TileHead decode_tile_head(std::string_view bytes) {
  ByteReader reader(bytes.substr(0, kTileHeadBytes));
  if (reader.take(kTileMark.size()) != kTileMark)
    throw std::runtime_error("has no mark where it should begin");
  TileHead head;
  for (int axis = 0; axis < 3; ++axis) head.index[axis] = reader.number<std::int32_t>();
  const auto has_ignorance = reader.number<std::uint8_t>();
  for (std::uint32_t* const number :
       {&head.blocks, &head.known_voxels, &head.content_bytes, &head.compressed_bytes})
    *number = reader.number<std::uint32_t>();
  if (reader.number<std::uint32_t>() != crc32c(bytes.substr(0, kTileHeadBytes - kChecksumBytes)))
    throw std::runtime_error("is damaged (the checksum of its head does not match)");
  if (has_ignorance > 1) throw std::runtime_error("flag of the ignorance is neither 0 nor 1");
  head.fields = has_ignorance != 0 ? VoxelFields::all : VoxelFields::without_ignorance;
  check(head);
  return head;
}

TileBlocks decode_tile_body(const TileHead& head, std::string_view body) {
  ByteReader reader(body);
  const std::string_view packed = reader.take(head.compressed_bytes);
  if (reader.number<std::uint32_t>() != crc32c(packed))
    throw std::runtime_error("is damaged (its checksum does not match)");
  TileBlocks blocks;
  const DecodedChunk decoded = decode_chunk(
      decompressed(packed, head.content_bytes), head.fields, static_cast<int>(head.blocks),
      std::nullopt, [&](const Eigen::Vector3i& place) -> VoxelBlock& {
        if (tile_of(place) != head.index) throw std::runtime_error("block lies outside the tile");
        auto& block = blocks[position_in_tile(place)];
        block = std::make_unique<VoxelBlock>(VoxelBlock{place, {}});
        return *block;
      });
  if (decoded.known_voxels != head.known_voxels || !reader.is_at_end())
    throw std::runtime_error("holds another number of voxels or bytes than its head says");
  return blocks;
}

TileBlocks decode_tile(std::string_view section) {
  const TileHead head = decode_tile_head(section);
  return decode_tile_body(head, section.substr(kTileHeadBytes));
}

}  // namespace stereovox
