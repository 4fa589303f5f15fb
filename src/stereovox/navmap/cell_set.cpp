#include "stereovox/navmap/cell_set.h"

#include <fmt/format.h>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr int kBitsPerByte = 8;
constexpr std::size_t kTileBytes = 2 * sizeof(std::uint32_t) + sizeof(std::uint64_t);

template <class Unsigned>
void append(Unsigned value, std::string& bytes) {
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    bytes += static_cast<char>(value >> (kBitsPerByte * i) & 0xFFU);
}

// The caller has checked that there are enough bytes.
template <class Unsigned>
Unsigned take(std::string_view& bytes) {
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    value |= static_cast<Unsigned>(static_cast<unsigned char>(bytes[i])) << (kBitsPerByte * i);
  bytes.remove_prefix(sizeof(Unsigned));
  return value;
}

bool is_on_lattice(const TileIndex& tile) {
  return std::abs(std::int64_t{tile.first}) <= kMaxBlockCoordinate &&
         std::abs(std::int64_t{tile.second}) <= kMaxBlockCoordinate;
}

}  // namespace

bool CellSet::contains(const Eigen::Vector2i& cell) const {
  const auto found = tiles_.find(tile_of(cell));
  return found != tiles_.end() && (found->second >> position_in_tile(cell) & 1U) != 0;
}

void CellSet::insert(const TileIndex& tile, std::uint64_t bits) {
  if (bits != 0) tiles_[tile] |= bits;
}

void CellSet::erase(const TileIndex& tile, std::uint64_t bits) {
  const auto found = tiles_.find(tile);
  if (found == tiles_.end()) return;
  found->second &= ~bits;
  if (found->second == 0) tiles_.erase(found);
}

void append_bytes(const CellSet& set, std::string& bytes) {
  append(static_cast<std::uint32_t>(set.tiles().size()), bytes);
  for (const auto& [tile, bits] : set.tiles()) {
    append(static_cast<std::uint32_t>(tile.first), bytes);
    append(static_cast<std::uint32_t>(tile.second), bytes);
    append(bits, bytes);
  }
}

CellSet take_cell_set(std::string_view& bytes, const std::string& source) {
  if (bytes.size() < sizeof(std::uint32_t))
    throw Error(fmt::format("{}: a set of cells is cut off", source));
  const auto count = take<std::uint32_t>(bytes);
  if (bytes.size() / kTileBytes < count)
    throw Error(fmt::format("{}: a set of {} tiles is cut off", source, count));
  CellSet set;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto x = static_cast<int>(take<std::uint32_t>(bytes));
    const auto y = static_cast<int>(take<std::uint32_t>(bytes));
    const TileIndex tile(x, y);
    const auto bits = take<std::uint64_t>(bytes);
    const bool in_order = set.tiles().empty() || set.tiles().rbegin()->first < tile;
    if (bits == 0 || !in_order || !is_on_lattice(tile))
      throw Error(fmt::format("{}: tile {} of a set of cells is damaged", source, i));
    set.insert(tile, bits);
  }
  return set;
}

}  // namespace stereovox
