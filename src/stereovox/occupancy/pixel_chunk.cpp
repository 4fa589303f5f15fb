// The loops below are written so that compilers turn them into vector instructions; each is
// compiled twice and the wider one is taken where the machine has it. Neither changes a bit.
#include "stereovox/occupancy/pixel_chunk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stereovox/occupancy/vector_target.h"

namespace stereovox {
namespace {

constexpr int kSize = PixelChunk::kSize;

struct ChunkLimits {
  MeasuringFrame measuring;
  FreeMargin margin;
  double min_depth_m, max_depth_m, min_z_m, max_z_m, max_sigma_m, exact_sigma_m, max_clearing_m;
};

ChunkLimits limits_of(const FrameView& frame) {
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

// What decides over the pixels, as numbers: 1 yes, 0 no.
struct ChunkAnswers {
  Doubles marks, is_exact, free_end_m;
};

// Where nothing is measured the numbers are nonsense until the end, when they are left out.
[[gnu::always_inline]] inline void measure_pixels(const ChunkLimits& limits,
                                                  const ChunkInput& pixels, const PixelRun& run,
                                                  ChunkAnswers& answers, PixelChunk& out) {
  const ChunkLimits l = limits;
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
    answers.is_exact[at] = sigma_m < l.exact_sigma_m ? 1.0 : 0.0;
    out.p_world_m[0][at] = marks ? x_m : 0.0;
    out.p_world_m[1][at] = marks ? y_m : 0.0;
    out.p_world_m[2][at] = marks ? z_m : 0.0;
    out.variance_m2[0][at] = marks ? covariance_m2(f, m, 0, 0) : 0.0;
    out.variance_m2[1][at] = marks ? covariance_m2(f, m, 1, 1) : 0.0;
    out.variance_m2[2][at] = marks ? covariance_m2(f, m, 2, 2) : 0.0;
  }
}

void store(const ChunkAnswers& answers, PixelChunk& out) {
  for (std::size_t i = 0; i < kSize; ++i) {
    out.marks[i] = answers.marks[i] != 0.0 ? 1 : 0;
    out.is_exact[i] = answers.is_exact[i] != 0.0 ? 1 : 0;
    out.free_end_m[i] = static_cast<float>(std::max(0.0, answers.free_end_m[i]));
  }
}

template <AxisModel Model>
[[gnu::always_inline]] inline void find_reach(const Model& model, const PixelChunk& chunk,
                                              double size_m, std::size_t k, AxisLevels& out,
                                              Doubles& inverse_ramp) {
  const double half_m = 0.5 * size_m;
  for (std::size_t i = 0; i < kSize; ++i) {
    const double p_m = chunk.p_world_m[k][i];
    const double ramp_m = model.axis_ramp_m(chunk.variance_m2[k][i]);
    const double reach_m = model.axis_reach_m(ramp_m, half_m);
    const auto first = static_cast<std::int32_t>(first_in_reach(p_m, reach_m, size_m));
    const auto last = static_cast<std::int32_t>(last_in_reach(p_m, reach_m, size_m));
    out.first[k][i] = first;
    out.count[k][i] = chunk.marks[i] != 0 ? last - first + 1 : 0;
    out.own[k][i] = static_cast<std::int32_t>(std::floor(p_m / size_m));
    inverse_ramp[i] = 1.0 / ramp_m;
  }
}

template <AxisModel Model>
[[gnu::always_inline]] inline void find_levels(const Model& model, const PixelChunk& chunk,
                                               double size_m, std::size_t k, int j,
                                               const Doubles& inverse_ramp, AxisLevels& out) {
  const double half_m = 0.5 * size_m;
  PixelChunk::PerPixel<std::int32_t> levels;
  for (std::size_t i = 0; i < kSize; ++i) {
    const double center_m = ((out.first[k][i] + j) + 0.5) * size_m;
    const auto evidence = static_cast<float>(
        model.axis_evidence(chunk.p_world_m[k][i] - center_m, half_m, inverse_ramp[i]));
    const int level = evidence > 0.0F ? VoxelEvidence::level_of(evidence) + 1 : 0;
    levels[i] = j < out.count[k][i] ? level : 0;
  }
  PixelChunk::PerPixel<std::uint8_t>& stored = out.levels[k][static_cast<std::size_t>(j)];
  for (std::size_t i = 0; i < kSize; ++i) stored[i] = static_cast<std::uint8_t>(levels[i]);
}

// How the voxels near a point lie in their blocks.
[[gnu::always_inline]] inline void find_positions(AxisLevels& out) {
  constexpr int kInside = kBlockSide - 1;
  for (std::size_t i = 0; i < kSize; ++i) {
    const int x = out.first[0][i] & kInside, y = out.first[1][i] & kInside;
    const int z = out.first[2][i] & kInside;
    out.first_position[i] = x | y << kBlockSideLog2 | z << 2 * kBlockSideLog2;
    const bool is_in_one = (x + out.count[0][i] <= kBlockSide) &
                           (y + out.count[1][i] <= kBlockSide) &
                           (z + out.count[2][i] <= kBlockSide);
    out.is_in_one_block[i] = is_in_one ? 1 : 0;
  }
}

[[gnu::always_inline]] inline void find_only_ones(AxisLevels& out) {
  out.only_level.fill(-1);
  if (out.largest_count[0] == 0) return;
  const auto& x = out.levels[0][0];
  const auto& y = out.levels[1][0];
  const auto& z = out.levels[2][0];
  for (std::size_t i = 0; i < kSize; ++i) {
    const bool is_only = (out.count[0][i] == 1) & (out.count[1][i] == 1) & (out.count[2][i] == 1);
    const int level_xy = x[i] < y[i] ? x[i] : y[i];
    const int level = level_xy < z[i] ? level_xy : z[i];
    const bool is_own = (out.first[0][i] == out.own[0][i]) & (out.first[1][i] == out.own[1][i]) &
                        (out.first[2][i] == out.own[2][i]);
    out.only_level[i] = is_only ? level : -1;
    out.is_only_own[i] = is_own ? 1 : 0;
  }
}

template <AxisModel Model>
[[gnu::always_inline]] inline void find_all_levels(const Model& model, const PixelChunk& chunk,
                                                   double size_m, AxisLevels& out) {
  for (std::size_t k = 0; k < 3; ++k) {
    Doubles inverse_ramp;
    find_reach(model, chunk, size_m, k, out, inverse_ramp);
    std::int32_t largest = 0;
    for (const std::int32_t count : out.count[k]) largest = std::max(largest, count);
    out.largest_count[k] = largest;
    if (out.levels[k].size() < static_cast<std::size_t>(largest))
      out.levels[k].resize(static_cast<std::size_t>(largest));
    for (int j = 0; j < largest; ++j) find_levels(model, chunk, size_m, k, j, inverse_ramp, out);
  }
  find_positions(out);
  find_only_ones(out);
}

struct MeasurePixels {
  template <class... Arguments>
  [[gnu::always_inline]] void operator()(Arguments&... arguments) const {
    measure_pixels(arguments...);
  }
};

struct FindAllLevels {
  template <class... Arguments>
  [[gnu::always_inline]] void operator()(Arguments&... arguments) const {
    find_all_levels(arguments...);
  }
};

}  // namespace

void measure_chunk(const FrameView& frame, const PixelRun& run, PixelChunk& chunk) {
  chunk.count = run.count;
  const ChunkLimits limits = limits_of(frame);
  const ChunkInput in = input_of(frame.disparity, run);
  ChunkAnswers answers;
  on_best_target(MeasurePixels{}, limits, in, run, answers, chunk);
  store(answers, chunk);
}

void compute_levels(const MinRampObservation& model, const PixelChunk& chunk, double voxel_size_m,
                    AxisLevels& out) {
  on_best_target(FindAllLevels{}, model, chunk, voxel_size_m, out);
}

void compute_levels(const PointObservation& model, const PixelChunk& chunk, double voxel_size_m,
                    AxisLevels& out) {
  on_best_target(FindAllLevels{}, model, chunk, voxel_size_m, out);
}

}  // namespace stereovox
