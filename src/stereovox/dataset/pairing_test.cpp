#include "stereovox/dataset/pairing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

using testing::ElementsAre;

std::vector<ListedImage> images_at(const std::vector<std::int64_t>& stamps_ns) {
  std::vector<ListedImage> images;
  for (const std::int64_t stamp_ns : stamps_ns)
    images.push_back({stamp_ns, static_cast<int>(images.size()), std::to_string(stamp_ns)});
  return images;
}

// "left=right" of each pair.
std::vector<std::string> pairs_at(const std::vector<std::int64_t>& left,
                                  const std::vector<std::int64_t>& right,
                                  std::int64_t max_difference_ns, SequenceInfo* info = nullptr) {
  SequenceListing listing;
  pair_by_time(images_at(left), images_at(right), max_difference_ns, listing);
  std::vector<std::string> pairs;
  for (const ListedPair& pair : listing.pairs)
    pairs.push_back(pair.left.string() + "=" + pair.right.string());
  if (info != nullptr) *info = listing.info;
  return pairs;
}

TEST(Pairing, ImagesOfOneTimeOrNearlySoBelongTogether) {
  EXPECT_THAT(pairs_at({0, 100, 200}, {1, 99, 200}, 5), ElementsAre("0=1", "100=99", "200=200"));
}

TEST(Pairing, ImagesWithoutAPartnerAreCountedAndNamed) {
  SequenceInfo info;
  EXPECT_THAT(pairs_at({0, 100, 200, 300}, {130, 200, 300, 400}, 5, &info),
              ElementsAre("200=200", "300=300"));
  EXPECT_EQ(info.left_only, 2);
  EXPECT_EQ(info.right_only, 2);
  EXPECT_THAT(info.remarks, ElementsAre("2 left images have no right image, first: 0",
                                        "2 right images have no left image, first: 130"));
}

TEST(Pairing, TheNearestPartnerIsTakenNotTheFirstWithinReach) {
  EXPECT_THAT(pairs_at({100}, {96, 101}, 5), ElementsAre("100=101"));
  EXPECT_THAT(pairs_at({96, 101}, {100}, 5), ElementsAre("101=100"));
}

TEST(Pairing, ImagesAreListedByNumberAndOtherFilesAreIgnored) {
  const TemporaryFolder folder;
  for (const char* name :
       {"10.png", "9.PNG", "b.jpeg", "a.pgm", "times.txt", ".hidden.png", "Thumbs.db"})
    folder.write(name, "x");
  folder.write("folder.png/inside.png", "x");
  std::vector<std::string> names;
  for (const auto& image : images_in(folder.path())) names.push_back(image.filename().string());
  EXPECT_THAT(names, ElementsAre("9.PNG", "10.png", "a.pgm", "b.jpeg"));
  EXPECT_TRUE(images_in(folder.path() / "none").empty());
}

}  // namespace
}  // namespace stereovox
