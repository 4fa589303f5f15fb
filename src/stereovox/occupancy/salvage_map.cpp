// Reading what is left of a damaged map file.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/tile_section.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

std::string place_text(const Eigen::Vector3i& tile) {
  return fmt::format("tile ({}, {}, {})", tile.x(), tile.y(), tile.z());
}

class Salvage {
 public:
  explicit Salvage(const std::filesystem::path& path)
      : file_(path, std::ios::binary), in_(file_, path.string()) {
    if (!file_) in_.fail("cannot be opened");
    size_ = in_.size();
    end_ = attempt([&] {
      in_.seek(size_ < kMapEndBytes ? size_ : size_ - kMapEndBytes);
      return take_end(in_);
    });
  }

  SalvagedMap run() {
    const MapHeader header = find_header();
    SalvagedMap out{in_.decode("", [&] { return empty_map(header); }), 0, {}};
    std::uint64_t offset = std::min<std::uint64_t>(kMapHeaderBytes, size_);
    in_.seek(offset);
    if (attempt([&] { return take_attachments(in_, header.attachments, out.map), true; }))
      offset = static_cast<std::uint64_t>(file_.tellg());
    else
      losses_.push_back("the attachments are damaged");
    if (header.version == kVersionWithTiles)
      take_tiles(offset, header, out);
    else
      take_chunks_before_damage(header, out);
    out.losses = std::move(losses_);
    return out;
  }

 private:
  // What `body` gives, or nothing when it complains about the file.
  template <class Body>
  auto attempt(Body body) -> std::optional<decltype(body())> {
    try {
      return body();
    } catch (const Error& error) {
      complaint_ = error.what();
    } catch (const std::runtime_error& error) {
      complaint_ = error.what();
    } catch (const std::out_of_range& error) {
      complaint_ = error.what();
    }
    return std::nullopt;
  }

  std::string bytes_at(std::uint64_t offset, std::size_t count) {
    in_.seek(offset);
    return in_.take(std::min<std::uint64_t>(count, size_ - offset));
  }

  MapHeader find_header() {
    const auto first = attempt([&] { return decode_header(bytes_at(0, kMapHeaderBytes)); });
    if (first) return *first;
    if (!end_) in_.fail(complaint_.empty() ? "has no intact header" : "has no intact header left");
    losses_.push_back("the header is damaged; its copy at the end is used");
    return end_->header;
  }

  void take_tiles(std::uint64_t offset, const MapHeader& header, SalvagedMap& out) {
    const std::uint64_t end = end_ ? end_->index_offset : size_;
    while (offset < end && size_ - offset >= kTileHeadBytes) {
      const auto head = attempt([&] { return decode_tile_head(bytes_at(offset, kTileHeadBytes)); });
      if (head) take_tile(offset, *head, out);
      offset = head ? offset + head->bytes() : next_mark(offset + 1);
    }
    report_missing(header);
  }

  void take_tile(std::uint64_t offset, const TileHead& head, SalvagedMap& out) {
    auto blocks = attempt([&] {
      return decode_tile_body(head,
                              bytes_at(offset + kTileHeadBytes, head.bytes() - kTileHeadBytes));
    });
    if (!blocks) return;
    for (auto& block : *blocks)
      if (block != nullptr)
        out.map.find_or_create_block(block->index).voxels = std::move(block->voxels);
    ++out.tiles;
    blocks_ += head.blocks;
    kept_.insert(head.index);
  }

  // The next place where a tile may begin, or the end of the file.
  std::uint64_t next_mark(std::uint64_t offset) {
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    for (; offset < size_; offset += kPiece) {
      // Pieces overlap, so that no mark is cut.
      const std::string bytes = bytes_at(offset, kPiece + kTileMark.size() - 1);
      if (const std::size_t at = bytes.find(kTileMark); at != std::string::npos) return offset + at;
    }
    return size_;
  }

  // By name when the index is intact, else as a number of blocks.
  void report_missing(const MapHeader& header) {
    const auto index = attempt([&] {
      if (!end_) in_.fail("is cut off");
      in_.seek(end_->index_offset);
      return take_index(in_, end_->tiles);
    });
    if (index) {
      for (const TileListing& tile : *index)
        if (!kept_.contains(tile.index))
          losses_.push_back(fmt::format("{} is lost: {} blocks, {} voxels", place_text(tile.index),
                                        tile.blocks, tile.known_voxels));
      return;
    }
    losses_.push_back("the index at the end is damaged or missing");
    if (blocks_ < header.blocks)
      losses_.push_back(
          fmt::format("{} of {} blocks are lost", header.blocks - blocks_, header.blocks));
  }

  void take_chunks_before_damage(const MapHeader& header, SalvagedMap& out) {
    if (!attempt([&] { return take_chunks(in_, header, out.map), true; }))
      losses_.push_back(fmt::format("{}; {} of {} blocks are lost", complaint_,
                                    header.blocks - out.map.block_count(), header.blocks));
    out.tiles = out.map.block_count();
  }

  std::ifstream file_;
  MapInput in_;
  std::uint64_t size_ = 0, blocks_ = 0;
  std::optional<MapEnd> end_;
  std::set<Eigen::Vector3i, LatticeOrder> kept_;
  std::vector<std::string> losses_;
  std::string complaint_;
};

}  // namespace

SalvagedMap salvage_voxel_map(const std::filesystem::path& path) { return Salvage(path).run(); }

}  // namespace stereovox
