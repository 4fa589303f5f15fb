// The loops of census_kernels.h for one kind of vector of bytes; included by one file for each
// kind.
#pragma once

#include "stereovox/stereo/census_kernels.h"

namespace stereovox {
namespace {

inline constexpr int kMaxByte = 255;
// Added (saturating) to the sums of all candidates, from here on at candidate 0, this takes three
// neighbours out of the race.
struct ThreeOut {
  std::uint8_t bytes[2 * kMaxCandidates + kRowSlack] = {};
  constexpr ThreeOut() {
    for (int i = -1; i <= 1; ++i) bytes[kMaxCandidates + i] = kMaxByte;
  }
};
constexpr ThreeOut kThreeOut;

inline constexpr int kLevelSlope = 128;

// Change of brightness along the row, smoothed across it, as kLevelSlope plus what is left of it
// after clipping.
template <class S>
typename S::V slope(const std::uint8_t* const* rows, int x) {
  using V = typename S::V;
  const auto smooth = [&](int column) {
    const V above = S::load(rows[kCensusHalfHeight_px - 1] + column);
    const V below = S::load(rows[kCensusHalfHeight_px + 1] + column);
    return S::mean(S::load(rows[kCensusHalfHeight_px] + column), S::mean(above, below));
  };
  const V before = smooth(x - 1), after = smooth(x + 1), limit = S::spread(kMaxSlope_gray);
  const V rise = S::min(S::subtract_saturated(after, before), limit);
  const V fall = S::min(S::subtract_saturated(before, after), limit);
  return S::subtract(S::add(S::spread(kLevelSlope), rise), fall);
}

template <class S>
void census_row(const std::uint8_t* const* rows, int width_px, const PixelRow& out) {
  using V = typename S::V;
  for (int x = 0; x < width_px; x += S::kSize) {
    V plane = S::spread(0);
    int k = 0;
    const auto take = [&](int dx, int dy) {
      const V upper = S::load(rows[kCensusHalfHeight_px + dy] + x + dx);
      const V lower = S::load(rows[kCensusHalfHeight_px - dy] + x - dx);
      const auto bit = static_cast<std::uint8_t>(1 << (k % 8));
      plane = S::either(plane, S::both(S::is_at_least(upper, lower), S::spread(bit)));
      ++k;
      if (k % 8 != 0 && k != kCensusBits) return;
      S::store(out.planes[(k - 1) / 8] + x, plane);
      plane = S::spread(0);
    };
    for (int dy = -kCensusHalfHeight_px; dy < 0; ++dy)
      for (int dx = -kCensusHalfWidth_px; dx <= kCensusHalfWidth_px; ++dx) take(dx, dy);
    for (int dx = -kCensusHalfWidth_px; dx < 0; ++dx) take(dx, 0);
    S::store(out.planes[kSlopePlane] + x, slope<S>(rows, x));
  }
}

// Hamming distance of two census words that lie in four planes of bytes. Carry-save adders bring
// the four planes to one of weight 1 and two of weight 2 before the ones are counted.
template <class S>
typename S::V hamming(const typename S::V (&left)[kPlanes], const PixelRow& right, int at) {
  using V = typename S::V;
  const V a = S::differ(left[0], S::load(right.planes[0] + at));
  const V b = S::differ(left[1], S::load(right.planes[1] + at));
  const V c = S::differ(left[2], S::load(right.planes[2] + at));
  const V d = S::differ(left[3], S::load(right.planes[3] + at));
  const V a_or_b = S::differ(a, b);
  const V abc = S::differ(a_or_b, c);
  const V carry_abc = S::either(S::both(a, b), S::both(c, a_or_b));
  const V twos = S::add(S::count_ones(carry_abc), S::count_ones(S::both(abc, d)));
  return S::add(S::count_ones(S::differ(abc, d)), S::add(twos, twos));
}

template <class S>
typename S::V slope_cost(typename S::V left, const PixelRow& right, int at) {
  using V = typename S::V;
  const V there = S::load(right.planes[kSlopePlane] + at);
  const V difference =
      S::either(S::subtract_saturated(left, there), S::subtract_saturated(there, left));
  static_assert(kSlopeWeight == 2);
  return S::min(S::add_saturated(difference, difference), S::spread(kMaxSlopeCost));
}

template <class S>
typename S::V difference(const typename S::V (&left)[kPlanes], const PixelRow& right, int at) {
  return S::mean(hamming<S>(left, right, at), slope_cost<S>(left[kSlopePlane], right, at));
}

// The costs of all candidates of one pixel on a path, and their smallest.
template <class S, int N>
struct PathState {
  typename S::V cost[N];
  typename S::V smallest;  // in every byte
};

template <class S, int N>
PathState<S, N> start_of_path() {
  PathState<S, N> state;
  for (auto& cost : state.cost) cost = S::spread(0);
  state.smallest = S::spread(0);
  return state;
}

// The next pixel of a path that is kept in registers.
template <class S, int N>
void step_along_row(const typename S::V (&cost)[N], typename S::V small, typename S::V large,
                    PathState<S, N>& path) {
  using V = typename S::V;
  const V wall = S::spread(kMaxByte);
  const V jump = S::add_saturated(path.smallest, large);
  V before = wall, all = wall;
  for (int n = 0; n < N; ++n) {
    const V here = path.cost[n];
    const V lower = S::from_before(before, here);
    const V upper = S::from_after(here, n + 1 < N ? path.cost[n + 1 < N ? n + 1 : n] : wall);
    const V beside = S::add_saturated(S::min(lower, upper), small);
    const V best = S::min(S::min(here, jump), beside);
    path.cost[n] = S::add(cost[n], S::subtract(best, path.smallest));
    before = here;
    all = S::min(all, path.cost[n]);
  }
  path.smallest = S::min_of_all(all);
}

// The next pixel of a path from above, in place: `kept` holds the candidates of the pixel that it
// comes from, above their minimum, between walls. Adds to the sums.
template <class S, int N>
void step_from_above(const typename S::V (&cost)[N], typename S::V small, typename S::V large,
                     std::uint8_t* kept, typename S::V (&sum)[N]) {
  using V = typename S::V;
  V next[N];
  V all = S::spread(kMaxByte);
  for (int n = 0; n < N; ++n) {
    std::uint8_t* const at = kept + n * S::kSize;
    const V beside = S::add_saturated(S::min(S::load(at - 1), S::load(at + 1)), small);
    next[n] = S::add(cost[n], S::min(S::min(S::load(at), large), beside));
    all = S::min(all, next[n]);
    sum[n] = S::add_saturated(sum[n], next[n]);
  }
  const V smallest = S::min_of_all(all);
  for (int n = 0; n < N; ++n) S::store(kept + n * S::kSize, S::subtract(next[n], smallest));
}

template <class S, int kCandidates>
void differences_row(int width_px, const PixelRow& left, const PixelRow& right, std::uint8_t* out) {
  constexpr int N = kCandidates / S::kSize;
  using V = typename S::V;
  V before[N], here[N];
  for (int x = 0; x <= width_px; ++x) {
    V words[kPlanes], after[N];
    const int column = x < width_px ? x : width_px - 1;
    for (int p = 0; p < kPlanes; ++p) words[p] = S::spread(left.planes[p][column]);
    for (int n = 0; n < N; ++n) {
      after[n] = difference<S>(words, right, column + n * S::kSize);
      if (x == 0) before[n] = here[n] = after[n];
      if (x > 0)
        S::store(out + (x - 1) * kCandidates + n * S::kSize,
                 S::mean(here[n], S::mean(before[n], after[n])));
      before[n] = here[n];
      here[n] = after[n];
    }
  }
}

template <class S, int kCandidates>
void sweep_forward(const SweepRow& row) {
  constexpr int N = kCandidates / S::kSize;
  using V = typename S::V;
  const V small = S::spread(row.small_penalty);
  PathState<S, N> from_left = start_of_path<S, N>();
  std::array<int, 3> slot = row.first_slot;
  for (int x = 0; x < row.width_px; ++x) {
    V cost[N], sum[N];
    for (int n = 0; n < N; ++n) {
      const int at = x * kCandidates + n * S::kSize;
      cost[n] =
          S::mean(S::load(row.differences[1] + at),
                  S::mean(S::load(row.differences[0] + at), S::load(row.differences[2] + at)));
      S::store(row.cost + at, cost[n]);
    }
    step_along_row<S, N>(cost, small, S::spread(row.penalty_beside[x]), from_left);
    for (int n = 0; n < N; ++n) sum[n] = from_left.cost[n];
    for (int k = 0; k < 3; ++k) {
      std::uint8_t* const kept =
          row.paths_above[k] + slot[k] * (kCandidates + kPathWall) + kPathWall;
      step_from_above<S, N>(cost, small, S::spread(row.penalty_above[k][x]), kept, sum);
      slot[k] = slot[k] + 1 == row.width_px ? 0 : slot[k] + 1;
    }
    std::uint8_t* const sums = row.sum + x * kCandidates;
    for (int n = 0; n < N; ++n) S::store(sums + n * S::kSize, sum[n]);
  }
}

template <class S, int N>
int first_equal(const typename S::V (&sum)[N], typename S::V smallest) {
  int found = 0;
  for (int n = N - 1; n >= 0; --n) {
    const std::uint32_t bits = S::equal_bits(sum[n], smallest);
    found = bits != 0 ? n * S::kSize + __builtin_ctz(bits) : found;
  }
  return found;
}

template <class S, int N>
void find_winner(const typename S::V (&sum)[N], int x, const WinnerPointers& out) {
  using V = typename S::V;
  V all = sum[0];
  for (int n = 1; n < N; ++n) all = S::min(all, sum[n]);
  const V smallest = S::min_of_all(all);
  const int best = first_equal<S, N>(sum, smallest);
  V others = S::spread(kMaxByte);
  for (int n = 0; n < N; ++n)
    others = S::min(
        others, S::either(sum[n], S::load(kThreeOut.bytes + kMaxCandidates - best + n * S::kSize)));
  out.candidate[x] = static_cast<std::uint8_t>(best);
  out.cost[x] = S::first(smallest);
  out.second[x] = S::first(S::min_of_all(others));
}

template <class S, int kCandidates>
void sweep_backward(const SweepRow& row, const WinnerPointers& out) {
  constexpr int N = kCandidates / S::kSize;
  using V = typename S::V;
  const V small = S::spread(row.small_penalty);
  PathState<S, N> from_right = start_of_path<S, N>();
  for (int x = row.width_px - 1; x >= 0; --x) {
    V cost[N], sum[N];
    for (int n = 0; n < N; ++n) cost[n] = S::load(row.cost + x * kCandidates + n * S::kSize);
    const std::uint8_t penalty = row.penalty_beside[x + 1];
    step_along_row<S, N>(cost, small, S::spread(penalty), from_right);
    for (int n = 0; n < N; ++n)
      sum[n] =
          S::add_saturated(S::load(row.sum + x * kCandidates + n * S::kSize), from_right.cost[n]);
    find_winner<S, N>(sum, x, out);
  }
}

template <class S>
constexpr CensusKernels make_census_kernels() {
  return {.census = census_row<S>,
          .differences = {differences_row<S, 32>, differences_row<S, 64>, differences_row<S, 96>,
                          differences_row<S, 128>, differences_row<S, 160>, differences_row<S, 192>,
                          differences_row<S, 224>, differences_row<S, 256>},
          .forward = {sweep_forward<S, 32>, sweep_forward<S, 64>, sweep_forward<S, 96>,
                      sweep_forward<S, 128>, sweep_forward<S, 160>, sweep_forward<S, 192>,
                      sweep_forward<S, 224>, sweep_forward<S, 256>},
          .backward = {sweep_backward<S, 32>, sweep_backward<S, 64>, sweep_backward<S, 96>,
                       sweep_backward<S, 128>, sweep_backward<S, 160>, sweep_backward<S, 192>,
                       sweep_backward<S, 224>, sweep_backward<S, 256>}};
}

}  // namespace
}  // namespace stereovox
