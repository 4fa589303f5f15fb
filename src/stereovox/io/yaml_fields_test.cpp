#include "stereovox/io/yaml_fields.h"

#include <gmock/gmock.h>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

YamlFields fields(const std::string& text) { return {YAML::Load(text), "f.yaml", "thing 2"}; }

template <class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(YamlFields, GivesWhatIsThereAndDefaultsForTheRest) {
  YamlFields f = fields("{a: 1.5, n: 3, t: word, p: [1, 2], q: [1, 2, 3]}");
  EXPECT_EQ(f.number("a", {0, 2}), 1.5);
  EXPECT_EQ(f.number("b", {0, 2}, 0.5), 0.5);
  EXPECT_EQ(f.integer("n", {0, 5}, 1), 3);
  EXPECT_EQ(f.text("t"), "word");
  EXPECT_EQ(f.text("u", "other"), "other");
  EXPECT_EQ(f.point2("p"), Eigen::Vector2d(1, 2));
  EXPECT_EQ(f.point3("q"), Eigen::Vector3d(1, 2, 3));
  EXPECT_NO_THROW(f.done());
}

TEST(YamlFields, AFieldThatNobodyAskedForIsAnError) {
  YamlFields f = fields("{colour: 1, size: 2}");
  f.number("color", {0, 2}, 0.0);
  f.number("size", {0, 2}, 0.0);
  EXPECT_EQ(error_of([&] { f.done(); }),
            "f.yaml:1: thing 2: unknown field 'colour', did you mean 'color'?");
}

TEST(YamlFields, ValuesOutOfRangeAndMissingOnesAreNamed) {
  EXPECT_EQ(error_of([] {
              fields("{a: 7}").number("a", {0, 2});
            }),
            "f.yaml:1: thing 2: 'a' is 7, outside [0, 2]");
  EXPECT_EQ(error_of([] { fields("{a: 7}").text("b"); }), "f.yaml:1: thing 2: 'b' is missing");
  EXPECT_EQ(error_of([] { fields("{a: 7}").list("a"); }), "f.yaml:1: thing 2: 'a' is not a list");
  EXPECT_EQ(error_of([] { fields("[1]"); }), "f.yaml:1: thing 2: is not a map of fields");
  EXPECT_NE(error_of([] { fields("{a: x}").number("a", {0, 2}); }), "");
  EXPECT_NE(error_of([] { fields("{a: 1.5}").integer("a", {0, 2}, 0); }), "");
}

TEST(YamlFields, SettingsAreTheScalarsThatWereNotAskedForYet) {
  YamlFields f = fields("{name: x, a: 1, b: two, c: [1]}");
  f.text("name");
  EXPECT_THAT(f.settings(),
              testing::ElementsAre(testing::Pair("a", "1"), testing::Pair("b", "two")));
  EXPECT_THAT(error_of([&] { f.done(); }), testing::HasSubstr("unknown field 'c'"));
}

}  // namespace
}  // namespace stereovox
