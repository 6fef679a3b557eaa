// What a bake leaves to go on from: nothing that was torn or changed is taken for finished, and nothing that was finished is lost without need.
#include "precompute/journal/journal.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/compression/coordinates.h"
#include "precompute/journal/fingerprint.h"
#include "precompute/journal/pca_record.h"
#include "precompute/journal/row_store.h"
#include "precompute/parallel.h"
#include "tests/precompute/bake_scenes.h"

namespace chiaro {
namespace {

constexpr Fingerprint kOurs{1, 2};
constexpr std::size_t kFileHeader = 32, kRecordHeader = 40;

std::vector<std::byte> content(std::size_t size, int seed) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 7 + static_cast<std::size_t>(seed));
  return bytes;
}

struct JournalTest : testing::Test {
  void SetUp() override {
    path = std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".partial";
    std::filesystem::remove(path);
  }
  void TearDown() override { std::filesystem::remove(path); }

  // Records of 100 bytes with the indices 0, 1, 2, ... and kind 7.
  void write(int count) {
    Journal journal(path, kOurs);
    for (int i = 0; i < count; ++i) journal.append(7, static_cast<std::uint64_t>(i), content(100, i));
  }
  std::set<int> readable() {
    Journal journal(path, kOurs);
    std::set<int> result;
    std::vector<std::byte> bytes;
    for (int i = 0; i < 20; ++i)
      if (journal.read(7, static_cast<std::uint64_t>(i), bytes)) {
        EXPECT_EQ(bytes, content(100, i));
        result.insert(i);
      }
    return result;
  }
  void flip(std::size_t place) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(place));
    const char c = static_cast<char>(file.get() ^ 4);
    file.seekp(static_cast<std::streamoff>(place));
    file.put(c);
  }
  std::filesystem::path path;
};

TEST_F(JournalTest, KeepsRecordsInAnyOrderOverARestart) {
  {
    Journal journal(path, kOurs);
    EXPECT_EQ(journal.found(), Journal::Found::nothing);
    parallelBlocks(4, 15, [&](std::size_t i) { journal.append(7, 14 - i, content(100, static_cast<int>(14 - i))); });
    journal.append(8, 3, {});
  }
  EXPECT_EQ(readable().size(), 15u);
  Journal journal(path, kOurs);
  EXPECT_EQ(journal.found(), Journal::Found::same);
  EXPECT_TRUE(journal.has(8, 3));
  EXPECT_FALSE(journal.has(8, 4));
  std::vector<std::byte> bytes;
  EXPECT_FALSE(journal.read(9, 3, bytes));
}

TEST_F(JournalTest, AnEmptyOneLeavesNoFile) {
  write(0);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(JournalTest, ATornTailCostsTheLastRecordAtMost) {
  write(3);
  const auto whole = std::filesystem::file_size(path);
  for (const std::size_t lost : {1u, 99u, 100u, 139u}) {
    std::filesystem::resize_file(path, whole - lost);
    EXPECT_EQ(readable(), (std::set{0, 1})) << lost;
    Journal(path, kOurs).append(7, 2, content(100, 2));
    EXPECT_EQ(readable(), (std::set{0, 1, 2})) << lost;
    EXPECT_EQ(std::filesystem::file_size(path), whole);
  }
  // A power cut may leave the length without the data.
  std::filesystem::resize_file(path, whole - 70);
  std::filesystem::resize_file(path, whole + 500);
  EXPECT_EQ(readable(), (std::set{0, 1}));
}

TEST_F(JournalTest, AChangedByteInAContentCostsThatRecord) {
  write(4);
  flip(kFileHeader + 100 + kRecordHeader + kRecordHeader + 17);
  EXPECT_EQ(readable(), (std::set{0, 2, 3}));
  Journal(path, kOurs).append(7, 1, content(100, 1));
  EXPECT_EQ(readable(), (std::set{0, 1, 2, 3}));
}

TEST_F(JournalTest, AChangedByteInARecordsHeaderCostsWhatIsBehindIt) {
  for (const std::size_t byte : {0u, 5u, 9u, 16u, 25u, 33u}) {
    std::filesystem::remove(path);
    write(4);
    flip(kFileHeader + 2 * (100 + kRecordHeader) + byte);
    EXPECT_EQ(readable(), (std::set{0, 1})) << byte;
  }
}

TEST_F(JournalTest, AnotherFingerprintOrADamagedHeaderStartsAnew) {
  write(3);
  {
    Journal journal(path, {1, 3});
    EXPECT_EQ(journal.found(), Journal::Found::other);
    EXPECT_FALSE(journal.has(7, 0));
    journal.append(7, 0, content(5, 0));
  }
  EXPECT_TRUE(readable().empty());
  write(3);
  flip(10);
  EXPECT_TRUE(readable().empty());
  write(3);
  {
    Journal journal(path, kOurs, true);
    EXPECT_EQ(journal.found(), Journal::Found::nothing);
    EXPECT_FALSE(journal.has(7, 0));
  }
}

std::string refusal(const std::filesystem::path& path) {
  try {
    Journal journal(path, kOurs, true);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::unwritableOutput);
    return error.what();
  }
  return "";
}

TEST_F(JournalTest, TouchesNoFileOfAnotherKind) {
  for (const std::string text : {"x", "somebody's own data, longer than any header of ours"}) {
    std::ofstream(path) << text;
    EXPECT_NE(refusal(path).find("move it away"), std::string::npos);
    EXPECT_EQ(readFile(path).size(), text.size());
    std::filesystem::remove(path);
  }
  std::filesystem::create_symlink("elsewhere", path);
  EXPECT_FALSE(refusal(path).empty());
  EXPECT_FALSE(std::filesystem::exists("elsewhere"));
  EXPECT_FALSE(refusal("no/such/folder/x.partial").empty());
}

TEST_F(JournalTest, OneBakeAtATime) {
  Journal journal(path, kOurs);
  journal.append(7, 0, content(100, 0));
  EXPECT_NE(refusal(path).find("another bake"), std::string::npos);
  std::vector<std::byte> bytes;
  EXPECT_TRUE(journal.read(7, 0, bytes)) << "and the other one did no harm";
}

TEST_F(JournalTest, AFullDiskLosesNothingThatWasThere) {
  Journal journal(path, kOurs);
  journal.append(7, 0, content(100, 0));
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{.rlim_cur = 4096, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  try {
    journal.append(7, 1, content(10000, 1));
    ADD_FAILURE() << "nothing was refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::unwritableOutput);
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(journal.has(7, 1));
  journal.append(7, 2, content(100, 2));
  std::vector<std::byte> bytes;
  EXPECT_TRUE(journal.read(7, 0, bytes) && journal.read(7, 2, bytes));
}

struct Rows {
  static constexpr std::size_t kCount = 300, kColumns = 5, kSide = 4;
  static std::vector<std::int16_t> values(std::size_t first, std::size_t count) {
    std::vector<std::int16_t> result;
    for (std::size_t i = first * kColumns; i < (first + count) * kColumns; ++i) result.push_back(static_cast<std::int16_t>(13 * i - 900));
    return result;
  }
  static std::vector<std::uint8_t> side(std::size_t first, std::size_t count) {
    std::vector<std::uint8_t> result;
    for (std::size_t i = first * kSide; i < (first + count) * kSide; ++i) result.push_back(static_cast<std::uint8_t>(i));
    return result;
  }
  static void put(RowStore& store, std::size_t block) {
    const auto first = block * RowBlocks::kRows, count = store.rowsOf(block);
    store.put(block, 100 + block, values(first, count).data(), side(first, count).data());
  }
};

TEST_F(JournalTest, RowsComeBackFromWhereverTheyAre) {
  for (const bool inMemory : {true, false}) {
    std::filesystem::remove(path);
    std::optional<Journal> journal(std::in_place, path, kOurs);
    for (const std::vector<std::size_t>& put : {std::vector<std::size_t>{2, 0}, {1}, {}}) {
      RowStore store(Rows::kCount, Rows::kColumns, Rows::kSide, {.journal = &*journal, .kind = 3, .inMemory = inMemory});
      const auto missing = store.restore([&](std::size_t block, std::uint64_t rays, const std::uint8_t* side) {
        EXPECT_EQ(rays, 100 + block);
        const auto expected = Rows::side(block * RowBlocks::kRows, store.rowsOf(block));
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), side));
      });
      const std::vector<std::size_t> expected = put.size() == 2 ? std::vector<std::size_t>{0, 1, 2} : put;
      EXPECT_EQ(missing, expected);
      for (const auto block : put) Rows::put(store, block);
      if (put.empty()) {
        std::vector<std::byte> room;
        for (std::size_t b = 0; b < store.blocks(); ++b) {
          const auto values = Rows::values(b * RowBlocks::kRows, store.rowsOf(b));
          EXPECT_TRUE(std::equal(values.begin(), values.end(), store.block(b, room))) << b;
        }
      }
      journal.emplace(path, kOurs);
    }
    // The same records read as rows of another length are no rows at all.
    RowStore other(Rows::kCount, Rows::kColumns + 1, Rows::kSide, {.journal = &*journal, .kind = 3, .inMemory = inMemory});
    EXPECT_EQ(other.restore([](std::size_t, std::uint64_t, const std::uint8_t*) { FAIL(); }).size(), 3u);
    std::vector<std::byte> room;
    if (!inMemory) {
      EXPECT_THROW(other.block(0, room), Error);
    }
  }
}

TEST_F(JournalTest, CoordinatesOfHeldAndOtherRowsAreOneList) {
  constexpr std::size_t kAll = 400;
  const CoordinateScale scale{{1.0f, 2.0f, 3.0f}};
  CoordinateStore all(kAll, scale.most);
  std::vector<std::uint32_t> held;
  for (std::uint32_t i = 3; i < kAll; i += 9) held.push_back(i);
  RowStore rest(kAll - held.size(), 3, 0, {});
  CoordinateStore split(held, rest, scale);
  std::vector<std::int16_t> packed;
  for (std::size_t i = 0; i < kAll; ++i) {
    const float values[3]{static_cast<float>(i) / kAll, -static_cast<float>(i) / kAll, 0.5f};
    all.set(i, values);
    if (std::binary_search(held.begin(), held.end(), i)) {
      split.set(i, values);
    } else {
      packed.resize(packed.size() + 3);
      scale.pack(values, packed.data() + packed.size() - 3);
    }
  }
  for (std::size_t b = 0; b < rest.blocks(); ++b) rest.put(b, 0, packed.data() + b * RowBlocks::kRows * 3, nullptr);
  EXPECT_EQ(split.rows(), kAll);
  EXPECT_EQ(split.read(0, kAll).values, all.read(0, kAll).values);
  const std::vector<std::uint32_t> some{399, 3, 4, 5, 0, 200, 12, 130, 131};
  EXPECT_EQ(split.read(some).values, all.read(some).values);
}

TEST(PcaRecord, ComesBackBitForBitOrNotAtAll) {
  Pca pca;
  pca.terms = 2;
  pca.totalEnergy = 0.1;
  pca.energy = {3.5, 1e-9};
  pca.mean = {1, 2, 3};
  pca.functions = {1, 2, 3, -4, 5, -6};
  pca.weights = {1, 2, 3, 4, 5, 6, 7, 8};
  const auto bytes = packPca(pca);
  Pca read;
  ASSERT_TRUE(unpackPca(bytes, 4, 3, read));
  EXPECT_EQ(read.terms, 2);
  EXPECT_EQ(read.totalEnergy, pca.totalEnergy);
  EXPECT_EQ(read.energy, pca.energy);
  EXPECT_EQ(read.mean, pca.mean);
  EXPECT_EQ(read.functions, pca.functions);
  EXPECT_EQ(read.weights, pca.weights);
  EXPECT_FALSE(unpackPca(bytes, 5, 3, read));
  EXPECT_FALSE(unpackPca(bytes, 4, 4, read));
  EXPECT_FALSE(unpackPca(std::span(bytes).first(10), 4, 3, read));
  Pca nothing;
  nothing.mean = {1, 2, 3};
  EXPECT_TRUE(unpackPca(packPca(nothing), 4, 3, read));
  EXPECT_EQ(read.terms, 0);
}

TEST(BakeFingerprint, IsOfAllThatIsTracedAndOfNothingElse) {
  const auto scene = boxesOnFloor();
  const BakeSettings settings{.samplingResolution = 64};
  const auto own = fingerprintOf(scene, settings, "program 1");
  EXPECT_EQ(fingerprintOf(scene, settings, "program 1"), own);
  EXPECT_NE(fingerprintOf(scene, settings, "program 2"), own);
  const auto with = [&](const auto& change) {
    auto s = settings;
    change(s);
    return fingerprintOf(scene, s, "program 1");
  };
  EXPECT_NE(with([](BakeSettings& s) { s.compression = Compression::clustered; }), own);
  EXPECT_NE(with([](BakeSettings& s) { s.resolution = 32; }), own);
  EXPECT_NE(with([](BakeSettings& s) { s.samplingResolution = 128; }), own);
  EXPECT_NE(with([](BakeSettings& s) { s.directionCount = 16; }), own);
  EXPECT_NE(with([](BakeSettings& s) { s.directionSharpness = 16.0f; }), own);
  EXPECT_NE(with([](BakeSettings& s) { s.functions = 64; }), own);
  EXPECT_NE(with([](BakeSettings& s) { s.seed = 1; }), own);
  EXPECT_EQ(with([](BakeSettings& s) { s.terms = 4, s.clusters = 9, s.weightBits = 16, s.functionBits = 16, s.threads = 5; }), own);
  const auto of = [&](const auto& change) {
    auto s = scene;
    s.materials.emplace_back();
    s.primitives[1].material = 0;
    change(s);
    return fingerprintOf(s, settings, "program 1");
  };
  EXPECT_EQ(of([](Scene& s) { s.materials[0].roughnessFactor = 0.3f; }), own);
  EXPECT_NE(of([](Scene& s) { s.primitives[2].positions[3].x += 1e-6f; }), own);
  EXPECT_NE(of([](Scene& s) { s.primitives[2].normals[3] = glm::vec3(1, 0, 0); }), own);
  EXPECT_NE(of([](Scene& s) { std::swap(s.primitives[0].indices[0], s.primitives[0].indices[1]); }), own);
  EXPECT_NE(of([](Scene& s) { std::swap(s.primitives[0], s.primitives[1]); }), own);
  EXPECT_NE(of([](Scene& s) { s.materials[0].doubleSided = true; }), own);
  EXPECT_NE(of([](Scene& s) { s.materials[0].alphaMode = AlphaMode::blend; }), own);
  const auto masked = of([](Scene& s) { s.materials[0].alphaMode = AlphaMode::mask; });
  EXPECT_NE(masked, own);
  EXPECT_NE(of([](Scene& s) { s.materials[0].alphaMode = AlphaMode::mask, s.materials[0].alphaCutoff = 0.1f; }), masked);
}

}  // namespace
}  // namespace chiaro
