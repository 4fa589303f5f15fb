#include "stereovox/occupancy/voxel_chunk.h"

#include <stdexcept>
#include <vector>

#include "stereovox/occupancy/byte_buffer.h"
#include "stereovox/occupancy/voxel_mask.h"

namespace stereovox {
namespace {

// All first bytes, then all second bytes, ...: neighbouring voxels are alike, so this compresses.
template <class Number>
void append_planes(std::string& bytes, const std::vector<Number>& values) {
  for (std::size_t plane = 0; plane < sizeof(Number); ++plane)
    for (const Number value : values) {
      const auto bits = static_cast<std::uint64_t>(std::bit_cast<BitsOf<Number>>(value));
      bytes.push_back(static_cast<char>(bits >> (8 * plane)));
    }
}

template <class Number>
std::vector<Number> take_planes(ByteReader& reader, std::size_t count) {
  std::vector<std::uint64_t> bits(count, 0);
  for (std::size_t plane = 0; plane < sizeof(Number); ++plane) {
    const std::string_view bytes = reader.take(count);
    for (std::size_t i = 0; i < count; ++i)
      bits[i] |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * plane);
  }
  std::vector<Number> values;
  values.reserve(count);
  for (const std::uint64_t b : bits)
    values.push_back(std::bit_cast<Number>(static_cast<BitsOf<Number>>(b)));
  return values;
}

Eigen::Vector3i take_place(ByteReader& reader, const std::optional<Eigen::Vector3i>& previous) {
  Eigen::Vector3i place;
  for (int axis = 0; axis < 3; ++axis) place[axis] = reader.number<std::int32_t>();
  if ((place.array() < -kMaxBlockCoordinate).any() || (place.array() > kMaxBlockCoordinate).any())
    throw std::runtime_error("block lies outside the lattice");
  if (previous && !LatticeOrder{}(*previous, place))
    throw std::runtime_error("blocks are not in order");
  return place;
}

VoxelMask take_mask(ByteReader& reader) {
  VoxelMask known;
  for (std::uint64_t& word : known.words) word = reader.number<std::uint64_t>();
  if (known.is_empty()) throw std::runtime_error("block knows no voxel");
  return known;
}

void check(const Voxel& voxel) {
  if (!(voxel.state >= 0.0F && voxel.state <= 1.0F))
    throw std::runtime_error("state of a voxel is outside [0, 1]");
  if (voxel.observations == 0) throw std::runtime_error("known voxel has no observation");
}

}  // namespace

std::string encode_chunk(std::span<const VoxelBlock* const> blocks, VoxelFields fields) {
  std::string bytes;
  std::vector<float> states;
  std::vector<std::uint32_t> times_ms;
  std::vector<std::uint16_t> counts, ignorances;
  for (const VoxelBlock* const block : blocks)
    for (const int coordinate : block->index) append_number(bytes, coordinate);
  for (const VoxelBlock* const block : blocks) {
    const VoxelMask known = block->voxels.known();
    for (const std::uint64_t word : known.words) append_number(bytes, word);
    for_each_in(known, [&](int i) {
      const Voxel voxel = block->voxels[static_cast<std::size_t>(i)];
      states.push_back(voxel.state);
      times_ms.push_back(voxel.last_seen_ms);
      counts.push_back(voxel.observations);
      ignorances.push_back(voxel.ignorance);
    });
  }
  append_planes(bytes, states);
  append_planes(bytes, times_ms);
  append_planes(bytes, counts);
  if (fields == VoxelFields::all) append_planes(bytes, ignorances);
  return bytes;
}

DecodedChunk decode_chunk(std::string_view bytes, VoxelFields fields, int block_count,
                          const std::optional<Eigen::Vector3i>& previous,
                          const NewBlock& new_block) {
  ByteReader reader(bytes);
  DecodedChunk decoded{0, previous};
  std::vector<VoxelBlock*> blocks;
  for (int i = 0; i < block_count; ++i) {
    decoded.last_block = take_place(reader, decoded.last_block);
    blocks.push_back(&new_block(*decoded.last_block));
  }
  std::vector<VoxelMask> known;
  for (int i = 0; i < block_count; ++i) {
    known.push_back(take_mask(reader));
    decoded.known_voxels += known.back().count();
  }
  const auto states = take_planes<float>(reader, decoded.known_voxels);
  const auto times_ms = take_planes<std::uint32_t>(reader, decoded.known_voxels);
  const auto counts = take_planes<std::uint16_t>(reader, decoded.known_voxels);
  const auto ignorances = fields == VoxelFields::all
                              ? take_planes<std::uint16_t>(reader, decoded.known_voxels)
                              : std::vector<std::uint16_t>(decoded.known_voxels, 0);
  if (!reader.is_at_end()) throw std::runtime_error("bytes are left over");
  std::size_t at = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for_each_in(known[b], [&](int i) {
      const Voxel voxel{states[at], times_ms[at], counts[at], ignorances[at]};
      check(voxel);
      blocks[b]->voxels.set(static_cast<std::size_t>(i), voxel);
      ++at;
    });
  return decoded;
}

}  // namespace stereovox
