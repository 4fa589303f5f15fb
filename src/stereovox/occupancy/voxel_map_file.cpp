#include "stereovox/occupancy/voxel_map_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/occupancy/tile_section.h"

namespace stereovox {
namespace {

std::string part_name(const Eigen::Vector3i& tile) {
  return fmt::format("tile ({}, {}, {})", tile.x(), tile.y(), tile.z());
}

MapHeader header_of(const VoxelMap& map) {
  const KnownCounts known = map.known_counts();
  return {.voxel_size_m = map.voxel_size_m(),
          .floor_z_m = map.floor_z_m(),
          .has_epoch = map.epoch_ns.has_value(),
          .epoch_ns = map.epoch_ns.value_or(0),
          .frames_integrated = map.frames_integrated,
          .blocks = known.blocks,
          .known_voxels = known.voxels,
          .attachments = attachment_count(map)};
}

void put(std::ostream& out, std::string_view bytes) {
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

TileListing listing_of(const TileHead& head, std::uint64_t offset) {
  return {.index = head.index,
          .offset = offset,
          .bytes = static_cast<std::uint32_t>(head.bytes()),
          .blocks = head.blocks,
          .known_voxels = head.known_voxels};
}

// ---- reading

TileHead take_tile_head(MapInput& in) {
  const std::string bytes = in.take(kTileHeadBytes);
  return in.decode("a tile ", [&] { return decode_tile_head(bytes); });
}

void add_blocks(TileBlocks& blocks, VoxelMap& map) {
  for (auto& block : blocks)
    if (block != nullptr) map.find_or_create_block(block->index).voxels = std::move(block->voxels);
}

void take_tile_body(MapInput& in, const TileHead& head, VoxelMap& map) {
  const std::string body = in.take(head.bytes() - kTileHeadBytes);
  TileBlocks blocks =
      in.decode(part_name(head.index) + " ", [&] { return decode_tile_body(head, body); });
  add_blocks(blocks, map);
}

TileListing take_tile(MapInput& in, std::uint64_t offset, VoxelMap& map) {
  const TileHead head = take_tile_head(in);
  take_tile_body(in, head, map);
  return listing_of(head, offset);
}

// All tiles up to the number of blocks that the header gives, then index and end, which must say
// the same.
void take_tiles(MapInput& in, const MapHeader& header, std::uint64_t offset, VoxelMap& map) {
  std::vector<TileListing> tiles;
  std::uint64_t blocks = 0, known = 0;
  while (blocks < header.blocks) {
    const TileListing tile = take_tile(in, offset, map);
    if (!tiles.empty() && !LatticeOrder{}(tiles.back().index, tile.index))
      in.fail("tiles are not in order");
    tiles.push_back(tile);
    offset += tile.bytes;
    blocks += tile.blocks;
    known += tile.known_voxels;
  }
  if (blocks != header.blocks || known != header.known_voxels)
    in.fail(fmt::format("holds {} known voxels in {} blocks, its header says {} in {}", known,
                        blocks, header.known_voxels, header.blocks));
  if (take_index(in, tiles.size()) != tiles) in.fail("index does not fit the tiles");
  const MapEnd end = take_end(in);
  if (encode_header(end.header) != encode_header(header) || end.index_offset != offset ||
      end.tiles != tiles.size())
    in.fail("end does not fit the header");
}

MapHeader take_header(MapInput& in) {
  const std::string start = in.take(kMapStartBytes);
  in.decode("", [&] { return decode_version(start); });
  const std::string rest = in.take(kMapHeaderBytes - kMapStartBytes);
  return in.decode("", [&] { return decode_header(start + rest); });
}

}  // namespace

void write_voxel_map(std::ostream& out, const VoxelMap& map) {
  const MapHeader header = header_of(map);
  std::string front = encode_header(header);
  if (header.attachments > 0) front += encode_section({0, encode_attachments(map)});
  put(out, front);
  std::uint64_t offset = front.size();
  std::vector<TileListing> tiles;
  map.for_each_tile_section([&](std::string_view section) {
    put(out, section);
    tiles.push_back(listing_of(decode_tile_head(section), offset));
    offset += section.size();
  });
  put(out, encode_index(tiles));
  put(out, encode_end({header, offset, tiles.size()}));
}

void write_voxel_map(const std::filesystem::path& path, const VoxelMap& map) {
  write_file_atomically(path, [&](std::ostream& out) { write_voxel_map(out, map); });
}

VoxelMap read_voxel_map(std::istream& stream, const std::string& name) {
  MapInput in(stream, name);
  const MapHeader header = take_header(in);
  VoxelMap map = in.decode("", [&] { return empty_map(header); });
  const auto start = stream.tellg();
  take_attachments(in, header.attachments, map);
  const auto attachment_bytes = static_cast<std::uint64_t>(stream.tellg() - start);
  if (header.version == kVersionWithTiles)
    take_tiles(in, header, kMapHeaderBytes + attachment_bytes, map);
  else
    take_chunks(in, header, map);
  if (!in.is_at_end()) in.fail("bytes follow the end of the map");
  return map;
}

VoxelMap read_voxel_map(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path.string() + ": cannot be opened");
  return read_voxel_map(file, path.string());
}

VoxelMapTiles::VoxelMapTiles(const std::filesystem::path& path)
    : file_(path, std::ios::binary), in_(file_, path.string()) {
  if (!file_) in_.fail("cannot be opened");
  end_.header = take_header(in_);
  if (end_.header.version != kVersionWithTiles)
    in_.fail(fmt::format("has format version {}, which has no tiles", end_.header.version));
  const std::uint64_t size = in_.size();
  if (size < kMapHeaderBytes + kMapEndBytes) in_.fail("is cut off");
  in_.seek(size - kMapEndBytes);
  end_ = take_end(in_);
  in_.seek(end_.index_offset);
  tiles_ = take_index(in_, end_.tiles);
}

VoxelMap VoxelMapTiles::empty_map() const {
  return in_.decode("", [&] { return stereovox::empty_map(header()); });
}

void VoxelMapTiles::read(const TileListing& tile, VoxelMap& map) {
  in_.seek(tile.offset);
  const TileHead head = take_tile_head(in_);
  if (head.index != tile.index || head.bytes() != tile.bytes)
    in_.fail(part_name(tile.index) + " is not where the index says");
  take_tile_body(in_, head, map);
}

}  // namespace stereovox
