#include "io/model_split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rimod {
namespace {

ModelShare ShareOf(const std::string& shard, const std::vector<std::string>& only = {}) {
  const ModelShareResult result = ModelShareFrom(shard, only);
  EXPECT_TRUE(result.share) << result.error;
  return result.share.value_or(ModelShare());
}

TEST(ModelShareTest, IsReadFromTheCommandLine) {
  EXPECT_TRUE(ShareOf("").is_all());
  EXPECT_EQ(ShareOf("").Name(), "");
  EXPECT_EQ(ShareOf("2/4").index, 2);
  EXPECT_EQ(ShareOf("2/4").count, 4);
  EXPECT_EQ(ShareOf("2/4").Name(), "2/4");
  EXPECT_EQ(ShareOf("", {"fan", "table"}).Name(), "fan,table");
  EXPECT_FALSE(ShareOf("1/1").is_all()) << "a single shard is one, too";
}

TEST(ModelShareTest, NonsenseIsRejected) {
  for (const std::string shard : {"0/4", "5/4", "-1/4", "2", "2/", "/4", "a/b", "2/4/8", "2/4 ",
                                  "1/65", "1/99999999999999999999", "1.5/4"})
    EXPECT_FALSE(ModelShareFrom(shard, {}).share) << shard;
  EXPECT_FALSE(ModelShareFrom("2/4", {"fan"}).share);
  EXPECT_FALSE(ModelShareFrom("", {"fan", ""}).share);
  EXPECT_FALSE(ModelShareFrom("", {"../fan"}).share);
}

TEST(ModelSplitTest, EveryModelIsInExactlyOneShare) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    const int count = 1 + static_cast<int>(random() % 8);
    std::vector<std::string> folder, others;
    for (int i = static_cast<int>(random() % 30); i > 0; --i)
      folder.push_back("folder" + std::to_string(random() % 1000) + "_" + std::to_string(i));
    for (int i = 0; i < 20; ++i) others.push_back("bus" + std::to_string(random() % 100000));
    std::vector<int> num_taken(static_cast<std::size_t>(count), 0);
    std::vector<ModelSplit> splits;
    for (int i = 1; i <= count; ++i) {
      std::shuffle(folder.begin(), folder.end(), random);
      splits.emplace_back(ShareOf(std::to_string(i) + "/" + std::to_string(count)), folder);
    }
    for (const auto* const names : {&folder, &others}) {
      for (const std::string& name : *names) {
        int takers = 0;
        for (int i = 0; i < count; ++i) {
          if (!splits[i].Takes(name)) continue;
          ++takers;
          if (names == &folder) ++num_taken[i];
        }
        EXPECT_EQ(takers, 1) << name;
      }
    }
    const auto [least, most] = std::minmax_element(num_taken.begin(), num_taken.end());
    EXPECT_LE(*most - *least, 1) << "shares of a folder are even";
  }
}

TEST(ModelSplitTest, ByNameOnlyThose) {
  const ModelSplit split(ShareOf("", {"fan", "table"}), {"box", "fan"});
  EXPECT_TRUE(split.Takes("fan"));
  EXPECT_TRUE(split.Takes("table")) << "which may come over the bus";
  EXPECT_FALSE(split.Takes("box"));
  EXPECT_TRUE(ModelSplit(ShareOf(""), {}).Takes("anything"));
}

}  // namespace
}  // namespace rimod
