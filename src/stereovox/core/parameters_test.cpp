#include "stereovox/core/parameters.h"

#include <gtest/gtest.h>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

enum class Shape { ball, cube };
std::span<const std::string> names_of(Shape) {
  static const std::vector<std::string> names = {"ball", "cube"};
  return names;
}

struct Near {
  static constexpr const char* kName = "near";
  int count = 3;
  void describe(ParameterList& list) { list("count", count, {1, 9}, "how many"); }
};
struct Far {
  static constexpr const char* kName = "far";
  double distance_m = 8.0;
  void describe(ParameterList& list) { list("distance_m", distance_m, {1, 99}, "how far"); }
};
struct Inner {
  double size_m = 0.05;
  bool closed = true;
  Shape shape = Shape::ball;
  void describe(ParameterList& list) {
    list("size_m", size_m, {0.01, 1}, "edge length");
    list("closed", closed, "whether closed");
    list("shape", shape, "which shape");
  }
};
struct Config {
  Inner inner;
  std::variant<Near, Far> reach;
  void describe(ParameterList& list) {
    list.section("inner", inner);
    list.one_of("reach", reach, "how far it reaches");
  }
};

std::string complaint_about(const std::string& path, const std::string& text) {
  Config config;
  try {
    apply_settings({{path, text}}, config);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Parameters, AreListedInOrderWithTheirValues) {
  Config config;
  std::string listed;
  const ParameterList list = parameters_of(config);
  for (const Parameter& p : list.parameters()) listed += p.path + "=" + p.get() + " ";
  EXPECT_EQ(listed,
            "inner.size_m=0.05 inner.closed=true inner.shape=ball reach.type=near reach.count=3 ");
}

TEST(Parameters, AreSetByNameAndTheChosenTypeComesFirst) {
  Config config;
  apply_settings({{"reach.distance_m", "12.5"}, {"inner.shape", "cube"}, {"reach.type", "far"}},
                 config);
  EXPECT_EQ(std::get<Far>(config.reach).distance_m, 12.5);
  EXPECT_EQ(config.inner.shape, Shape::cube);
}

TEST(Parameters, WrongNamesAndValuesAreErrorsThatSayWhatIsAllowed) {
  EXPECT_EQ(complaint_about("inner.size", "1"),
            "unknown parameter 'inner.size', did you mean 'inner.size_m'?");
  EXPECT_EQ(complaint_about("inner.size_m", "5"), "inner.size_m: 5 is outside [0.01, 1]");
  EXPECT_EQ(complaint_about("inner.size_m", "nan"), "inner.size_m: nan is outside [0.01, 1]");
  EXPECT_EQ(complaint_about("inner.size_m", "1,5"), "inner.size_m: '1,5' is not a number");
  EXPECT_EQ(complaint_about("reach.count", "2.5"), "reach.count: 2.5 is not a whole number");
  EXPECT_EQ(complaint_about("inner.shape", "cub"),
            "inner.shape: 'cub' is none of ball | cube, did you mean 'cube'?");
  EXPECT_EQ(complaint_about("inner.closed", "yes"), "inner.closed: 'yes' is none of false | true");
}

}  // namespace
}  // namespace stereovox
