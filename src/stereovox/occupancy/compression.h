// Bytes made small and back (zstd). Equal bytes give equal compressed bytes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace stereovox {

std::string compressed(std::string_view bytes);

// The most that so many bytes can become.
std::size_t max_compressed_bytes(std::size_t bytes);

// Throws std::runtime_error when the result is not `size` bytes.
std::string decompressed(std::string_view bytes, std::size_t size);

}  // namespace stereovox
