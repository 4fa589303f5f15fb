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
[[gnu::always_inline]] inline typename S::V slope(const std::uint8_t* const* rows, int x) {
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
[[gnu::always_inline]] inline typename S::V hamming(const typename S::V (&left)[kPlanes],
                                                    const PixelRow& right, int at) {
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
[[gnu::always_inline]] inline typename S::V slope_cost(typename S::V left, const PixelRow& right,
                                                       int at) {
  using V = typename S::V;
  const V there = S::load(right.planes[kSlopePlane] + at);
  const V difference =
      S::either(S::subtract_saturated(left, there), S::subtract_saturated(there, left));
  V weighted = difference;
  for (int i = 1; i < kSlopeWeight; ++i) weighted = S::add_saturated(weighted, difference);
  return S::min(weighted, S::spread(kMaxSlopeCost));
}

template <class S>
[[gnu::always_inline]] inline typename S::V matching_cost(const typename S::V (&left)[kPlanes],
                                                          const PixelRow& right, int at) {
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
[[gnu::always_inline]] inline void step_along_row(const typename S::V (&cost)[N],
                                                  typename S::V small, typename S::V large,
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
[[gnu::always_inline]] inline void step_from_above(const typename S::V (&cost)[N],
                                                   typename S::V small, typename S::V large,
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
void sweep_down(const SweepRow& row) {
  constexpr int N = kCandidates / S::kSize;
  using V = typename S::V;
  const V small = S::spread(row.small_penalty);
  std::array<int, 3> slot = row.first_slot;
  for (int x = 0; x < row.width_px; ++x) {
    V words[kPlanes], cost[N], sum[N];
    for (int p = 0; p < kPlanes; ++p) words[p] = S::spread(row.left.planes[p][x]);
    for (int n = 0; n < N; ++n) {
      cost[n] = matching_cost<S>(words, row.right, x + n * S::kSize);
      S::store(row.cost + x * kCandidates + n * S::kSize, cost[n]);
      sum[n] = S::spread(0);
    }
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
[[gnu::always_inline]] inline int first_equal(const typename S::V (&sum)[N],
                                              typename S::V smallest) {
  int found = 0;
  for (int n = N - 1; n >= 0; --n) {
    const std::uint64_t bits = S::equal_bits(sum[n], smallest);
    found = bits != 0 ? n * S::kSize + __builtin_ctzll(bits) : found;
  }
  return found;
}

// Local costs of all candidates about pixel x, summed over kLocalWidth_px pixels of the row.
template <class S, int kCandidates>
class LocalSums {
 public:
  LocalSums(const SweepRow& row, int x) : row_(row) {
    for (int n = 0; n < N; ++n) {
      sum_[n] = S::spread(0);
      for (int dx = -kHalf; dx <= kHalf; ++dx) sum_[n] = S::add(sum_[n], cost(x + dx, n));
    }
    for (std::uint8_t* const wall : {bytes_, bytes_ + kWall + kCandidates})
      for (int i = 0; i < kWall; ++i) wall[i] = kNoLocalCost;
  }

  // From the pixel before (direction 1) or after it (-1) to pixel x.
  void move_to(int x, int direction) {
    const int out = x - direction * (kHalf + 1), in = x + direction * kHalf;
    for (int n = 0; n < N; ++n) sum_[n] = S::add(S::subtract(sum_[n], cost(out, n)), cost(in, n));
  }

  // Moves the winner at x to the best of it and its two neighbours; of equals to itself, then to
  // the one before. Without branches, which nobody could predict.
  void choose(int x, const WinnerPointers& out) {
    for (int n = 0; n < N; ++n) S::store(bytes_ + kWall + n * S::kSize, sum_[n]);
    const std::uint8_t* const about = bytes_ + kWall + out.candidate[x];
    const int before = about[-1], here = about[0], after = about[1];
    const int is_before = before < here, is_after = after < (is_before != 0 ? before : here);
    const int step = is_after - (is_before & ~is_after);
    out.candidate[x] = static_cast<std::uint8_t>(out.candidate[x] + step);
    out.local_before[x] = about[step - 1];
    out.local[x] = about[step];
    out.local_after[x] = about[step + 1];
  }

 private:
  static constexpr int N = kCandidates / S::kSize, kHalf = kLocalWidth_px / 2, kWall = 32;

  typename S::V cost(int x, int n) const {
    const int last = row_.width_px - 1, column = x < 0 ? 0 : (x > last ? last : x);
    return S::load(row_.cost + column * kCandidates + n * S::kSize);
  }

  const SweepRow& row_;
  typename S::V sum_[N];
  std::uint8_t bytes_[kWall + kCandidates + kWall];
};

template <class S, int N>
[[gnu::always_inline]] inline void find_winner(const typename S::V (&sum)[N], int x,
                                               const WinnerPointers& out) {
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

// One of the two paths along the row. It comes to each pixel from the one at x - direction.
template <class S, int kCandidates>
class PathAlong {
 public:
  PathAlong(const SweepRow& row, int direction)
      : row_(row),
        direction_(direction),
        small_(S::spread(row.small_penalty)),
        path_(start_of_path<S, N>()) {}

  // Goes on to pixel x and adds to its sums.
  void pass(int x) {
    std::uint8_t* const sums = step(x);
    for (int n = 0; n < N; ++n)
      S::store(sums + n * S::kSize, S::add_saturated(S::load(sums + n * S::kSize), path_.cost[n]));
  }

  // Goes on to pixel x, whose sums want only this path, and finds its winner.
  void finish(int x, LocalSums<S, kCandidates>& local, const WinnerPointers& out) {
    const std::uint8_t* const sums = step(x);
    typename S::V sum[N];
    for (int n = 0; n < N; ++n)
      sum[n] = S::add_saturated(S::load(sums + n * S::kSize), path_.cost[n]);
    find_winner<S, N>(sum, x, out);
    local.move_to(x, direction_);
    local.choose(x, out);
  }

 private:
  static constexpr int N = kCandidates / S::kSize;

  std::uint8_t* step(int x) {
    typename S::V cost[N];
    for (int n = 0; n < N; ++n) cost[n] = S::load(row_.cost + x * kCandidates + n * S::kSize);
    const std::uint8_t penalty = row_.penalty_beside[direction_ > 0 ? x : x + 1];
    step_along_row<S, N>(cost, small_, S::spread(penalty), path_);
    return row_.sum + x * kCandidates;
  }

  const SweepRow& row_;
  const int direction_;
  const typename S::V small_;
  PathState<S, N> path_;
};

// Both paths go at once, because each of them alone waits for its last minimum most of the time.
// They meet in the middle; from there on each one comes to pixels that the other has passed.
template <class S, int kCandidates>
void sweep_along(const SweepRow& row, const WinnerPointers& out) {
  PathAlong<S, kCandidates> rightwards(row, 1), leftwards(row, -1);
  int right = 0, left = row.width_px - 1;
  for (; right < left; ++right, --left) {
    rightwards.pass(right);
    leftwards.pass(left);
  }
  const bool meet_at_a_pixel = right == left;
  if (meet_at_a_pixel) rightwards.pass(right++);
  LocalSums<S, kCandidates> local_right(row, right - 1), local_left(row, left + 1);
  if (meet_at_a_pixel) leftwards.finish(left--, local_left, out);
  for (; left >= 0; ++right, --left) {
    rightwards.finish(right, local_right, out);
    leftwards.finish(left, local_left, out);
  }
}

// Even is for numbers of candidates that are even multiples of kCandidateStep, Odd for the others.
template <class Odd, class Even = Odd>
constexpr CensusKernels make_census_kernels() {
  return {.census = census_row<Even>,
          .down = {sweep_down<Odd, 32>, sweep_down<Even, 64>, sweep_down<Odd, 96>,
                   sweep_down<Even, 128>, sweep_down<Odd, 160>, sweep_down<Even, 192>,
                   sweep_down<Odd, 224>, sweep_down<Even, 256>},
          .along = {sweep_along<Odd, 32>, sweep_along<Even, 64>, sweep_along<Odd, 96>,
                    sweep_along<Even, 128>, sweep_along<Odd, 160>, sweep_along<Even, 192>,
                    sweep_along<Odd, 224>, sweep_along<Even, 256>}};
}

}  // namespace
}  // namespace stereovox
