#include "stereovox/occupancy/voxel_map_file.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/occupancy/byte_buffer.h"
#include "stereovox/occupancy/crc32c.h"
#include "stereovox/occupancy/voxel_chunk.h"

namespace stereovox {
namespace {

constexpr std::string_view kMagic = "STEREOVOX-MAP\n";
// A file has the lowest version that can hold its map, so that older programs read what they can.
constexpr std::uint16_t kFirstVersion = 1;
constexpr std::uint16_t kVersionWithIgnorance = 2;
constexpr std::size_t kMaxAttachmentBytes = std::size_t{64} << 20;
constexpr int kCompressionLevel = 1;  // higher ones are slower and hardly smaller on byte planes

struct Header {
  double voxel_size_m = 0, floor_z_m = 0;
  std::uint8_t has_epoch = 0;
  std::int64_t epoch_ns = 0;
  std::uint32_t frames_integrated = 0;
  std::uint64_t blocks = 0, known_voxels = 0;
  std::uint32_t attachments = 0;

  // Visits the fields in the order of the file.
  template <class Self, class Visit>
  static void each(Self& self, Visit visit) {
    visit(self.voxel_size_m);
    visit(self.floor_z_m);
    visit(self.has_epoch);
    visit(self.epoch_ns);
    visit(self.frames_integrated);
    visit(self.blocks);
    visit(self.known_voxels);
    visit(self.attachments);
  }
};

VoxelFields fields_of(std::uint16_t version) {
  return version == kVersionWithIgnorance ? VoxelFields::all : VoxelFields::without_ignorance;
}

// ---- writing

using Blocks = std::vector<const VoxelBlock*>;

Blocks blocks_to_write(const VoxelMap& map) {
  Blocks blocks = map.sorted_blocks();
  std::erase_if(blocks,
                [](const VoxelBlock* b) { return std::ranges::none_of(b->voxels, is_known); });
  return blocks;
}

std::uint16_t version_for(const Blocks& blocks) {
  const auto has_ignorance = [](const Voxel& v) { return is_known(v) && v.ignorance > 0; };
  const bool any = std::ranges::any_of(
      blocks, [&](const VoxelBlock* b) { return std::ranges::any_of(b->voxels, has_ignorance); });
  return any ? kVersionWithIgnorance : kFirstVersion;
}

std::string compress(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kCompressionLevel);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

void write_with_checksum(std::ostream& out, std::string bytes) {
  append_number(bytes, crc32c(bytes));
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void write_header(std::ostream& out, const VoxelMap& map, const Blocks& blocks,
                  std::uint16_t version) {
  const Header header{.voxel_size_m = map.voxel_size_m(),
                      .floor_z_m = map.floor_z_m(),
                      .has_epoch = map.epoch_ns.has_value(),
                      .epoch_ns = map.epoch_ns.value_or(0),
                      .frames_integrated = map.frames_integrated,
                      .blocks = blocks.size(),
                      .known_voxels = map.known_voxel_count(),
                      .attachments = static_cast<std::uint32_t>(map.attachments.size())};
  std::string bytes(kMagic);
  append_number(bytes, version);
  Header::each(header, [&](auto value) { append_number(bytes, value); });
  write_with_checksum(out, std::move(bytes));
}

void write_section(std::ostream& out, std::uint32_t blocks, std::string_view content) {
  const std::string compressed = compress(content);
  std::string bytes;
  append_number(bytes, blocks);
  append_number(bytes, static_cast<std::uint32_t>(content.size()));
  append_number(bytes, static_cast<std::uint32_t>(compressed.size()));
  write_with_checksum(out, bytes + compressed);
}

std::string encode_attachments(const VoxelMap& map) {
  std::string bytes;
  for (const auto& [name, blob] : map.attachments)
    for (const std::string& text : {name, blob}) {
      append_number(bytes, static_cast<std::uint32_t>(text.size()));
      bytes += text;
      if (bytes.size() > kMaxAttachmentBytes)
        throw Error(fmt::format("attachment '{}': attachments exceed {} bytes together", name,
                                kMaxAttachmentBytes));
    }
  return bytes;
}

// ---- reading

// Turns complaints about the content of a part into an Error that names the file and the part.
template <class Body>
auto decode(const std::string& name, const std::string& part, Body body) {
  const auto as_error = [&](const std::exception& e) {
    return Error(fmt::format("{}: {}: {}", name, part, e.what()));
  };
  try {
    return body();
  } catch (const std::runtime_error& error) {
    throw as_error(error);
  } catch (const std::out_of_range& error) {
    throw as_error(error);
  }
}

class MapReader {
 public:
  MapReader(std::istream& in, const std::string& name) : in_(in), name_(name) {}

  VoxelMap read() {
    const Header header = read_header();
    VoxelMap map = decode(name_, "header", [&] {
      if (header.has_epoch > 1) throw std::runtime_error("flag of the epoch is neither 0 nor 1");
      return VoxelMap(header.voxel_size_m, header.floor_z_m);
    });
    if (header.has_epoch != 0) map.epoch_ns = header.epoch_ns;
    map.frames_integrated = header.frames_integrated;
    if (header.attachments > 0) read_attachments(header.attachments, map);
    read_blocks(header, map);
    if (in_.peek() != std::istream::traits_type::eof()) fail("bytes follow the end of the map");
    return map;
  }

 private:
  struct Section {
    std::uint32_t blocks = 0;
    std::string content;
  };

  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }

  // Grows with the bytes that really come, so that a wrong size cannot ask for much memory.
  std::string take(std::size_t size) {
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

  void check_sum(std::string_view bytes, const std::string& part) {
    const std::string sum = take(sizeof(std::uint32_t));
    if (ByteReader(sum).number<std::uint32_t>() != crc32c(bytes))
      fail(part + " is damaged (its checksum does not match)");
  }

  Header read_header() {
    Header header;
    std::size_t size = 0;
    Header::each(header, [&](auto& value) { size += sizeof(value); });
    std::string bytes = take(kMagic.size() + sizeof(kFirstVersion));
    if (!bytes.starts_with(kMagic)) fail("is not a stereovox map");
    const auto version =
        ByteReader(std::string_view(bytes).substr(kMagic.size())).number<std::uint16_t>();
    if (version < kFirstVersion || version > kVersionWithIgnorance)
      fail(fmt::format("has format version {}, this program reads versions {} to {}", version,
                       kFirstVersion, kVersionWithIgnorance));
    fields_ = fields_of(version);
    const std::string fields = take(size);
    check_sum(bytes + fields, "header");
    ByteReader reader(fields);
    Header::each(header, [&](auto& value) {
      value = reader.number<std::remove_reference_t<decltype(value)>>();
    });
    return header;
  }

  Section read_section(const std::string& part, std::size_t max_bytes) {
    std::string bytes = take(3 * sizeof(std::uint32_t));
    ByteReader reader(bytes);
    const auto blocks = reader.number<std::uint32_t>();
    const auto size = reader.number<std::uint32_t>(), compressed = reader.number<std::uint32_t>();
    if (size > max_bytes || compressed > ZSTD_compressBound(size))
      fail(fmt::format("{} claims {} bytes, {} compressed; at most {} are possible", part, size,
                       compressed, max_bytes));
    bytes += take(compressed);
    check_sum(bytes, part);
    return {blocks,
            decompress(std::string_view(bytes).substr(bytes.size() - compressed), size, part)};
  }

  std::string decompress(std::string_view bytes, std::size_t size, const std::string& part) const {
    std::string out(size, '\0');
    if (ZSTD_decompress(out.data(), size, bytes.data(), bytes.size()) != size)
      fail(part + " cannot be decompressed");
    return out;
  }

  void read_attachments(std::uint32_t count, VoxelMap& map) {
    const Section section = read_section("attachments", kMaxAttachmentBytes);
    decode(name_, "attachments", [&] {
      ByteReader reader(section.content);
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::string key(reader.take(reader.number<std::uint32_t>()));
        map.attachments[key] = reader.take(reader.number<std::uint32_t>());
      }
      if (!reader.is_at_end() || map.attachments.size() != count)
        throw std::runtime_error(fmt::format("are not {}", count));
    });
  }

  void read_blocks(const Header& header, VoxelMap& map) {
    std::uint64_t known = 0;
    const VoxelBlock* last = nullptr;
    for (std::uint64_t chunk = 0; map.block_count() < header.blocks; ++chunk) {
      const std::string part = fmt::format("chunk {}", chunk);
      const Section section = read_section(part, max_chunk_bytes(fields_));
      const std::uint64_t missing = header.blocks - map.block_count();
      if (section.blocks != std::min<std::uint64_t>(missing, kMaxBlocksPerChunk))
        fail(fmt::format("{} holds {} blocks of {} missing ones", part, section.blocks, missing));
      decode(name_, part, [&] {
        const DecodedChunk decoded =
            decode_chunk(section.content, fields_, static_cast<int>(section.blocks), last, map);
        known += decoded.known_voxels;
        last = decoded.last_block;
      });
    }
    if (known != header.known_voxels)
      fail(fmt::format("holds {} known voxels, its header says {}", known, header.known_voxels));
  }

  std::istream& in_;
  const std::string& name_;
  VoxelFields fields_ = VoxelFields::without_ignorance;
};

}  // namespace

void write_voxel_map(std::ostream& out, const VoxelMap& map) {
  const Blocks blocks = blocks_to_write(map);
  const std::uint16_t version = version_for(blocks);
  write_header(out, map, blocks, version);
  if (!map.attachments.empty()) write_section(out, 0, encode_attachments(map));
  for (std::size_t i = 0; i < blocks.size(); i += kMaxBlocksPerChunk) {
    const std::size_t count = std::min<std::size_t>(kMaxBlocksPerChunk, blocks.size() - i);
    write_section(out, static_cast<std::uint32_t>(count),
                  encode_chunk(std::span(blocks).subspan(i, count), fields_of(version)));
  }
}

void write_voxel_map(const std::filesystem::path& path, const VoxelMap& map) {
  write_file_atomically(path, [&](std::ostream& out) { write_voxel_map(out, map); });
}

VoxelMap read_voxel_map(std::istream& in, const std::string& name) {
  return MapReader(in, name).read();
}

VoxelMap read_voxel_map(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path.string() + ": cannot be opened");
  return read_voxel_map(file, path.string());
}

}  // namespace stereovox
