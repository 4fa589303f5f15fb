// The loops below are written so that compilers turn them into vector instructions; each is
// compiled twice and the wider one is taken where the machine has it. Neither changes a bit.
#include "stereovox/occupancy/pixel_chunk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stereovox/occupancy/voxel_mask.h"

namespace stereovox {
namespace {

constexpr int kSize = PixelChunk::kSize;

using Doubles = PixelChunk::PerPixel<double>;

using Floats = PixelChunk::PerPixel<float>;

struct ChunkInput {
  Floats disparity_px{}, sigma_px{};  // 0 beyond the end of the run
};

ChunkInput input_of(const DisparityImage& image, const PixelRun& run) {
  ChunkInput in;
  const float* const disparities = image.disparity_px[run.v_px] + run.first_u_px;
  const float* const sigmas = image.sigma_px[run.v_px] + run.first_u_px;
  if (run.step_px == 1) {
    std::copy_n(disparities, run.count, in.disparity_px.data());
    std::copy_n(sigmas, run.count, in.sigma_px.data());
    return in;
  }
  for (int i = 0; i < run.count; ++i) {
    in.disparity_px[static_cast<std::size_t>(i)] = disparities[i * run.step_px];
    in.sigma_px[static_cast<std::size_t>(i)] = sigmas[i * run.step_px];
  }
  return in;
}

struct Disparities {
  Doubles disparity_px, error_px;  // 0 where not a measurement
};

[[gnu::always_inline]] inline void check_pixels(const MeasuringFrame& f, const ChunkInput& in,
                                                Disparities& out) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const double min_sigma_px = f.min_sigma_px;
  for (std::size_t i = 0; i < kSize; ++i) {
    const float disparity_px = in.disparity_px[i], sigma_px = in.sigma_px[i];
    const bool is_number = (disparity_px > 0.0F) & (disparity_px <= kLargest) & (sigma_px >= 0.0F) &
                           (sigma_px <= kLargest);
    const float disparity = is_number ? disparity_px : 0.0F;
    const double sigma = is_number ? sigma_px : 0.0F;
    out.disparity_px[i] = disparity;
    out.error_px[i] = sigma > min_sigma_px ? sigma : min_sigma_px;
  }
  if (f.is_sigma_a_variance)
    for (double& error_px : out.error_px) error_px = std::sqrt(error_px);
}

// The answers of some pixels, as numbers: 1 yes, 0 no.
struct ChunkAnswers {
  Doubles marks, is_exact, free_end_m;
};

// Where nothing is measured the numbers are nonsense until the end, when they are left out.
[[gnu::always_inline]] inline void measure_pixels(const PixelLimits& limits,
                                                  const ChunkInput& pixels, const PixelRun& run,
                                                  ChunkAnswers& answers, PixelChunk& out) {
  const PixelLimits l = limits;
  const MeasuringFrame& f = l.measuring;
  Disparities in;
  check_pixels(f, pixels, in);
  for (int i = 0; i < kSize; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double u_px = run.first_u_px + i * run.step_px;
    const PixelMeasurement m = measure(f, u_px, run.v_px, in.disparity_px[at], in.error_px[at]);
    const double sigma_m = std::sqrt(m.variance_range_m2);
    const double x_m = position_m(f, m, 0), y_m = position_m(f, m, 1), z_m = position_m(f, m, 2);

    const bool is_measured =
        (in.disparity_px[at] > 0.0) & (m.depth_m >= l.min_depth_m) & (z_m >= l.min_z_m);
    const bool marks = is_measured & (m.depth_m <= l.max_depth_m) & (sigma_m <= l.max_sigma_m) &
                       (z_m <= l.max_z_m);
    const double end_m = m.range_m - l.margin.of(sigma_m);
    const double within_m = end_m < l.max_clearing_m ? end_m : l.max_clearing_m;
    answers.free_end_m[at] = is_measured ? within_m : 0.0;
    answers.marks[at] = marks ? 1.0 : 0.0;
    answers.is_exact[at] = marks & (sigma_m < l.exact_sigma_m) ? 1.0 : 0.0;
    out.p_world_m[0][at] = marks ? x_m : 0.0;
    out.p_world_m[1][at] = marks ? y_m : 0.0;
    out.p_world_m[2][at] = marks ? z_m : 0.0;
    out.variance_m2[0][at] = marks ? covariance_m2(f, m, 0, 0) : 0.0;
    out.variance_m2[1][at] = marks ? covariance_m2(f, m, 1, 1) : 0.0;
    out.variance_m2[2][at] = marks ? covariance_m2(f, m, 2, 2) : 0.0;
  }
}

[[gnu::always_inline]] inline void store(const ChunkAnswers& answers, PixelChunk& out) {
  for (std::size_t i = 0; i < kSize; ++i) {
    out.marks[i] = answers.marks[i] != 0.0 ? 1 : 0;
    out.is_exact[i] = answers.is_exact[i] != 0.0 ? 1 : 0;
    out.free_end_m[i] = static_cast<float>(std::max(0.0, answers.free_end_m[i]));
  }
}

using Integers = PixelChunk::PerPixel<std::int32_t>;

// The voxels of the points along one axis; those that mark nothing have none.
struct AxisReach {
  Integers count, own;
  Doubles inverse_ramp;
};

template <AxisModel Model>
[[gnu::always_inline]] inline void find_reach(const Model& model, const PixelChunk& chunk,
                                              double size_m, std::size_t k, Integers& first_voxel,
                                              AxisReach& out) {
  const double half_m = 0.5 * size_m;
  for (std::size_t i = 0; i < kSize; ++i) {
    const double p_m = chunk.p_world_m[k][i];
    const double ramp_m = model.axis_ramp_m(chunk.variance_m2[k][i]);
    const double reach_m = model.axis_reach_m(ramp_m, half_m);
    const auto first = static_cast<std::int32_t>(first_in_reach(p_m, reach_m, size_m));
    const auto last = static_cast<std::int32_t>(last_in_reach(p_m, reach_m, size_m));
    first_voxel[i] = first;
    out.count[i] = chunk.marks[i] != 0 ? last - first + 1 : 0;
    out.own[i] = static_cast<std::int32_t>(std::floor(p_m / size_m));
    out.inverse_ramp[i] = 1.0 / ramp_m;
  }
}

template <AxisModel Model>
[[gnu::always_inline]] inline void find_levels(const Model& model, const PixelChunk& chunk,
                                               double size_m, std::size_t k, int j,
                                               const Integers& first, const AxisReach& reach,
                                               AxisVoxels& out) {
  const double half_m = 0.5 * size_m;
  Integers levels;
  for (std::size_t i = 0; i < kSize; ++i) {
    const double center_m = ((first[i] + j) + 0.5) * size_m;
    const auto evidence = static_cast<float>(
        model.axis_evidence(chunk.p_world_m[k][i] - center_m, half_m, reach.inverse_ramp[i]));
    const int level = evidence > 0.0F ? VoxelEvidence::level_of(evidence) + 1 : 0;
    levels[i] = j < reach.count[i] ? level : 0;
  }
  for (std::size_t i = 0; i < kSize; ++i) out.level[i] = static_cast<std::uint8_t>(levels[i]);
}

[[gnu::always_inline]] inline void find_places(std::size_t k, int j, const Integers& first,
                                               const AxisReach& reach, AxisVoxels& out) {
  constexpr int kInside = kBlockSide - 1;
  const int shift = static_cast<int>(k) * kBlockSideLog2;
  for (std::size_t i = 0; i < kSize; ++i) {
    const int voxel = first[i] + j;
    out.place[i] = static_cast<std::uint16_t>((voxel & kInside) << shift);
    out.is_own[i] = (voxel == reach.own[i]) & (j < reach.count[i]) ? 1 : 0;
  }
  PixelChunk::PerPixel<std::uint8_t> changes{};
  for (std::size_t i = 1; i < kSize; ++i)
    changes[i] = (first[i] + j) >> kBlockSideLog2 != (first[i - 1] + j) >> kBlockSideLog2 ? 1 : 0;
  out.changes_block = bits_of_bytes(changes);
}

template <AxisModel Model>
[[gnu::always_inline]] inline void find_all_levels(const Model& model, const PixelChunk& chunk,
                                                   double size_m, AxisLevels& out) {
  for (std::size_t k = 0; k < 3; ++k) {
    AxisReach reach;
    find_reach(model, chunk, size_m, k, out.first[k], reach);
    std::int32_t largest = 0;
    for (const std::int32_t count : reach.count) largest = std::max(largest, count);
    out.largest_count[k] = largest;
    if (out.voxels[k].size() < static_cast<std::size_t>(largest))
      out.voxels[k].resize(static_cast<std::size_t>(largest));
    for (int j = 0; j < largest; ++j) {
      AxisVoxels& voxels = out.voxels[k][static_cast<std::size_t>(j)];
      find_levels(model, chunk, size_m, k, j, out.first[k], reach, voxels);
      find_places(k, j, out.first[k], reach, voxels);
    }
  }
}

[[gnu::always_inline]] inline void find_own(const PixelChunk& chunk, double size_m, OwnVoxels& out,
                                            PixelChunk::PerPixel<std::uint8_t>& is_new) {
  constexpr int kInside = kBlockSide - 1;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < kSize; ++i)
      out.voxel[k][i] = static_cast<std::int32_t>(std::floor(chunk.p_world_m[k][i] / size_m));
  const auto& [x, y, z] = out.voxel;
  for (std::size_t i = 0; i < kSize; ++i)
    out.position[i] = (x[i] & kInside) | (y[i] & kInside) << kBlockSideLog2 |
                      (z[i] & kInside) << 2 * kBlockSideLog2;
  is_new[0] = 1;
  for (std::size_t i = 1; i < kSize; ++i) {
    const int differs = (x[i] ^ x[i - 1]) | (y[i] ^ y[i - 1]) | (z[i] ^ z[i - 1]);
    is_new[i] = differs != 0 ? 1 : 0;
  }
}

struct MeasurePixels {
  [[gnu::always_inline]] void operator()(const PixelLimits& limits, const ChunkInput& in,
                                         const PixelRun& run, PixelChunk& out) const {
    ChunkAnswers answers;
    measure_pixels(limits, in, run, answers, out);
    store(answers, out);
  }
};

struct FindOwn {
  template <class... Arguments>
  [[gnu::always_inline]] void operator()(Arguments&... arguments) const {
    find_own(arguments...);
  }
};

struct FindAllLevels {
  template <class... Arguments>
  [[gnu::always_inline]] void operator()(Arguments&... arguments) const {
    find_all_levels(arguments...);
  }
};

}  // namespace

PixelLimits pixel_limits(const FrameView& frame) {
  const OccupancyParams& p = frame.params;
  const double half_voxel_m = 0.5 * p.voxel_size_m;
  return {.measuring = frame.measuring,
          .margin = free_margin(frame),
          .min_depth_m = p.min_depth_m,
          .max_depth_m = p.max_depth_m,
          .min_z_m = frame.min_z_m,
          .max_z_m = frame.max_z_m,
          .max_sigma_m = max_sigma_m(p),
          .exact_sigma_m = half_voxel_m,
          .max_clearing_m = p.max_clearing_m};
}

void measure_chunk(const DisparityImage& image, const PixelLimits& limits, const PixelRun& run,
                   PixelChunk& chunk, VectorTarget target) {
  chunk.count = run.count;
  const ChunkInput in = input_of(image, run);
  run_on(target, MeasurePixels{}, limits, in, run, chunk);
}

void find_own_voxels(const PixelChunk& chunk, double voxel_size_m, OwnVoxels& out,
                     VectorTarget target) {
  PixelChunk::PerPixel<std::uint8_t> is_new;
  run_on(target, FindOwn{}, chunk, voxel_size_m, out, is_new);
  const std::uint64_t exact = bits_of_bytes(chunk.is_exact);
  out.marks = bits_of_bytes(chunk.marks);
  out.begins_run = out.marks & (bits_of_bytes(is_new) | (exact ^ exact << 1) | ~(out.marks << 1));
}

void compute_levels(const MinRampObservation& model, const PixelChunk& chunk, double voxel_size_m,
                    AxisLevels& out, VectorTarget target) {
  run_on(target, FindAllLevels{}, model, chunk, voxel_size_m, out);
}

}  // namespace stereovox
