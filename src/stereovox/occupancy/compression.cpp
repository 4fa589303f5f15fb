#include "stereovox/occupancy/compression.h"

#include <zstd.h>

#include <stdexcept>

namespace stereovox {
namespace {

constexpr int kLevel = 1;  // higher ones are slower and hardly smaller on byte planes

}  // namespace

std::string compressed(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

std::size_t max_compressed_bytes(std::size_t bytes) { return ZSTD_compressBound(bytes); }

std::string decompressed(std::string_view bytes, std::size_t size) {
  std::string out(size, '\0');
  if (ZSTD_decompress(out.data(), size, bytes.data(), bytes.size()) != size)
    throw std::runtime_error("cannot be decompressed");
  return out;
}

}  // namespace stereovox
