// The streams of a clustered transfer's lists: they come back, whatever made them, and nothing else does.
#include "assets/transfer/coded_lists.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <random>
#include <string>

#include "assets/transfer/transfer.h"
#include "tests/assets/asset_test_support.h"

namespace chiaro {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Small numbers, mostly 0, as lists hold.
Bytes anyBytes(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0.0f, 1.5f);
  Bytes bytes(count);
  for (auto& b : bytes) b = static_cast<std::uint8_t>(static_cast<int>(normal(random)));
  return bytes;
}

/// MiB, of this process.
double peakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
  return 0.0;
}

TEST(Xz, RoundTrip) {
  for (const std::size_t size : {0, 1, 2, 100, 4096, 65535, 65536, 65537, 131072, 400000}) {
    const auto bytes = anyBytes(size, 1);
    const auto stream = packXz(bytes);
    const auto back = unpackXz(stream, size);
    ASSERT_TRUE(back.has_value()) << size;
    EXPECT_TRUE(*back == bytes) << size;
    EXPECT_LE(stream.size(), 100 + size / 2) << "two bits each, nearly";
    EXPECT_EQ(stream, packXz(bytes));
  }
  // What cannot be packed is hardly longer.
  Bytes noise(200000);
  std::mt19937 random(2);
  for (auto& b : noise) b = static_cast<std::uint8_t>(random());
  const auto stream = packXz(noise);
  EXPECT_LE(stream.size(), 200200u);
  EXPECT_TRUE(unpackXz(stream, noise.size()) == noise);
}

TEST(Xz, MoreThanTheDictionary) {
  // Of 8 MiB: twelve times the same million bytes, and once more from far away.
  const auto piece = anyBytes(1000000, 4);
  Bytes bytes;
  for (int i = 0; i < 12; ++i) bytes.insert(bytes.end(), piece.begin(), piece.end());
  const auto stream = packXz(bytes);
  EXPECT_TRUE(unpackXz(stream, bytes.size()) == bytes);
}

TEST(Xz, IsWhatTheFormatSays) {
  const auto stream = packXz(anyBytes(1000, 5));
  const Bytes magic{0xFD, '7', 'z', 'X', 'Z', 0};
  EXPECT_TRUE(std::equal(magic.begin(), magic.end(), stream.begin()));
  EXPECT_EQ(stream[7], 1) << "CRC32";
  // The block header: its size in words, flags, both sizes, one filter: LZMA2 (0x21) with one byte of properties, a dictionary of 4 KiB (0).
  EXPECT_EQ(stream[13] & 3, 0) << "one filter";
  const Bytes filter{0x21, 1, 0};
  EXPECT_NE(std::search(stream.begin() + 12, stream.begin() + 28, filter.begin(), filter.end()), stream.begin() + 28);
}

TEST(Xz, OtherSizesAreRefused) {
  for (const std::size_t size : {0, 1, 5000, 65536, 200000}) {
    const auto stream = packXz(anyBytes(size, 6));
    for (const std::size_t wrong : {size + 1, size + 70000, 2 * size + 1, size - std::min<std::size_t>(size, 1), size / 2})
      EXPECT_TRUE(wrong == size || !unpackXz(stream, wrong)) << size << ", not " << wrong;
  }
}

TEST(Xz, DamageIsRefused) {
  const auto bytes = anyBytes(600, 7);
  const auto stream = packXz(bytes);
  for (std::size_t length = 0; length < stream.size(); ++length)
    EXPECT_FALSE(unpackXz(std::span(stream).first(length), bytes.size()).has_value()) << length;
  for (std::size_t i = 0; i < stream.size(); ++i)
    for (const int bit : {1, 16, 128}) {
      auto wrong = stream;
      wrong[i] = static_cast<std::uint8_t>(wrong[i] ^ bit);
      EXPECT_FALSE(unpackXz(wrong, bytes.size()).has_value()) << i;
    }
  auto longer = stream;
  longer.push_back(0);
  EXPECT_FALSE(unpackXz(longer, bytes.size()).has_value());
  longer.insert(longer.end(), 3, 0);
  EXPECT_FALSE(unpackXz(longer, bytes.size()).has_value()) << "padding that other readers may skip";
  longer = stream;
  longer.insert(longer.end(), stream.begin(), stream.end());
  EXPECT_FALSE(unpackXz(longer, bytes.size()).has_value());
  EXPECT_FALSE(unpackXz(longer, 2 * bytes.size()).has_value()) << "one stream";
  EXPECT_FALSE(unpackXz(bytes, bytes.size()).has_value()) << "not a stream";
}

TEST(Xz, HostileSizesTakeNoMemory) {
  const auto stream = packXz(anyBytes(1000, 8));
  const double before = peakMemory();
  for (const std::size_t size :
       {std::size_t{1} << 40, std::size_t{1} << 63, ~std::size_t{0}, 16384 * stream.size() + 16384, 16000 * stream.size()})
    EXPECT_FALSE(unpackXz(stream, size).has_value()) << size;
  EXPECT_FALSE(unpackXz({}, 0).has_value());
  EXPECT_FALSE(unpackXz({}, ~std::size_t{0}).has_value());
  // What packs best is still let through.
  const Bytes zeros(32 << 20);
  const auto packed = packXz(zeros);
  EXPECT_GT(zeros.size() / packed.size(), 6000u);
  const double full = peakMemory();
  EXPECT_FALSE(unpackXz(packed, 16000 * packed.size()).has_value()) << "twice what is in it";
  EXPECT_TRUE(unpackXz(packed, zeros.size()) == zeros);
  std::printf("peaks: %.0f MiB, with 32 MiB of zeros %.0f\n", before, full);
  EXPECT_GT(before, 0.0);
}

TEST(Planes, HoldEveryNumber) {
  std::vector<std::int16_t> all;
  for (int q = -32768; q <= 32767; ++q) all.push_back(static_cast<std::int16_t>(q));
  const auto two = planesOf(all, 2);
  ASSERT_EQ(two.size(), 2u * 65536u);
  EXPECT_EQ(valuesOfPlanes(two, 2), all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_EQ(two[65536 + i] == 0, all[i] >= -128 && all[i] <= 127) << all[i] << ": small numbers leave the high byte 0";
    // As a reader would put it together, in 32 bits and modulo 65536.
    const int low = two[i] < 128 ? two[i] : two[i] - 256;
    ASSERT_EQ((low + 256 * two[65536 + i]) & 65535, all[i] & 65535);
  }
  const std::vector<std::int16_t> small(all.begin() + 32768 - 127, all.begin() + 32768 + 128);
  EXPECT_EQ(valuesOfPlanes(planesOf(small, 1), 1), small);
  EXPECT_TRUE(planesOf({}, 2).empty());
}

/// Two clusters of 2 and 1 terms and one of none.
struct Weights {
  std::vector<TransferCluster> clusters{3};
  ClusteredVertices vertices{.cluster = {1, 0, 2, 0}, .weights = {10, 20, 21, 30, 31}};
  Weights() {
    clusters[0].terms = 2;
    clusters[1].terms = 1;
  }
};

TEST(CodedLists, WeightsLieTermByTerm) {
  const Weights w;
  const std::vector<std::int16_t> expected{10, 20, 30, 21, 31};
  EXPECT_EQ(weightsByTerm(w.vertices, w.clusters), expected);
  EXPECT_EQ(weightsByVertex(w.vertices, w.clusters, expected), w.vertices.weights);
  EXPECT_TRUE(weightsByTerm({}, w.clusters).empty());
}

TEST(CodedLists, HoldWhatTheFormatSays) {
  for (const int weightBits : {8, 16}) {
    const Transfer t = test::clusteredBake(true, weightBits).transfer;
    const auto lists = codedLists(t);
    EXPECT_TRUE(unpackXz(lists.functions, 1312) == t.clustered.functions.data);
    const auto means = unpackXz(lists.means, 2 * 3 * 7).value();
    const auto components = unpackXz(lists.components, 7 * 7).value();
    std::size_t component = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t d = 0; d < 7; ++d)
        EXPECT_EQ(static_cast<std::int16_t>(static_cast<std::int8_t>(means[7 * c + d]) + 256 * means[21 + 7 * c + d]),
                  t.clustered.clusters[c].mean[d]);
      for (const auto q : t.clustered.clusters[c].components) EXPECT_EQ(static_cast<std::int8_t>(components[component++]), q);
    }
    EXPECT_EQ(component, 49u);
    ASSERT_EQ(lists.clusters.size(), 3u);
    ASSERT_EQ(lists.weights.size(), 3u);
    for (std::size_t p = 0; p < 3; ++p) {
      const auto& own = t.primitives[p].clustered;
      const auto count = own.cluster.size(), weights = own.weights.size();
      const auto clusters = unpackXz(lists.clusters[p], 2 * count).value();
      const auto bytes = unpackXz(lists.weights[p], weights * static_cast<std::size_t>(weightBits / 8)).value();
      std::size_t next = 0;
      const auto first = own.firstWeights(t.clustered.clusters);
      for (std::size_t k = 0; k < 5; ++k)
        for (std::size_t v = 0; v < count; ++v) {
          EXPECT_EQ(clusters[v] + 256 * clusters[count + v], own.cluster[v]);
          if (k >= static_cast<std::size_t>(t.clustered.clusters[own.cluster[v]].terms)) continue;
          const int high = weightBits == 16 ? bytes[weights + next] : 0;
          EXPECT_EQ(static_cast<std::int16_t>(static_cast<std::int8_t>(bytes[next++]) + 256 * high), own.weights[first[v] + k]);
        }
      EXPECT_EQ(next, weights);
    }
  }
}

TEST(CodedLists, DoNotDependOnThreads) {
  const Transfer t = test::clusteredBake(true).transfer;
  {
    const auto one = codedLists(t, 1);
    for (const int threads : {0, 3, 64}) {
      const auto several = codedLists(t, threads);
      EXPECT_EQ(one.functions, several.functions);
      EXPECT_EQ(one.means, several.means);
      EXPECT_EQ(one.components, several.components);
      EXPECT_EQ(one.clusters, several.clusters);
      EXPECT_EQ(one.weights, several.weights);
      EXPECT_EQ(one.bytes(), several.bytes());
    }
    std::size_t sum = one.functions.size() + one.means.size() + one.components.size();
    for (std::size_t p = 0; p < 3; ++p) sum += one.clusters[p].size() + one.weights[p].size();
    EXPECT_EQ(one.bytes(), sum);
  }
}

TEST(CodedLists, OfNothingAreEmpty) {
  EXPECT_EQ(codedLists(test::sampleBake().transfer).bytes(), 0u) << "the global form has none";
  Transfer t;
  t.resolution = 2;
  t.clustered.clusters.resize(1);
  t.primitives.resize(2);
  t.primitives[0].clustered.cluster = {0, 0};
  const auto lists = codedLists(t);
  EXPECT_TRUE(lists.functions.empty() && lists.means.empty() && lists.components.empty() && lists.weights[0].empty() &&
              lists.clusters[1].empty());
  EXPECT_TRUE(unpackXz(lists.clusters[0], 4) == Bytes(4));
  EXPECT_TRUE(holds(lists, t));
}

TEST(CodedLists, HoldOneTransferOnly) {
  const Transfer right = test::clusteredBake(false, 16).transfer;
  const auto holdsWith = [&](auto change) {
    Transfer t = right;
    change(t);
    EXPECT_TRUE(holds(codedLists(t), t));
    return holds(codedLists(right), t);
  };
  using T = Transfer&;
  EXPECT_TRUE(holdsWith([](T) {}));
  EXPECT_TRUE(holdsWith([](T t) { t.clustered.clusters[0].meanScale = 2.0f; })) << "not in a list";
  EXPECT_FALSE(holdsWith([](T t) { t.clustered.functions.data[5] ^= 1; }));
  EXPECT_FALSE(holdsWith([](T t) { t.clustered.clusters[1].mean[3] ^= 256; }));
  EXPECT_FALSE(holdsWith([](T t) { t.clustered.clusters[2].components[3] ^= 1; }));
  EXPECT_FALSE(holdsWith([](T t) { t.primitives[2].clustered.weights[0] ^= 1; }));
  EXPECT_FALSE(holdsWith([](T t) {
    auto& own = t.primitives[2].clustered;
    own.weights.clear();
    own.cluster.assign(own.cluster.size(), 1);
  }));
  EXPECT_FALSE(holdsWith([](T t) { t.primitives.pop_back(); }));
  EXPECT_FALSE(holds(codedLists(right), test::sampleBake().transfer));
}

}  // namespace
}  // namespace chiaro
