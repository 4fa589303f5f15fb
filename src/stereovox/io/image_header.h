// What an image file says about itself, found out without decoding it. Decoders print to the
// terminal, invent the missing half of a cut-off JPEG or allocate what a header claims; so bytes
// are looked at here first.
#pragma once

#include <string>
#include <string_view>

namespace stereovox {

struct ImageHeader {
  std::string format;  // "PNG", "JPEG", "PNM", "BMP", "TIFF"
  int width = 0, height = 0;
  int max_value = 0;         // PNM: the brightest value; 0 = that of the pixel type
  bool has_palette = false;  // PNG
  bool is_grey = false;      // PNG: known to hold no colour, whatever the decoder gives
};

// Checks the structure from the first to the last byte that belongs to the image. Throws Error
// "<name>: is empty", "is cut off (<n> bytes)", "is damaged ...", "size is ...", "is not a PNG,
// ...". Sizes up to 64 megapixels are accepted.
ImageHeader inspect_image(std::string_view bytes, const std::string& name);

}  // namespace stereovox
