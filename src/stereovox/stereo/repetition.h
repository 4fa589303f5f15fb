// Where the image repeats itself along its rows, a surface at another disparity would look nearly
// the same, and the paths of semi-global matching choose by what they met before the pattern began.
// The image is cut into blocks; in each the costs are averaged along the surface that was found and
// along the same surface moved by s candidates. One that is moved so explains a block nearly as
// well as the one found where it repeats, and no better than any where it does not.
#pragma once

#include <cstdint>
#include <vector>

namespace stereovox {

struct PixelSpan {
  int begin, end;
  bool operator==(const PixelSpan&) const = default;
};

// A band of blocks side by side, filled row by row.
class RepetitionBand {
 public:
  static constexpr int kBlockWidth_px = 64, kBlockHeight_px = 32;
  // Every so many rows are enough: those beside each other see much the same.
  static constexpr int kRowStep_px = 4;

  RepetitionBand(int width_px, int candidates);

  // `cost` holds width x candidates costs, `winner` a candidate for each pixel. At most
  // kBlockHeight_px rows.
  void add_row(const std::uint8_t* cost, const std::uint8_t* winner);
  // Those blocks which repeat, then begins anew.
  std::vector<PixelSpan> take_repeating();

 private:
  static constexpr int kColumnStep_px = 4;

  struct Block {
    int samples = 0;
    std::vector<std::uint16_t> cost;  // of the surface moved by s, at s + candidates
    std::vector<int> winners;         // how many pixels each candidate won
  };

  bool repeats(const Block& block) const;

  const int width_px_, candidates_;
  std::vector<Block> blocks_;
};

}  // namespace stereovox
