// The loops of census_kernels.h for one kind of vector of bytes; included by one file for each
// kind.
#pragma once

#include "stereovox/stereo/census_kernels.h"

// Each including file is to have its own: NOLINTBEGIN(misc-definitions-in-headers)
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
    // Unrolled, so that each bit is a constant.
#pragma GCC unroll 3
    for (int dy = -kCensusHalfHeight_px; dy < 0; ++dy)
#pragma GCC unroll 9
      for (int dx = -kCensusHalfWidth_px; dx <= kCensusHalfWidth_px; ++dx) take(dx, dy);
#pragma GCC unroll 4
    for (int dx = -kCensusHalfWidth_px; dx < 0; ++dx) take(dx, 0);
    S::store(out.planes[kSlopePlane] + x, slope<S>(rows, x));
  }
}

template <class S>
void penalty_rows(const std::uint8_t* here, const std::uint8_t* above, const PenaltyTable& table,
                  int width_px, const PenaltyRows& out) {
  using V = typename S::V;
  for (int x = 0; x < width_px; x += S::kSize) {
    const V own = S::load(here + x);
    const auto fill = [&](const std::uint8_t* from, std::uint8_t* penalties) {
      const V other = S::load(from + x);
      const V step =
          S::either(S::subtract_saturated(own, other), S::subtract_saturated(other, own));
      S::store(penalties + x, S::look_up(table.data(), S::min(step, S::spread(kPenaltySteps - 1))));
    };
    fill(here - 1, out.beside);
    fill(above, out.above[0]);
    fill(above - 1, out.above[1]);
    fill(above + 1, out.above[2]);
  }
}

// Hamming distance of two census words that lie in four planes of bytes. Where counting the ones
// takes long, carry-save adders first bring the four planes to one of weight 1 and two of weight 2.
template <class S>
[[gnu::always_inline]] inline typename S::V hamming(const typename S::V (&left)[kPlanes],
                                                    const PixelRow& right, int at) {
  using V = typename S::V;
  const V a = S::differ(left[0], S::load(right.planes[0] + at));
  const V b = S::differ(left[1], S::load(right.planes[1] + at));
  const V c = S::differ(left[2], S::load(right.planes[2] + at));
  const V d = S::differ(left[3], S::load(right.planes[3] + at));
  if constexpr (S::kCountsOnesInOneStep)
    return S::add(S::add(S::count_ones(a), S::count_ones(b)),
                  S::add(S::count_ones(c), S::count_ones(d)));
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
  static_assert(kSlopeWeight == 4);
  const V twice = S::add_saturated(difference, difference);
  return S::min(S::add_saturated(twice, twice), S::spread(kMaxSlopeCost));
}

template <class S>
[[gnu::always_inline]] inline typename S::V matching_cost(const typename S::V (&left)[kPlanes],
                                                          const PixelRow& right, int at) {
  using V = typename S::V;
  const V both = S::mean(hamming<S>(left, right, at), slope_cost<S>(left[kSlopePlane], right, at));
  return S::mean(both, S::mean(both, S::spread(0)));
}

// The smallest of all bytes, in every byte.
template <class S, int N>
[[gnu::always_inline]] inline typename S::V smallest_of(const typename S::V (&bytes)[N]) {
  typename S::V all = bytes[0];
  for (int n = 1; n < N; ++n) all = S::min(all, bytes[n]);
  return S::min_of_all(all);
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
  V before = wall;
  for (int n = 0; n < N; ++n) {
    const V here = path.cost[n];
    const V lower = S::from_before(before, here);
    const V upper = S::from_after(here, n + 1 < N ? path.cost[n + 1 < N ? n + 1 : n] : wall);
    const V beside = S::add_saturated(S::min(lower, upper), small);
    const V best = S::min(S::min(here, jump), beside);
    path.cost[n] = S::add(cost[n], S::subtract(best, path.smallest));
    before = here;
  }
  path.smallest = smallest_of<S>(path.cost);
}

// The next pixel of a path from above, in place: `kept` holds the candidates of the pixel that it
// comes from, above their minimum. Adds to the sums.
template <class S, int N>
[[gnu::always_inline]] inline void step_from_above(const typename S::V (&cost)[N],
                                                   typename S::V small, typename S::V nearer,
                                                   typename S::V large, std::uint8_t* kept,
                                                   typename S::V (&sum)[N]) {
  using V = typename S::V;
  V next[N];
  const V wall = S::spread(kMaxByte);
  for (int n = 0; n < N; ++n) {
    std::uint8_t* const at = kept + n * S::kSize;
    const V here = S::load(at);
    const V lower = n > 0 ? S::load(at - 1) : S::from_before(wall, here);
    const V upper = n + 1 < N ? S::load(at + 1) : S::from_after(here, wall);
    const V beside = S::min(S::add_saturated(lower, small), S::add_saturated(upper, nearer));
    next[n] = S::add(cost[n], S::min(S::min(here, large), beside));
    sum[n] = S::add_saturated(sum[n], next[n]);
  }
  const V smallest = smallest_of<S>(next);
  for (int n = 0; n < N; ++n) S::store(kept + n * S::kSize, S::subtract(next[n], smallest));
}

// The costs of the candidates of pixel x.
template <class S, int kCandidates>
[[gnu::always_inline]] inline void compare(const PixelRow& left, const PixelRow& right, int x,
                                           std::uint8_t* cost) {
  typename S::V words[kPlanes];
  for (int p = 0; p < kPlanes; ++p) words[p] = S::spread(left.planes[p][x]);
  for (int i = 0; i < kCandidates; i += S::kSize)
    S::store(cost + i, matching_cost<S>(words, right, x + i));
}

template <class S, int kCandidates>
void cost_row(const CostRow& row) {
  const PixelRow left = row.left, right = row.right;
  std::uint8_t* const cost = row.cost;
  for (int x = 0, width = row.width_px; x < width; ++x)
    compare<S, kCandidates>(left, right, x, cost + x * kCandidates);
}

// Where one of the paths from above keeps its pixels, one after the other, starting anywhere.
template <int kCandidates>
class KeptPath {
 public:
  KeptPath(std::uint8_t* first, int width_px, int slot)
      : first_(first), end_(first + width_px * kCandidates), at_(first + slot * kCandidates) {}

  [[gnu::always_inline]] std::uint8_t* next() {
    std::uint8_t* const here = at_;
    at_ = here + kCandidates == end_ ? first_ : here + kCandidates;
    return here;
  }

 private:
  std::uint8_t* const first_;
  std::uint8_t* const end_;
  std::uint8_t* at_;
};

// After the costs themselves, since each waits for other things: side by side they would fill the
// window in which a machine looks for work.
template <class S, class Wide, int kCandidates>
void sweep_down(const SweepRow& row) {
  constexpr int N = kCandidates / S::kSize;
  using V = typename S::V;
  cost_row<Wide, kCandidates>({row.width_px, row.left, row.right, row.cost});
  const V small = S::spread(row.small_penalty), nearer = S::spread(row.nearer_penalty);
  const auto kept = [&](int k) {
    return KeptPath<kCandidates>(row.paths_above[k], row.width_px, row.first_slot[k]);
  };
  KeptPath<kCandidates> paths[] = {kept(0), kept(1), kept(2)};
  const std::array<std::uint8_t*, 3> penalty = row.penalty.above;
  const std::uint8_t* costs = row.cost;
  std::uint8_t* sums = row.sum;
  for (int x = 0, width = row.width_px; x < width; ++x) {
    V cost[N], sum[N];
    for (int n = 0; n < N; ++n) {
      cost[n] = S::load(costs + n * S::kSize);
      sum[n] = S::spread(0);
    }
    for (int k = 0; k < 3; ++k)
      step_from_above<S, N>(cost, small, nearer, S::spread(penalty[k][x]), paths[k].next(), sum);
    for (int n = 0; n < N; ++n) S::store(sums + n * S::kSize, sum[n]);
    costs += kCandidates;
    sums += kCandidates;
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

template <class S, int N>
[[gnu::always_inline]] inline void find_winner(const typename S::V (&sum)[N], int x,
                                               const WinnerPointers& out) {
  using V = typename S::V;
  const V smallest = smallest_of<S>(sum);
  const int best = first_equal<S, N>(sum, smallest);
  V others[N];
  for (int n = 0; n < N; ++n)
    others[n] = S::either(sum[n], S::load(kThreeOut.bytes + kMaxCandidates - best + n * S::kSize));
  out.candidate[x] = static_cast<std::uint8_t>(best);
  out.cost[x] = S::first(smallest);
  out.second[x] = S::first(smallest_of<S>(others));
}

// One of the two paths along the row. It comes to each pixel from the one at x - direction.
template <class S, int kCandidates>
class PathAlong {
 public:
  PathAlong(const SweepRow& row, int direction)
      : cost_(row.cost),
        sum_(row.sum),
        penalty_(row.penalty.beside + (direction > 0 ? 0 : 1)),
        small_(S::spread(row.small_penalty)),
        path_(start_of_path<S, N>()) {}

  // Goes on to pixel x and adds to its sums.
  [[gnu::always_inline]] void pass(int x) {
    typename S::V cost[N];
    for (int n = 0; n < N; ++n) cost[n] = S::load(cost_ + x * kCandidates + n * S::kSize);
    step_along_row<S, N>(cost, small_, S::spread(penalty_[x]), path_);
    std::uint8_t* const sums = sum_ + x * kCandidates;
    for (int n = 0; n < N; ++n)
      S::store(sums + n * S::kSize, S::add_saturated(S::load(sums + n * S::kSize), path_.cost[n]));
  }

 private:
  static constexpr int N = kCandidates / S::kSize;

  const std::uint8_t* const cost_;
  std::uint8_t* const sum_;
  const std::uint8_t* const penalty_;
  const typename S::V small_;
  PathState<S, N> path_;
};

template <class S, int kCandidates>
void find_winners(const SweepRow& row, const WinnerPointers& winners) {
  constexpr int N = kCandidates / S::kSize;
  const WinnerPointers out = winners;
  const std::uint8_t* const sums = row.sum;
  for (int x = 0, width = row.width_px; x < width; ++x) {
    typename S::V sum[N];
    for (int n = 0; n < N; ++n) sum[n] = S::load(sums + x * kCandidates + n * S::kSize);
    find_winner<S, N>(sum, x, out);
  }
}

// Four paths go at once, because each of them alone waits for its last minimum most of the time.
template <class S, int kCandidates>
void sweep_along(const RowPair& rows, const WinnerPair& out) {
  PathAlong<S, kCandidates> a(rows[0], 1), b(rows[0], -1), c(rows[1], 1), d(rows[1], -1);
  const int width = rows[0].width_px;
  for (int x = 0; x < width; ++x) {
    a.pass(x);
    b.pass(width - 1 - x);
    c.pass(x);
    d.pass(width - 1 - x);
  }
  for (int i = 0; i < 2; ++i) find_winners<S, kCandidates>(rows[i], out[i]);
}

// Wide may be a longer vector than S for costs, if an even multiple of kCandidateStep fills it.
// Paths seek the smallest of all bytes again and again, which takes long vectors longer.
template <class S, class Wide = S>
constexpr CensusKernels make_census_kernels() {
  return {.census = census_row<Wide>,
          .penalties = penalty_rows<Wide>,
          .down = {sweep_down<S, S, 32>, sweep_down<S, Wide, 64>, sweep_down<S, S, 96>,
                   sweep_down<S, Wide, 128>, sweep_down<S, S, 160>, sweep_down<S, Wide, 192>,
                   sweep_down<S, S, 224>, sweep_down<S, Wide, 256>},
          .along = {sweep_along<S, 32>, sweep_along<S, 64>, sweep_along<S, 96>, sweep_along<S, 128>,
                    sweep_along<S, 160>, sweep_along<S, 192>, sweep_along<S, 224>,
                    sweep_along<S, 256>}};
}

}  // namespace
}  // namespace stereovox
// NOLINTEND(misc-definitions-in-headers)
