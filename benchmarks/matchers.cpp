// Our matchers beside OpenCV's, on the same pair, in one run.
//
//   matchers [--rounds N] [--size WIDTHxHEIGHT] [--disparities N]... [--threads N]...
//            [--only NAME]...
//
// Without options: 640 x 480, 64 and 128 disparities, one and two threads. The pair is drawn:
// planes before a floor, whose true disparity is known. Every matcher must first find it. The
// matchers take turns within each round, so that all of them suffer alike from what else the
// machine does; `x 3way` is the median over rounds of the time of OpenCV's SGBM 3WAY over the
// matcher's. OpenCV's matchers get images of the same size, so they leave the left border empty;
// ours do not.
#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "stereovox/stereo/matcher.h"
#include "timing.h"

namespace stereovox::bench {
namespace {

struct Options {
  int rounds = 15;
  std::string size = "640x480";
  std::vector<int> disparities = {64, 128}, threads = {1, 2};
  std::vector<std::string> only;
};

struct Case {
  cv::Size size;
  int disparities = 64, threads = 1;
};

struct Scene {
  RectifiedPair pair;
  cv::Mat1f truth_px;
};

constexpr const char* kPeer = "opencv sgbm 3way";

// A floor below the horizon, and four planes that stand before a far wall.
double depicted_disparity_px(const Case& c, int u, int v) {
  const double width = c.size.width, height = c.size.height, largest = 0.75 * c.disparities;
  double disparity_px = std::max(0.15, v / height - 0.3) * largest;
  constexpr int kPlanes = 4;
  for (int i = 0; i < kPlanes; ++i) {
    const double left = (0.06 + 0.24 * i) * width, top = (0.2 + 0.08 * i) * height;
    if (u < left || u > left + 0.12 * width || v < top || v > top + 0.4 * height) continue;
    disparity_px = std::max(disparity_px, (0.45 + 0.15 * i + 0.05 * u / width) * largest);
  }
  return disparity_px;
}

// Random texture of two sizes, and noise of the two cameras.
Scene draw_scene(const Case& c) {
  cv::RNG random(11);
  cv::Mat1f texture = cv::Mat1f::zeros(c.size);
  for (const int blob_px : {1, 3}) {
    cv::Mat1f noise(c.size);
    random.fill(noise, cv::RNG::NORMAL, 0, 1);
    cv::GaussianBlur(noise, noise, {0, 0}, blob_px);
    texture += noise * (30.0 * blob_px);
  }
  cv::Mat1f map_u(c.size), map_v(c.size), truth_px(c.size);
  for (int v = 0; v < c.size.height; ++v)
    for (int u = 0; u < c.size.width; ++u) {
      truth_px(v, u) = static_cast<float>(depicted_disparity_px(c, u, v));
      map_u(v, u) = static_cast<float>(u) - truth_px(v, u);
      map_v(v, u) = static_cast<float>(v);
    }
  Scene scene{.pair = {}, .truth_px = truth_px};
  cv::Mat1f left;
  cv::remap(texture, left, map_u, map_v, cv::INTER_CUBIC, cv::BORDER_REFLECT);
  const auto developed = [&](const cv::Mat1f& light) {
    cv::Mat1f noise(c.size);
    random.fill(noise, cv::RNG::NORMAL, 128, 1.5);
    return cv::Mat1b(cv::Mat1f(light + noise));
  };
  scene.pair.left.pixels = developed(left);
  scene.pair.right.pixels = developed(texture);
  return scene;
}

constexpr double kSixteenth = 1.0 / 16;  // what OpenCV's matchers count in

cv::Mat1f in_pixels(const cv::Mat1s& sixteenths) {
  cv::Mat1f disparity_px;
  sixteenths.convertTo(disparity_px, CV_32F, kSixteenth);
  return cv::max(disparity_px, 0.0F);
}

struct Contender {
  std::string name;
  std::function<cv::Mat1f()> match;  // 0 = no disparity
  Times times = {};
};

Contender opencv_contender(const char* name, cv::Ptr<cv::StereoMatcher> matcher,
                           const RectifiedPair& pair) {
  return {name, [matcher, &pair] {
            cv::Mat1s found;
            matcher->compute(pair.left.pixels, pair.right.pixels, found);
            return in_pixels(found);
          }};
}

cv::Ptr<cv::StereoMatcher> sgbm(int disparities, int mode) {
  const SemiGlobalMatchingParams p;
  return cv::StereoSGBM::create(0, disparities, p.block_size_px, p.smoothness_small,
                                p.smoothness_large, p.search.left_right_tolerance_px,
                                p.search.prefilter_cap, p.search.uniqueness_ratio_percent,
                                p.search.speckle_size_px, p.search.speckle_range_px, mode);
}

cv::Ptr<cv::StereoMatcher> bm(int disparities) {
  constexpr int kBlock_px = 15;
  const auto matcher = cv::StereoBM::create(disparities, kBlock_px);
  const BlockMatchingParams p;
  matcher->setDisp12MaxDiff(p.search.left_right_tolerance_px);
  matcher->setSpeckleWindowSize(p.search.speckle_size_px);
  matcher->setSpeckleRange(p.search.speckle_range_px);
  return matcher;
}

template <class Params>
Contender our_contender(const std::string& name, Params params, const Case& c,
                        const RectifiedPair& pair) {
  params.search.disparity_range_px = c.disparities;
  return {name, [params, &pair, c] { return match(pair, params, c.threads).disparity_px; }};
}

// adaptive_window with another support.
Contender windows_contender(WindowSupport support, const Case& c, const RectifiedPair& pair) {
  AdaptiveWindowParams params;
  params.support = support;
  const std::string& name = names_of(support)[static_cast<std::size_t>(support)];
  return our_contender(name, params, c, pair);
}

std::vector<Contender> contenders(const Case& c, const RectifiedPair& pair) {
  return {opencv_contender(kPeer, sgbm(c.disparities, cv::StereoSGBM::MODE_SGBM_3WAY), pair),
          opencv_contender("opencv sgbm", sgbm(c.disparities, cv::StereoSGBM::MODE_SGBM), pair),
          opencv_contender("opencv bm", bm(c.disparities), pair),
          our_contender(CensusSgmParams::kName, CensusSgmParams{}, c, pair),
          our_contender(AdaptiveWindowParams::kName, AdaptiveWindowParams{}, c, pair),
          windows_contender(WindowSupport::five_windows, c, pair),
          windows_contender(WindowSupport::nine_windows, c, pair)};
}

struct Check {
  double density_percent = 0, bad_percent = 0;
  bool is_right() const {
    constexpr double kMinDensity_percent = 60, kMaxBad_percent = 5;
    return density_percent >= kMinDensity_percent && bad_percent <= kMaxBad_percent;
  }
};

// Of the pixels whose disparity does not reach outside the right image.
Check check(const cv::Mat1f& found_px, const cv::Mat1f& truth_px) {
  constexpr float kRightWithin_px2 = 2.0F;
  int all = 0, found = 0, bad = 0;
  for (int v = 0; v < truth_px.rows; ++v)
    for (int u = 0; u < truth_px.cols; ++u) {
      if (truth_px(v, u) > static_cast<float>(u)) continue;
      ++all;
      if (!(found_px(v, u) > 0.0F)) continue;
      ++found;
      bad += std::abs(found_px(v, u) - truth_px(v, u)) > kRightWithin_px2 ? 1 : 0;
    }
  return {100.0 * found / all, 100.0 * bad / std::max(found, 1)};
}

double median_ratio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return median(ratios);
}

// Returns whether every matcher found the scene.
bool run_case(const Case& c, const Options& options) {
  cv::setNumThreads(c.threads);
  const Scene scene = draw_scene(c);
  std::vector<Contender> all = contenders(c, scene.pair);
  if (!options.only.empty())
    std::erase_if(all, [&](const Contender& contender) {
      return contender.name != kPeer && !std::ranges::count(options.only, contender.name);
    });
  std::vector<Check> checks;
  for (Contender& contender : all) checks.push_back(check(contender.match(), scene.truth_px));
  for (int round = 0; round < options.rounds; ++round)
    for (Contender& contender : all) time(contender.times, contender.match);
  const Contender& peer = all.front();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Contender& it = all[i];
    const Times &times = it.times, &peers = peer.times;
    fmt::print(
        "{:>4} {:>3} {:<18} {:>8.2f} {:>8.2f} {:>8.2f} {:>7.2f} {:>7.2f} {:>8.1f} {:>6.2f}{}\n",
        c.disparities, c.threads, it.name, median(times.cpu_ms),
        *std::ranges::min_element(times.cpu_ms), median(times.wall_ms),
        median_ratio(peers.cpu_ms, times.cpu_ms), median_ratio(peers.wall_ms, times.wall_ms),
        checks[i].density_percent, checks[i].bad_percent, checks[i].is_right() ? "" : "  WRONG");
  }
  std::fflush(stdout);
  return std::ranges::all_of(checks, &Check::is_right);
}

int run(const Options& options) {
  cv::Size size;
  if (std::sscanf(options.size.c_str(), "%dx%d", &size.width, &size.height) != 2) return 2;
  fmt::print("{:>4} {:>3} {:<18} {:>8} {:>8} {:>8} {:>7} {:>7} {:>8} {:>6}\n", "disp", "thr",
             "matcher", "cpu ms", "min", "wall ms", "x 3way", "(wall)", "found %", "bad2 %");
  bool are_right = true;
  for (const int threads : options.threads)
    for (const int disparities : options.disparities)
      are_right = run_case({size, disparities, threads}, options) && are_right;
  return are_right ? 0 : 1;
}

}  // namespace
}  // namespace stereovox::bench

int main(int argc, char** argv) {
  // A program that matches frame after frame keeps its memory. Here each contender would take that
  // of the one before back from the system, page by page.
  constexpr int kKept_bytes = 1 << 30, kLargest_bytes = 1 << 25;
  mallopt(M_TRIM_THRESHOLD, kKept_bytes);
  mallopt(M_MMAP_THRESHOLD, kLargest_bytes);
  stereovox::bench::Options options;
  CLI::App app("our matchers beside OpenCV's");
  app.add_option("--rounds", options.rounds)->check(CLI::PositiveNumber);
  app.add_option("--size", options.size);
  app.add_option("--disparities", options.disparities);
  app.add_option("--threads", options.threads);
  app.add_option("--only", options.only, "names of matchers, beside 3WAY");
  CLI11_PARSE(app, argc, argv);
  return stereovox::bench::run(options);
}
