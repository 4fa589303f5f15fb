#include "stereovox/io/yaml_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

template <class Act>
std::string complaint(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string parse_complaint(const std::string& text) {
  return complaint([&] { parse_yaml(text, "a.yaml"); });
}

std::string nested(int depth) { return "a: " + std::string(depth, '[') + std::string(depth, ']'); }

TEST(YamlFile, GivesTypedValues) {
  const YAML::Node node = parse_yaml(
      "%YAML:1.0\n---\nfx: +525.5\nwidth: 640\nname: cam0\nT: [[1, 2], [3, 4]]\n", "a.yaml");
  EXPECT_EQ(yaml_number(node, "fx", "a.yaml"), 525.5);
  EXPECT_EQ(yaml_integer(node, "width", "a.yaml"), 640);
  EXPECT_EQ(yaml_text(node, "name", "a.yaml"), "cam0");
  EXPECT_THAT(yaml_numbers(node, "T", 4, "a.yaml"), ElementsAre(1, 2, 3, 4));
}

TEST(YamlFile, SaysWhichKeyOnWhichLineIsWrong) {
  const YAML::Node node = parse_yaml("fx: abc\nfy:\nw: 1.5\nT: [1, x]\nbig: 1e300\n", "a.yaml");
  EXPECT_EQ(complaint([&] { yaml_number(node, "cx", "a.yaml"); }), "a.yaml: 'cx' is missing");
  EXPECT_EQ(complaint([&] { yaml_number(node, "fx", "a.yaml"); }),
            "a.yaml:1: 'fx' is 'abc', not a finite number");
  EXPECT_THAT(complaint([&] { yaml_number(node, "fy", "a.yaml"); }),
              HasSubstr("'fy' is empty, not a finite number"));
  EXPECT_EQ(complaint([&] { yaml_integer(node, "w", "a.yaml"); }),
            "a.yaml:3: 'w' is '1.5', not a whole number");
  EXPECT_EQ(complaint([&] { yaml_integer(node, "big", "a.yaml"); }),
            "a.yaml:5: 'big' is '1e300', not a whole number");
  EXPECT_EQ(complaint([&] { yaml_numbers(node, "T", "a.yaml"); }),
            "a.yaml:4: 'T' is 'x', not a finite number");
  EXPECT_EQ(complaint([&] { yaml_text(node, "T", "a.yaml"); }),
            "a.yaml:4: 'T' is not a single value, not a text");
  EXPECT_EQ(complaint([&] { yaml_number(parse_yaml("just text", "a.yaml"), "fx", "a.yaml"); }),
            "a.yaml: 'fx' is missing");
  EXPECT_EQ(complaint([&] { yaml_number(parse_yaml("", "a.yaml"), "fx", "a.yaml"); }),
            "a.yaml: 'fx' is missing");
}

TEST(YamlFile, RefusesWrongSyntaxWithItsLine) {
  EXPECT_THAT(parse_complaint("a: 1\nb: [1, 2\n"), HasSubstr("a.yaml:"));
  EXPECT_THAT(parse_complaint("a: *nowhere\n"), HasSubstr("a.yaml:1: "));
  EXPECT_THAT(parse_complaint(std::string("\x00\x01\xff\xfe{", 5)), testing::Not(HasSubstr("\n")));
}

TEST(YamlFile, RefusesDeepNestingInEachNotation) {
  EXPECT_EQ(parse_complaint(nested(31)), "");
  EXPECT_EQ(parse_complaint(nested(32)), "a.yaml:1: nested more than 32 deep");
  EXPECT_EQ(parse_complaint(nested(200000)), "a.yaml:1: nested more than 32 deep");
  EXPECT_EQ(parse_complaint("a: " + std::string(200000, '{')),
            "a.yaml:1: nested more than 32 deep");
  std::string dashes, lines;
  for (int i = 0; i < 40; ++i) dashes += "- ";
  for (int i = 0; i < 40; ++i) lines += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  EXPECT_EQ(parse_complaint(dashes + "1"), "a.yaml:1: nested more than 32 deep");
  EXPECT_THAT(parse_complaint(lines), HasSubstr("nested more than 32 deep"));
}

TEST(YamlFile, RefusesAKeyThatAMapHasTwice) {
  EXPECT_EQ(parse_complaint("a: 1\nb: 2\na: 3\n"), "a.yaml:3: 'a' is there twice");
  EXPECT_EQ(parse_complaint("m:\n  k: [a, a]\n  n: {x: 1, x: 2}\n"),
            "a.yaml:3: 'x' is there twice");
  EXPECT_EQ(parse_complaint("a: {k: 1}\nb: {k: k}\n? [k]\n: k\nk: k\nc:\nd: [a, {k: ~}]\n"), "");
  EXPECT_EQ(parse_complaint("a: &x k\nb: *x\nb: *x\n"), "a.yaml:3: 'b' is there twice");
}

TEST(YamlFile, RefusesAnAliasBomb) {
  std::string bomb = "a0: &a0 [x, x]\n";
  for (int i = 1; i < 30; ++i)
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [*a" + std::to_string(i - 1) +
            ", *a" + std::to_string(i - 1) + "]\n";
  EXPECT_EQ(parse_complaint(bomb), "a.yaml:18: more than 32 aliases");
}

TEST(YamlFile, RefusesALargeFile) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.yaml", "");
  std::filesystem::resize_file(path, (16U << 20) + 1);
  EXPECT_EQ(complaint([&] { load_yaml(path); }),
            path.string() + ": is 16777217 bytes long, at most 16777216 are read");
}

}  // namespace
}  // namespace stereovox
