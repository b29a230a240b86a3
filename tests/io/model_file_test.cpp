#include "io/model_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "io/message_codec.h"
#include "io/model_messages.h"
#include "tests/io/random_models.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

std::string Number(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>((value >> shift) & 0xff);
  return bytes;
}

// The bytes with the checksum that fits them: a file that somebody made on purpose.
std::string Sealed(const std::string& bytes) {
  const auto* const begin = reinterpret_cast<const Bytef*>(bytes.data());
  return bytes + Number(static_cast<std::uint32_t>(crc32_z(0, begin, bytes.size())));
}

TEST(ModelFileTest, WrittenModelsAreReadBackBitForBit) {
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < 5; ++seed) {
    const ObjectModel model = RandomModel(seed, 20, 1000);
    ASSERT_EQ(WriteModelFile(folder.PathOf("a.rimod"), model), "");
    const ModelFileResult read = ReadModelFile(folder.PathOf("a.rimod"));
    ASSERT_TRUE(read.model) << read.error;
    EXPECT_TRUE(SameBits(*read.model, model));
  }
  EXPECT_EQ(folder.Names().size(), 1u);
}

TEST(ModelFileTest, EqualModelsGiveEqualFiles) {
  EXPECT_EQ(EncodeModelFile(RandomModel(1, 5, 100)), EncodeModelFile(RandomModel(1, 5, 100)));
}

TEST(ModelFileTest, InvalidModelsAndPlacesAreErrorsThatKeepTheOldFile) {
  const TemporaryFolder folder;
  ObjectModel model = RandomModel(1, 2, 10);
  EXPECT_TRUE(Mentions(WriteModelFile(folder.PathOf("no/a.rimod"), model), {"no/a.rimod"}));
  folder.Write("a.rimod", "old");
  model.points[0].x() = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(Mentions(WriteModelFile(folder.PathOf("a.rimod"), model), {"a.rimod", "finite"}));
  EXPECT_EQ(folder.Read("a.rimod"), "old");
}

TEST(ModelFileTest, EveryFlippedBitIsNoticed) {
  const std::string good = EncodeModelFile(RandomModel(2, 2, 10));
  for (std::size_t byte = 0; byte < good.size(); byte += byte < 200 ? 1 : 37) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = good;
      bytes[byte] = static_cast<char>(bytes[byte] ^ (1 << bit));
      const ModelFileResult read = DecodeModelFile(bytes, "fan.rimod");
      ASSERT_FALSE(read.model) << "byte " << byte << " bit " << bit;
      EXPECT_TRUE(Mentions(read.error, {"fan.rimod: "}));
    }
  }
}

TEST(ModelFileTest, EveryTruncationIsNoticed) {
  const std::string good = EncodeModelFile(RandomModel(2, 2, 10));
  for (std::size_t size = 0; size < good.size(); size += size < 100 ? 1 : 41) {
    const ModelFileResult read = DecodeModelFile(good.substr(0, size), "fan.rimod");
    EXPECT_FALSE(read.model);
    EXPECT_TRUE(Mentions(read.error, {"fan.rimod: ", size == 0 ? "empty" : "truncated"}));
  }
  EXPECT_FALSE(DecodeModelFile(good + "x", "fan.rimod").model);
}

TEST(ModelFileTest, AnotherVersionIsNamed) {
  std::string bytes = EncodeModelFile(RandomModel(2, 2, 10));
  bytes.resize(bytes.size() - 4);
  bytes.replace(std::string("rimod-model\n").size(), 4, Number(7));
  EXPECT_TRUE(Mentions(DecodeModelFile(Sealed(bytes), "fan.rimod").error,
                       {"fan.rimod", "version 7", "reads 1"}));
}

TEST(ModelFileTest, ForeignFilesAreNamed) {
  EXPECT_TRUE(Mentions(DecodeModelFile("# .PCD v0.7 and so on, and so on", "x").error,
                       {"x: ", "not a rimod model"}));
  const TemporaryFolder folder;
  EXPECT_TRUE(Mentions(ReadModelFile(folder.PathOf("none.rimod")).error, {"none.rimod"}));
  EXPECT_TRUE(Mentions(ReadModelFile(folder.path()).error, {"not a file"}));
}

TEST(ModelFileTest, LiesUnderAFittingChecksumAreNoticed) {
  const std::string start = "rimod-model\n" + Number(kModelFileVersion);
  EXPECT_TRUE(Mentions(DecodeModelFile(Sealed(start + Number(0)), "x").error, {"no sections"}));
  EXPECT_TRUE(
      Mentions(DecodeModelFile(Sealed(start + Number(0xffffffff)), "x").error, {"missing"}));
  EXPECT_TRUE(Mentions(DecodeModelFile(Sealed(start + Number(1) + Number(0xffffffff)), "x").error,
                       {"longer than the file"}));
  EXPECT_TRUE(Mentions(DecodeModelFile(Sealed(start + Number(1) + Number(3) + "abc"), "x").error,
                       {"x: section 0"}));
  const std::string good = EncodeModelFile(RandomModel(2, 2, 10));
  EXPECT_TRUE(Mentions(DecodeModelFile(Sealed(good.substr(0, good.size() - 4) + "more"), "x").error,
                       {"after its last section"}));
}

// Damage under a fitting checksum: an answer, and what is read is valid.
TEST(ModelFileTest, ForgedFilesGiveAnAnswer) {
  RandomValues random(6);
  std::string good = EncodeModelFile(RandomModel(3, 2, 5));
  good.resize(good.size() - 4);
  for (int round = 0; round < 2000; ++round) {
    std::string bytes = good;
    for (int i = random.Int(1, 3); i > 0; --i) {
      const int range = random.Int(0, 1) == 0 ? 250 : static_cast<int>(good.size());
      bytes[static_cast<std::size_t>(random.Int(0, range - 1))] =
          static_cast<char>(random.Int(0, 255));
    }
    const ModelFileResult read = DecodeModelFile(Sealed(bytes), "x");
    EXPECT_NE(read.model.has_value(), !read.error.empty());
    if (read.model) {
      EXPECT_NO_THROW(ValidateModel(*read.model));
    }
  }
}

TEST(ModelFolderTest, ModelsAreLoadedByNameAndBadOnesLeftOut) {
  const TemporaryFolder folder;
  ASSERT_EQ(WriteModelFile(folder.PathOf("b.rimod"), RandomModel(1, 1, 10)), "");
  ASSERT_EQ(WriteModelFile(folder.PathOf("a.rimod"), RandomModel(2, 1, 10)), "");
  ASSERT_EQ(WriteModelFile(folder.PathOf("c.rimod"), RandomModel(1, 1, 10)), "");  // again
  folder.Write("bad.rimod", "nonsense");
  folder.Write("readme.txt", "no model");
  const ModelFolder loaded = LoadModelFolder(folder.path());
  EXPECT_EQ(loaded.error, "");
  ASSERT_EQ(loaded.models.size(), 2u);
  EXPECT_EQ(loaded.models[0].name, "model_2");
  EXPECT_EQ(loaded.models[1].name, "model_1");
  ASSERT_EQ(loaded.bad_files.size(), 2u);
  EXPECT_TRUE(Mentions(loaded.bad_files[0], {"bad.rimod", "not a rimod model"}));
  EXPECT_TRUE(Mentions(loaded.bad_files[1], {"c.rimod", "model_1"}));
}

TEST(ModelFolderTest, MissingAndEmptyFolders) {
  const TemporaryFolder folder;
  const ModelFolder empty = LoadModelFolder(folder.path());
  EXPECT_EQ(empty.error, "");
  EXPECT_TRUE(empty.models.empty());
  EXPECT_TRUE(Mentions(LoadModelFolder(folder.PathOf("none")).error, {"none"}));
  EXPECT_TRUE(Mentions(LoadModelFolder(folder.Write("file", "")).error, {"file"}));
}

}  // namespace
}  // namespace rimod
