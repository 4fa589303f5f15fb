#include "stereovox/io/text_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <vector>

#include "stereovox/core/error.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

TEST(TextFile, SecondsAreExactToTheNanosecond) {
  EXPECT_EQ(parse_seconds_as_ns("1403636584.763555765"), 1403636584763555765);
  EXPECT_EQ(parse_seconds_as_ns("0"), 0);
  EXPECT_EQ(parse_seconds_as_ns("1."), 1'000'000'000);
  EXPECT_EQ(parse_seconds_as_ns(".25"), 250'000'000);
  EXPECT_EQ(parse_seconds_as_ns("-0.5"), -500'000'000);
  EXPECT_EQ(parse_seconds_as_ns("+2"), 2'000'000'000);
  EXPECT_EQ(parse_seconds_as_ns("1.037359e-01"), 103'735'900);
  EXPECT_EQ(parse_seconds_as_ns("1.5e+09"), 1'500'000'000'000'000'000);
  EXPECT_EQ(parse_seconds_as_ns("0.0000000014999"), 1);
  EXPECT_EQ(parse_seconds_as_ns("0.0000000015"), 2);
  EXPECT_EQ(parse_seconds_as_ns("1e-300"), 0);
}

TEST(TextFile, WhatIsNoTimeIsNothing) {
  for (const char* text : {"", "-", ".", "nan", "inf", "1,5", "1.2.3", "1e", "1e999", "0x10", "--1",
                           "+-1", "9223372036.854775807", "1403636584763555765", " 1", "1 "})
    EXPECT_FALSE(parse_seconds_as_ns(text)) << text;
}

TEST(TextFile, SecondsAreWrittenAsTheyAreRead) {
  for (const std::int64_t stamp_ns : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{-1500000000},
                                      std::int64_t{1403636584763555765}})
    EXPECT_EQ(parse_seconds_as_ns(seconds_text(stamp_ns)), stamp_ns);
  EXPECT_EQ(seconds_text(-1), "-0.000000001");
  EXPECT_EQ(seconds_text(1403636584763555765), "1403636584.763555765");
}

TEST(TextFile, NumbersDoNotDependOnTheLocale) {
  const char* const before = std::setlocale(LC_ALL, nullptr);
  const std::string kept = before;
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  EXPECT_EQ(parse_number("1.5e-3"), 0.0015);
  EXPECT_EQ(parse_number("+1.5"), 1.5);
  EXPECT_FALSE(parse_number("1,5"));
  EXPECT_FALSE(parse_number("1.5 "));
  std::setlocale(LC_ALL, kept.c_str());
}

TEST(TextFile, RecordsSkipCommentsAndBlankLinesAndCountTheLines) {
  const TemporaryFolder folder;
  const fs::path path = folder.write("a.txt", "\xEF\xBB\xBF 1\t2,3\r\n\r\n# 4\n  # 5\n6 7");
  std::vector<std::string> seen;
  for_each_record(path, [&](const TextRecord& record) {
    std::string text = std::to_string(record.line) + ":";
    for (const std::string_view field : record.fields) text += std::string(field) + "|";
    seen.push_back(text);
  });
  EXPECT_THAT(seen, ElementsAre("1:1|2|3|", "5:6|7|"));
}

TEST(TextFile, TextsInMessagesAreShortAndPrintable) {
  EXPECT_EQ(in_quotes("a\x1b[2J\n"), "'a?[2J?'");
  EXPECT_EQ(in_quotes(std::string(1000, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(TextFile, WhatIsNoFileIsRefusedWithTheReason) {
  const TemporaryFolder folder;
  const auto complaint = [](const fs::path& path) -> std::string {
    try {
      read_file(path, 10);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string base = folder.path().string();
  EXPECT_EQ(complaint(folder.path()), base + ": is a folder, not a file");
  EXPECT_EQ(complaint(folder.path() / "a"),
            base + "/a: cannot be opened (No such file or directory)");
  EXPECT_EQ(complaint(folder.write("b", "12345678901")),
            base + "/b: is 11 bytes long, at most 10 are read");
  EXPECT_EQ(complaint("/dev/zero"), "/dev/zero: is not a regular file");
  EXPECT_EQ(read_file(folder.write("c", "1234567890"), 10), "1234567890");
}

}  // namespace
}  // namespace stereovox
