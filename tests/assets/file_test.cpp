// Files are old or new, never half.
#include "assets/file.h"

#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "tests/assets/asset_test_support.h"

namespace chiaro {
namespace {

using test::errorOf;
using test::Folder;
using testing::HasSubstr;

std::size_t filesIn(const Folder& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator()));
}

TEST(File, WritesAndReplaces) {
  const Folder folder;
  writeFileAtomically(folder / "a", "first");
  writeFileAtomically(folder / "a", "second");
  const auto bytes = readFile(folder / "a");
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "second");
  EXPECT_EQ(filesIn(folder), 1u);
  writeFileAtomically(folder / "empty", std::string_view());
  EXPECT_TRUE(readFile(folder / "empty").empty());
}

TEST(File, GivesTheModeOfAnOrdinaryFile) {
  const Folder folder;
  writeFileAtomically(folder / "a", "x");
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a").c_str(), &status), 0);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  EXPECT_EQ(status.st_mode & 0777, 0666 & ~mask);
}

TEST(File, FollowsALinkAndRefusesWhatIsNoFile) {
  const Folder folder;
  writeFileAtomically(folder / "target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  writeFileAtomically(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(readFile(folder / "target"), (std::vector<std::uint8_t>{'n', 'e', 'w'}));
  for (const char* device : {"/dev/null", "/dev/zero"}) {
    EXPECT_THAT(errorOf([&] { writeFileAtomically(device, "x"); }, ExitCode::unwritableOutput),
                HasSubstr("is not a regular file"));
    EXPECT_THAT(errorOf([&] { requireWritable(device); }, ExitCode::unwritableOutput), HasSubstr("is not a regular file"));
  }
  EXPECT_THAT(errorOf([&] { writeFileAtomically(folder.path(), "x"); }, ExitCode::unwritableOutput), HasSubstr("is a folder"));
  EXPECT_THAT(errorOf([&] { requireWritable(folder.path()); }, ExitCode::unwritableOutput), HasSubstr("is a folder"));
}

TEST(File, MissingFoldersAndFiles) {
  EXPECT_THAT(errorOf([] { writeFileAtomically("/nowhere/a", "x"); }, ExitCode::unwritableOutput), HasSubstr("/nowhere/a"));
  EXPECT_THAT(errorOf([] { requireWritable("/nowhere/a"); }, ExitCode::unwritableOutput), HasSubstr("its folder does not exist"));
  EXPECT_THAT(errorOf([] { readFile("/nowhere/a"); }), HasSubstr("cannot open"));
  const Folder folder;
  EXPECT_THAT(errorOf([&] { readFile(folder.path()); }), HasSubstr("is a folder"));
  requireWritable(folder / "new");
  EXPECT_EQ(filesIn(folder), 0u);
}

TEST(File, NamesThatNoFileCanHaveAreFoundBeforeWriting) {
  const Folder folder;
  EXPECT_THAT(errorOf([&] { requireWritable(folder / std::string(300, 'a')); }, ExitCode::unwritableOutput), HasSubstr("too long"));
  EXPECT_THAT(errorOf([] { requireWritable("/proc/a"); }, ExitCode::unwritableOutput), HasSubstr("/proc/a"));
}

TEST(File, OneFileByTwoNames) {
  const Folder folder;
  writeFileAtomically(folder / "a", "x");
  std::filesystem::create_symlink("a", folder / "link");
  EXPECT_TRUE(isSameFile(folder / "a", folder / "link"));
  EXPECT_TRUE(isSameFile(folder / "missing", folder.path() / "." / "missing"));
  EXPECT_TRUE(isSameFile("missing", "./missing"));
  EXPECT_FALSE(isSameFile(folder / "a", folder / "b"));
  EXPECT_FALSE(isSameFile("", ""));
}

// A child writes ever new whole files over one another until it is killed; whatever moment that is, the file is one of them.
TEST(File, KilledAtAnyMomentLeavesAWholeFile) {
  const Folder folder;
  const auto path = folder / "a";
  constexpr std::size_t kSize = 300000;
  writeFileAtomically(path, std::vector<std::uint8_t>(kSize, 0));
  std::mt19937 random(8);
  for (int round = 0; round < 20; ++round) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      for (std::uint8_t value = 1;; ++value) writeFileAtomically(path, std::vector<std::uint8_t>(kSize, value));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      // Between its last two system calls a second copy has a name; that one must be whole too where files are nameless at first.
      const auto bytes = test::get(entry.path());
      if (entry.path() != path && entry.path().filename().string().find('-') == std::string::npos) continue;
      ASSERT_EQ(bytes.size(), kSize) << entry.path();
      EXPECT_EQ(static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), bytes[0])), kSize) << "a mixture of two files";
    }
  }
}

}  // namespace
}  // namespace chiaro
