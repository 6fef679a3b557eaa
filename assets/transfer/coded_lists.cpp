#include "assets/transfer/coded_lists.h"

#include <lzma.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <future>
#include <new>
#include <string>
#include <thread>

#include "assets/error.h"
#include "assets/transfer/transfer.h"

namespace chiaro {
namespace {

constexpr std::uint32_t kLeastDictionary = 4096;  // that LZMA knows
constexpr std::uint64_t kDecoderMemory = 64 << 20;
constexpr std::size_t kMostRatio = 16384;  // LZMA packs zeros 7100 to 1
constexpr std::size_t kFirstPiece = 1 << 16;

using Bytes = std::vector<std::uint8_t>;

Bytes functionBytes(const Transfer& t) { return t.clustered.functions.data; }

Bytes meanBytes(const Transfer& t) {
  std::vector<std::int16_t> all;
  for (const auto& c : t.clustered.clusters) all.insert(all.end(), c.mean.begin(), c.mean.end());
  return planesOf(all, 2);
}

Bytes componentBytes(const Transfer& t) {
  Bytes all;
  for (const auto& c : t.clustered.clusters)
    for (const auto q : c.components) all.push_back(static_cast<std::uint8_t>(q));
  return all;
}

Bytes clusterBytes(const ClusteredVertices& vertices) {
  Bytes all;
  for (const int shift : {0, 8})
    for (const auto c : vertices.cluster) all.push_back(static_cast<std::uint8_t>(c >> shift & 255));
  return all;
}

Bytes weightBytes(const Transfer& t, const ClusteredVertices& vertices) {
  return planesOf(weightsByTerm(vertices, t.clustered.clusters), t.clustered.weightBits / 8);
}

/// A list's bytes, made when they are asked for, and where its stream is.
template <class Stream>
struct List {
  std::function<Bytes()> bytes;
  Stream* stream;
};

/// Stream: Bytes, const or not, as lists' are. The longest first, so that threads end together.
template <class Lists>
auto listsOf(const Transfer& t, Lists& lists) {
  using Stream = std::remove_reference_t<decltype((lists.functions))>;
  std::vector<List<Stream>> all{{[&t] { return functionBytes(t); }, &lists.functions},
                                {[&t] { return componentBytes(t); }, &lists.components},
                                {[&t] { return meanBytes(t); }, &lists.means}};
  for (std::size_t p = 0; p < t.primitives.size(); ++p)
    all.push_back({[&t, p] { return weightBytes(t, t.primitives[p].clustered); }, &lists.weights[p]});
  for (std::size_t p = 0; p < t.primitives.size(); ++p)
    all.push_back({[&t, p] { return clusterBytes(t.primitives[p].clustered); }, &lists.clusters[p]});
  return all;
}

/// Calls `action` with each of 0 .. count - 1.
void inParallel(std::size_t count, int threads, const std::function<void(std::size_t)>& action) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) action(i);
  };
  const auto all =
      threads > 0 ? static_cast<std::size_t>(threads) : std::max<std::size_t>(std::thread::hardware_concurrency(), 1);
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < std::min(all, count); ++i) others.push_back(std::async(std::launch::async, work));
  work();
  for (auto& other : others) other.get();
}

}  // namespace

std::size_t CodedLists::bytes() const {
  std::size_t sum = functions.size() + means.size() + components.size();
  for (const auto* lists : {&clusters, &weights})
    for (const auto& list : *lists) sum += list.size();
  return sum;
}

CodedLists codedLists(const Transfer& transfer, int threads) {
  CodedLists lists;
  if (transfer.clustered.empty()) return lists;
  lists.clusters.resize(transfer.primitives.size());
  lists.weights.resize(transfer.primitives.size());
  const auto all = listsOf(transfer, lists);
  inParallel(all.size(), threads, [&](std::size_t i) {
    const auto bytes = all[i].bytes();
    if (!bytes.empty()) *all[i].stream = packXz(bytes);
  });
  return lists;
}

bool holds(const CodedLists& lists, const Transfer& transfer) {
  if (transfer.clustered.empty()) return lists.bytes() == 0;
  if (lists.clusters.size() != transfer.primitives.size() || lists.weights.size() != transfer.primitives.size()) return false;
  const auto all = listsOf(transfer, lists);
  return std::all_of(all.begin(), all.end(), [](const auto& list) {
    const auto bytes = list.bytes();
    return bytes.empty() ? list.stream->empty() : unpackXz(*list.stream, bytes.size()) == bytes;
  });
}

Bytes packXz(std::span<const std::uint8_t> bytes) {
  lzma_options_lzma options;
  lzma_lzma_preset(&options, 6);
  options.lc = 4;
  options.lp = options.pb = 0;
  options.dict_size = static_cast<std::uint32_t>(std::clamp<std::size_t>(bytes.size(), kLeastDictionary, options.dict_size));
  // Rounded noise hardly repeats: a deeper search takes four times as long for a twelfth of the bytes.
  options.mf = LZMA_MF_HC4;
  options.nice_len = 32;
  options.depth = 4;
  lzma_filter filters[] = {{LZMA_FILTER_LZMA2, &options}, {LZMA_VLI_UNKNOWN, nullptr}};
  Bytes stream(lzma_stream_buffer_bound(bytes.size()));
  std::size_t size = 0;
  const auto result = lzma_stream_buffer_encode(filters, LZMA_CHECK_CRC32, nullptr, bytes.data(), bytes.size(), stream.data(),
                                                &size, stream.size());
  if (result == LZMA_MEM_ERROR) throw std::bad_alloc();
  if (result != LZMA_OK)
    throw Error(ExitCode::failed, "liblzma", "packs nothing (error " + std::to_string(result) + ")",
                "this is a bug, please report it");
  stream.resize(size);
  stream.shrink_to_fit();
  return stream;
}

std::optional<Bytes> unpackXz(std::span<const std::uint8_t> stream, std::size_t size) {
  if (size / kMostRatio > stream.size()) return std::nullopt;
  lzma_stream decoder = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&decoder, kDecoderMemory, 0) != LZMA_OK) throw std::bad_alloc();
  const struct End {
    lzma_stream& of;
    ~End() { lzma_end(&of); }
  } end{decoder};
  // One byte more than there should be, so that longer streams show.
  Bytes bytes(std::min(size, kFirstPiece) + 1);
  decoder.next_in = stream.data();
  decoder.avail_in = stream.size();
  decoder.next_out = bytes.data();
  decoder.avail_out = bytes.size();
  for (;;) {
    const auto result = lzma_code(&decoder, LZMA_FINISH);
    if (result == LZMA_MEM_ERROR) throw std::bad_alloc();
    const auto done = bytes.size() - decoder.avail_out;
    if (done > size || (result != LZMA_OK && result != LZMA_STREAM_END)) return std::nullopt;
    if (result == LZMA_STREAM_END) {
      if (done != size || decoder.avail_in != 0) return std::nullopt;
      bytes.resize(size);
      return bytes;
    }
    if (decoder.avail_out > 0) return std::nullopt;  // it wants more than there is
    bytes.resize(std::min(2 * done, size + 1));
    decoder.next_out = bytes.data() + done;
    decoder.avail_out = bytes.size() - done;
  }
}

Bytes planesOf(std::span<const std::int16_t> values, int bytesPerValue) {
  Bytes planes;
  planes.reserve(values.size() * static_cast<std::size_t>(bytesPerValue));
  for (const auto q : values) planes.push_back(static_cast<std::uint8_t>(q & 255));
  if (bytesPerValue == 2)
    for (const auto q : values) planes.push_back(static_cast<std::uint8_t>((q + 128) >> 8 & 255));
  return planes;
}

std::vector<std::int16_t> valuesOfPlanes(std::span<const std::uint8_t> planes, int bytesPerValue) {
  const auto count = planes.size() / static_cast<std::size_t>(bytesPerValue);
  std::vector<std::int16_t> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const int low = static_cast<std::int8_t>(planes[i]), high = bytesPerValue == 2 ? planes[count + i] : 0;
    values[i] = static_cast<std::int16_t>(low + 256 * high);
  }
  return values;
}

namespace {

/// Calls `action` with each place in ClusteredVertices::weights, in the order of weightsByTerm.
template <class Action>
void byTermOrder(const ClusteredVertices& vertices, const std::vector<TransferCluster>& clusters, Action action) {
  const auto first = vertices.firstWeights(clusters);
  bool any = true;
  for (std::size_t k = 0; any; ++k) {
    any = false;
    for (std::size_t v = 0; v < vertices.cluster.size(); ++v) {
      if (k >= first[v + 1] - first[v]) continue;
      any = true;
      action(first[v] + k);
    }
  }
}

}  // namespace

std::vector<std::int16_t> weightsByTerm(const ClusteredVertices& vertices, const std::vector<TransferCluster>& clusters) {
  std::vector<std::int16_t> weights;
  weights.reserve(vertices.weights.size());
  byTermOrder(vertices, clusters, [&](std::size_t place) { weights.push_back(vertices.weights[place]); });
  return weights;
}

std::vector<std::int16_t> weightsByVertex(const ClusteredVertices& vertices, const std::vector<TransferCluster>& clusters,
                                          const std::vector<std::int16_t>& byTerm) {
  std::vector<std::int16_t> weights(byTerm.size());
  std::size_t next = 0;
  byTermOrder(vertices, clusters, [&](std::size_t place) { weights[place] = byTerm[next++]; });
  return weights;
}

}  // namespace chiaro
