#include "stereovox/dataset/stamps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Stamps, ThatIncreaseAreAllKept) {
  const std::vector<std::int64_t> stamps_ns = {-5, 0, 1, 100};
  const IncreasingStamps chosen = choose_increasing(stamps_ns);
  EXPECT_THAT(chosen.kept, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(chosen.duplicates + chosen.backwards, 0);
}

TEST(Stamps, OneThatGoesBackIsDropped) {
  const std::vector<std::int64_t> stamps_ns = {0, 10, 20, 15, 40};
  const IncreasingStamps chosen = choose_increasing(stamps_ns);
  EXPECT_THAT(chosen.kept, ElementsAre(0, 1, 2, 4));
  EXPECT_EQ(chosen.backwards, 1);
}

TEST(Stamps, OneFarInTheFutureIsDroppedRatherThanAllThatFollow) {
  const std::vector<std::int64_t> stamps_ns = {0, 10, 9000, 20, 30, 40};
  const IncreasingStamps chosen = choose_increasing(stamps_ns);
  EXPECT_THAT(chosen.kept, ElementsAre(0, 1, 3, 4, 5));
  EXPECT_EQ(chosen.backwards, 1);
}

TEST(Stamps, RepeatedOnesAreCountedAsDuplicates) {
  const std::vector<std::int64_t> stamps_ns = {0, 10, 10, 10, 20, 0};
  const IncreasingStamps chosen = choose_increasing(stamps_ns);
  EXPECT_THAT(chosen.kept, ElementsAre(0, 1, 4));
  EXPECT_EQ(chosen.duplicates, 3);
  EXPECT_EQ(chosen.backwards, 0);
}

TEST(Stamps, AJumpIsRemarkedWithItsLength) {
  const std::vector<std::int64_t> stamps_ns = {0, 100'000'000, 200'000'000, 3600'300'000'000,
                                               3600'400'000'000};
  EXPECT_EQ(remark_on_jumps(stamps_ns),
            "1 jumps in time, the first of 3600.100 s (usual: 0.100 s)");
  EXPECT_EQ(remark_on_jumps(std::span(stamps_ns).first(3)), "");
}

TEST(Stamps, AreReadExactlyToTheNanosecond) {
  const TemporaryFolder folder;
  const auto path = folder.write("times.txt", "# s\n1403636584.763555765\r\n1.5e+09\n");
  std::vector<std::string> remarks;
  EXPECT_THAT(read_times(path, 2, 10.0, remarks),
              ElementsAre(1403636584763555765, 1500000000000000000));
  EXPECT_THAT(remarks, IsEmpty());
}

TEST(Stamps, ThatCannotBeReadAreRefusedWithTheLine) {
  const TemporaryFolder folder;
  std::vector<std::string> remarks;
  const auto complaint = [&](const std::string& text) -> std::string {
    try {
      read_times(folder.write("times.txt", text), 2, 10.0, remarks);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint("0.1\nnan\n"), HasSubstr("times.txt:2: field 1 is 'nan', not a time"));
  EXPECT_THAT(complaint("1403636584763555765\n"), HasSubstr("not a time in seconds"));
  EXPECT_THAT(complaint("0,1\n"), HasSubstr("times.txt:1: has 2 fields, 1 are needed"));
}

TEST(Stamps, ThatAreMissingOrAllTheSameAreReplacedAtTheAssumedRate) {
  const TemporaryFolder folder;
  std::vector<std::string> remarks;
  EXPECT_THAT(read_times(folder.path() / "times.txt", 3, 20.0, remarks),
              ElementsAre(0, 50'000'000, 100'000'000));
  EXPECT_THAT(remarks, ElementsAre("times.txt: is missing; 20 pairs a second are assumed"));
  remarks.clear();
  const auto path = folder.write("times.txt", "5.5\n5.5\n5.5\n");
  EXPECT_THAT(read_times(path, 3, 10.0, remarks), ElementsAre(0, 100'000'000, 200'000'000));
  EXPECT_THAT(remarks, ElementsAre("times.txt: all 3 times are 5.500000000 s; 10 pairs a second "
                                   "are assumed"));
}

}  // namespace
}  // namespace stereovox
