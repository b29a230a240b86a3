#include "io/files.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

TEST(FilesTest, WrittenBytesAreReadBack) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\n\xff", 5);
  ASSERT_EQ(WriteFileAtomically(folder.PathOf("file"), bytes), "");
  EXPECT_EQ(ReadFile(folder.PathOf("file"), 100).bytes, bytes);
  EXPECT_EQ(folder.Names().size(), 1u);  // no temporary one is left
}

TEST(FilesTest, FailedWritingLeavesNothingAndNamesTheFile) {
  const TemporaryFolder folder;
  EXPECT_TRUE(Mentions(WriteFileAtomically(folder.PathOf("no/file"), "x"), {"no/file"}));
  std::filesystem::create_directory(folder.PathOf("folder"));
  folder.Write("folder/inside", "");
  EXPECT_TRUE(Mentions(WriteFileAtomically(folder.PathOf("folder"), "x"), {"folder"}));
  EXPECT_EQ(folder.Names().size(), 1u);
}

TEST(FilesTest, MissingFoldersAndTooLargeFilesAreErrors) {
  const TemporaryFolder folder;
  folder.Write("large", "12345");
  EXPECT_TRUE(Mentions(ReadFile(folder.PathOf("none"), 10).error, {"none", "cannot be read"}));
  EXPECT_TRUE(Mentions(ReadFile(folder.path(), 10).error, {folder.path(), "not a file"}));
  EXPECT_TRUE(Mentions(ReadFile(folder.PathOf("large"), 4).error, {"large", "5 bytes"}));
  EXPECT_TRUE(Mentions(ReadFile("/dev/zero", 10).error, {"/dev/zero"}));
}

TEST(FilesTest, FoldersAreListedByName) {
  const TemporaryFolder folder;
  for (const char* name : {"scan_2.pcd", "scan_1.pcd", "scan_1.txt", "a.pcd", "scan_.pc"}) {
    folder.Write(name, "");
  }
  const FolderListing listing = ListFolder(folder.path(), "scan_", ".pcd");
  EXPECT_EQ(listing.error, "");
  EXPECT_EQ(listing.paths,
            (std::vector<std::string>{folder.PathOf("scan_1.pcd"), folder.PathOf("scan_2.pcd")}));
  EXPECT_TRUE(Mentions(ListFolder(folder.PathOf("none"), "", "").error, {"none"}));
}

TEST(FilesTest, StemIsWithoutFolderAndEnding) {
  EXPECT_EQ(FileStem("rooms/000.pcd"), "000");
  EXPECT_EQ(FileStem("scan.a.3d"), "scan.a");
  EXPECT_EQ(FileStem("lcmlog-2011-05-01"), "lcmlog-2011-05-01");
  EXPECT_EQ(FileStem("lcmlog-2011-05-01.00"), "lcmlog-2011-05-01.00");
  EXPECT_EQ(FileStem("x."), "x.");
}

}  // namespace
}  // namespace rimod
