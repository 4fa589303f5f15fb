#include "stereovox/stereo/window_vote.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "stereovox/core/parallel.h"

namespace stereovox {
namespace {

int rounded_quotient(int dividend, int divisor) {
  const int half = dividend < 0 ? -divisor / 2 : divisor / 2;
  return (dividend + half) / divisor;
}

int whole_pixels(int disparity) { return rounded_quotient(disparity, kStepsPerPixel); }

cv::Mat1b voters_of(const MatchFeatures& features, const cv::Mat1b& recorded,
                    const VoterParams& params) {
  cv::Mat1b voters =
      (features.log_ratio >= params.min_log_ratio) & (features.left_right <= params.max_left_right);
  if (!recorded.empty()) voters.setTo(0, recorded == 0);
  return voters;
}

constexpr int kNoVote = 0;

// The ballot of each pixel: kNoVote, or its disparity in whole pixels counted from 1.
struct Ballots {
  cv::Mat1s cast;
  int kinds = 0;
  cv::Mat1i voters_before;  // in the row, of each pixel and of the end of the row
};

Ballots ballots_of(const MatchFeatures& features, const cv::Mat1b& voters) {
  const cv::Size size = voters.size();
  double lowest = 0, highest = 0;
  cv::minMaxLoc(features.disparity, &lowest, &highest);
  const int before_px = whole_pixels(static_cast<int>(lowest)) - 1;
  Ballots ballots{cv::Mat1s(size), whole_pixels(static_cast<int>(highest)) - before_px + 1,
                  cv::Mat1i::zeros(size.height, size.width + 1)};
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const bool votes = voters(v, u) != 0;
      const int kind = votes ? whole_pixels(features.disparity(v, u)) - before_px : kNoVote;
      ballots.cast(v, u) = static_cast<std::int16_t>(kind);
      ballots.voters_before(v, u + 1) = ballots.voters_before(v, u) + (votes ? 1 : 0);
    }
  return ballots;
}

// What the voters of one kind in a window know.
struct Mandate {
  int count = 0, disparity = 0, log_ratio = 0, left_right = 0, local_cost = 0;
};

// Voters are read, all others written: so it may happen in place, in any order.
class Election {
 public:
  Election(const MatchFeatures& features, const Ballots& ballots, const Arms& arms,
           double min_share)
      : features_(features), ballots_(ballots), arms_(arms), min_share_(min_share) {}

  void decide_row(int v, MatchFeatures& out) const {
    std::vector<int> counts(ballots_.kinds);
    for (int u = 0; u < ballots_.cast.cols; ++u)
      if (ballots_.cast(v, u) == kNoVote) decide(v, u, counts, out);
  }

 private:
  // Calls visit(row, first column, column after the last one) for the rows of a window.
  template <class Visit>
  void for_rows_of_window(int v, int u, const Visit& visit) const {
    for (int y = v - arms_.up(v, u); y <= v + arms_.down(v, u); ++y)
      visit(y, u - arms_.left(y, u), u + arms_.right(y, u) + 1);
  }

  void decide(int v, int u, std::vector<int>& counts, MatchFeatures& out) const {
    int area = 0, voters = 0;
    for_rows_of_window(v, u, [&](int y, int begin, int end) {
      area += end - begin;
      voters += ballots_.voters_before(y, end) - ballots_.voters_before(y, begin);
    });
    const double quorum = std::max(1.0, min_share_ * area);
    if (voters < quorum) return;
    const int winner = most_frequent(v, u, counts);
    if (counts[winner] >= quorum) write(mandate_of(winner, v, u), area, v, u, out);
  }

  int most_frequent(int v, int u, std::vector<int>& counts) const {
    std::ranges::fill(counts, 0);
    for_rows_of_window(v, u, [&](int y, int begin, int end) {
      const std::int16_t* const cast = ballots_.cast[y];
      for (int x = begin; x < end; ++x) ++counts[cast[x]];
    });
    counts[kNoVote] = 0;
    return static_cast<int>(std::ranges::max_element(counts) - counts.begin());
  }

  Mandate mandate_of(int kind, int v, int u) const {
    Mandate sum;
    for_rows_of_window(v, u, [&](int y, int begin, int end) {
      for (int x = begin; x < end; ++x) {
        if (ballots_.cast(y, x) != kind) continue;
        ++sum.count;
        sum.disparity += features_.disparity(y, x);
        sum.log_ratio += features_.log_ratio(y, x);
        sum.left_right += features_.left_right(y, x);
        sum.local_cost += features_.local_cost(y, x);
      }
    });
    return sum;
  }

  static void write(const Mandate& won, int area, int v, int u, MatchFeatures& out) {
    out.disparity(v, u) = static_cast<std::int16_t>(rounded_quotient(won.disparity, won.count));
    out.log_ratio(v, u) = static_cast<std::uint8_t>(won.log_ratio / area);
    out.left_right(v, u) = static_cast<std::uint8_t>(won.left_right / won.count);
    out.local_cost(v, u) = static_cast<std::uint8_t>(won.local_cost / won.count);
  }

  const MatchFeatures& features_;
  const Ballots& ballots_;
  const Arms& arms_;
  const double min_share_;
};

}  // namespace

void vote_in_windows(MatchFeatures& features, const Arms& arms, const cv::Mat1b& recorded,
                     const VoterParams& params, int threads) {
  const Ballots ballots = ballots_of(features, voters_of(features, recorded, params));
  const Election election(features, ballots, arms, params.min_share);
  parallel_for(0, ballots.cast.rows, threads, [&](int v) { election.decide_row(v, features); });
}

}  // namespace stereovox
