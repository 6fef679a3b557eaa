#include "runtime/render/gpu_transfer.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

#include "assets/error.h"
#include "runtime/render/frame_block.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

int vectorsOf(int terms) { return (terms + 3) / 4; }

/// Where each texel of a cell, border included, reads from: one map of the SSDF, or the levels' maps on top of each other.
struct CellLayout {
  int width = 0, height = 0;
  std::vector<std::size_t> source;  ///< width by height, into a row of maps

  void addMap(int resolution, int firstRow, std::size_t firstColumn) {
    for (int y = 0; y < resolution + 2; ++y)
      for (int x = 0; x < resolution + 2; ++x) {
        const glm::ivec2 texel = lobe32::octahedralWrapTexel(glm::ivec2(x - 1, y - 1), resolution);
        source[at(firstRow + y) * at(width) + at(x)] = firstColumn + at(texel.y) * at(resolution) + at(texel.x);
      }
  }
  static CellLayout ssdf(int resolution) {
    CellLayout layout{resolution + 2, resolution + 2, std::vector<std::size_t>(at(resolution + 2) * at(resolution + 2), 0)};
    layout.addMap(resolution, 0, 0);
    return layout;
  }
  /// firstColumn: of the first level in a row.
  static CellLayout levels(const std::vector<VisibilityLevel>& levels, std::size_t firstColumn) {
    CellLayout layout;
    for (const auto& level : levels) {
      layout.width = std::max(layout.width, level.resolution + 2);
      layout.height += level.resolution + 2;
    }
    layout.source.assign(at(layout.width) * at(layout.height), firstColumn);
    int row = 0;
    for (const auto& level : levels) {
      layout.addMap(level.resolution, row, firstColumn);
      row += level.resolution + 2;
      firstColumn += at(level.resolution) * at(level.resolution);
    }
    return layout;
  }
};

/// A texture array of `cells` cells of one size.
gl::Texture cellTexture(GLenum format, const CellLayout& layout, std::size_t cells, int columns) {
  const int layers = static_cast<int>((cells + at(columns) - 1) / at(columns));
  return gl::Texture::make2dArray(format, layout.width * columns, layout.height, std::max(layers, 1));
}

int columnsFor(std::size_t cells) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
  return static_cast<int>((cells + at(most) - 1) / at(most));
}

/// texels: halves, to the nearest. Of floats, drivers may cut bits off (Mesa does), and every map would lean towards 0.
template <class T>
void uploadCell(gl::Texture& texture, const CellLayout& layout, int columns, std::size_t cell, GLenum format, const std::vector<T>& texels) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
  glTextureSubImage3D(texture.id(), 0, static_cast<GLint>(cell % at(columns)) * layout.width, 0, static_cast<GLint>(cell / at(columns)), layout.width,
                      layout.height, 1, format, GL_HALF_FLOAT, texels.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

/// `maps`: rows of `stride` values in the order of clusterMaps; steps: the stored weight that a shader reads as 1.
void fillCells(const std::vector<TransferCluster>& clusters, const CellLayout& layout, const std::vector<float>& maps, std::size_t stride,
                      float steps, gl::Texture& means, gl::Texture& terms, int& columns) {
  std::size_t cells = 0;
  for (const auto& cluster : clusters) cells += at(vectorsOf(cluster.terms));
  columns = std::max(1, std::max(columnsFor(cells), columnsFor(clusters.size())));
  means = cellTexture(GL_R16F, layout, clusters.size(), columns);
  terms = cellTexture(GL_RGBA16F, layout, std::max<std::size_t>(cells, 1), columns);
  const float* map = maps.data();
  std::size_t cell = 0;
  std::vector<glm::uint16> mean(layout.source.size());
  std::vector<glm::u16vec4> four(layout.source.size());
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (std::size_t t = 0; t < mean.size(); ++t) mean[t] = glm::packHalf1x16(map[layout.source[t]]);
    uploadCell(means, layout, columns, c, GL_RED, mean);
    map += stride;
    for (int first = 0; first < clusters[c].terms; first += 4, ++cell) {
      std::fill(four.begin(), four.end(), glm::u16vec4(0));
      for (int i = 0; i < std::min(4, clusters[c].terms - first); ++i, map += stride) {
        const float scale = clusters[c].weightScale[at(first + i)] * steps;
        for (std::size_t t = 0; t < four.size(); ++t) four[t][i] = glm::packHalf1x16(map[layout.source[t]] * scale);
      }
      uploadCell(terms, layout, columns, cell, GL_RGBA, four);
    }
  }
}

/// Without terms every vertex has the mean: the scene may be open everywhere, or nowhere.
bool isOpen(const Transfer& transfer) {
  const auto maps = transfer.clustered.empty()
                        ? transfer.mean
                        : clusterMaps(transfer.clustered.clusters, transfer.clustered.functions.unpack(transfer.columns()), transfer.mean, 0, transfer.columns());
  constexpr float kFree = 0.25f;  // radians of SSDF, or share of a level: rounding aside, both are at their most or below 0
  return std::all_of(maps.begin(), maps.end(), [](float value) { return value > kFree; });
}

}  // namespace

void requireStorage(std::size_t bytes, const char* what) {
  GLint64 limit = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limit);
  if (bytes > static_cast<std::size_t>(limit))
    throw Error(ExitCode::failed, "OpenGL", std::string("the ") + what + " need " + std::to_string(bytes >> 20) + " MiB in one buffer, the driver allows " +
                                                std::to_string(limit >> 20), "bake with fewer terms or split the scene");
}

GpuTransfer::GpuTransfer(const BakedScene& baked) {
  const Transfer& transfer = baked.transfer;
  vertexCount_ = baked.scene.vertexCount();
  resolution_ = transfer.resolution;
  directionVectors_ = transfer.directionCount / 4;
  levels_ = transfer.clustered.levels;
  if (transfer.directionCount < 4 || transfer.directionCount > kMaxDirections)
    throw inputError("scene", std::to_string(transfer.directionCount) + " fixed directions, the renderer takes 4 to 64", "bake it again");
  std::vector<std::uint8_t> visibility;
  for (const auto& primitive : transfer.primitives) visibility.insert(visibility.end(), primitive.visibility.begin(), primitive.visibility.end());
  requireStorage(visibility.size(), "visible fractions");
  visibility_ = gl::Buffer(visibility);

  occludes_ = transfer.terms > 0 || transfer.clustered.clusters.size() > 1 || !isOpen(transfer);
  if (!occludes_) return;
  termVectors_ = std::max(1, vectorsOf(transfer.terms));
  uploadWeights(transfer);
  if (transfer.clustered.empty()) uploadGlobal(transfer);
  else uploadClusters(transfer);
}

/// Per vertex its cluster and where its weights begin; weights in words, padded to four a vector.
void GpuTransfer::uploadWeights(const Transfer& transfer) {
  const auto& clusters = transfer.clustered.clusters;
  softness_ = transfer.clustered.ssdfSoftness;
  weightBits_ = transfer.clustered.empty() ? 16 : transfer.clustered.weightBits;
  std::vector<std::uint32_t> words;
  std::vector<glm::uvec2> vertices;
  const auto append = [&](const std::int16_t* weights, int terms) {
    for (int first = 0; first < terms; first += 4) {
      std::uint32_t q[4] = {};
      for (int i = 0; i < std::min(4, terms - first); ++i) q[i] = static_cast<std::uint16_t>(weights[first + i]);
      if (weightBits_ == 8) words.push_back((q[0] & 255u) | (q[1] & 255u) << 8 | (q[2] & 255u) << 16 | (q[3] & 255u) << 24);
      else {
        words.push_back(q[0] | q[1] << 16);
        words.push_back(q[2] | q[3] << 16);
      }
    }
  };
  for (const auto& primitive : transfer.primitives) {
    if (clusters.empty()) {
      const auto stride = at(transfer.paddedTerms());
      for (std::size_t v = 0; v * stride < primitive.weights.size(); ++v) {
        vertices.emplace_back(0u, static_cast<std::uint32_t>(words.size()));
        append(primitive.weights.data() + v * stride, transfer.paddedTerms());
      }
      continue;
    }
    const auto first = primitive.clustered.firstWeights(clusters);
    for (std::size_t v = 0; v < primitive.clustered.cluster.size(); ++v) {
      const auto c = primitive.clustered.cluster[v];
      vertices.emplace_back(c, static_cast<std::uint32_t>(words.size()));
      append(primitive.clustered.weights.data() + first[v], clusters[c].terms);
    }
  }
  words.push_back(0);  // a buffer needs a size
  requireStorage(words.size() * sizeof(words[0]), "transfer weights");
  requireStorage(vertices.size() * sizeof(vertices[0]), "vertices' clusters");
  weights_ = gl::Buffer(words);
  vertices_ = gl::Buffer(vertices);

  std::vector<glm::uvec2> table;  // of each cluster: its first cell, its cells
  std::uint32_t cell = 0;
  for (const auto& cluster : clusters) {
    table.emplace_back(cell, static_cast<std::uint32_t>(vectorsOf(cluster.terms)));
    cell += table.back().y;
  }
  if (clusters.empty()) table.emplace_back(0u, static_cast<std::uint32_t>(vectorsOf(transfer.terms)));
  clusters_ = gl::Buffer(table);
  slots_ = table.size() > 1 ? 3 : 1;
}

void GpuTransfer::uploadGlobal(const Transfer& transfer) {
  std::vector<TransferCluster> one(1);
  one[0].terms = transfer.terms;
  for (const float scale : transfer.weightScale) one[0].weightScale.push_back(scale / 32767.0f);
  std::vector<float> maps = transfer.mean;
  maps.insert(maps.end(), transfer.eigenfunctions.begin(), transfer.eigenfunctions.end());
  fillCells(one, CellLayout::ssdf(resolution_), maps, transfer.texels(), 32767.0f, ssdf_.means, ssdf_.terms, ssdf_.columns);
}

void GpuTransfer::uploadClusters(const Transfer& transfer) {
  const auto& c = transfer.clustered;
  const float steps = c.weightBits == 8 ? 127.0f : 32767.0f;
  const auto functions = c.functions.unpack(transfer.columns());
  const auto texels = transfer.texels();
  fillCells(c.clusters, CellLayout::ssdf(resolution_), clusterMaps(c.clusters, functions, transfer.mean, 0, texels), texels, steps, ssdf_.means, ssdf_.terms,
            ssdf_.columns);
  if (levels_.empty()) return;
  const auto count = transfer.levelTexels();
  fillCells(c.clusters, CellLayout::levels(levels_, 0), clusterMaps(c.clusters, functions, transfer.mean, texels, texels + count), count, steps, level_.means,
            level_.terms, level_.columns);
}

std::vector<std::string> GpuTransfer::defines() const {
  const auto number = [](const char* name, auto value) { return std::string(name) + " " + std::to_string(value); };
  std::vector<std::string> result{number("TERM_VECTORS", occludes_ ? termVectors_ : 0), number("DIRECTION_VECTORS", directionVectors_),
                                  number("LEVELS", occludes_ ? levels_.size() : 0)};
  if (!occludes_) return result;
  result.insert(result.end(), {number("SLOTS", slots_), number("WEIGHT_BITS", weightBits_), number("SSDF_RESOLUTION", resolution_),
                               number("SSDF_COLUMNS", ssdf_.columns), number("SSDF_SOFTNESS", softness_)});
  if (levels_.empty()) return result;
  std::string resolutions = "LEVEL_RESOLUTIONS int[](", rows = "LEVEL_ROWS int[](";
  int row = 0, width = 0;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    resolutions += (l > 0 ? ", " : "") + std::to_string(levels_[l].resolution);
    rows += (l > 0 ? ", " : "") + std::to_string(row);
    row += levels_[l].resolution + 2;
    width = std::max(width, levels_[l].resolution + 2);
  }
  result.insert(result.end(), {resolutions + ")", rows + ")", number("LEVEL_WIDTH", width), number("LEVEL_HEIGHT", row), number("LEVEL_COLUMNS", level_.columns),
                               number("LEVEL_FIRST", levels_[0].sharpness),
                               number("LEVEL_RATIO", levels_.size() > 1 ? levels_[1].sharpness / levels_[0].sharpness : 2.0f)});
  return result;
}

void GpuTransfer::bind() const {
  visibility_.bindBase(GL_SHADER_STORAGE_BUFFER, 4);
  if (!occludes_) return;
  weights_.bindBase(GL_SHADER_STORAGE_BUFFER, 3);
  vertices_.bindBase(GL_SHADER_STORAGE_BUFFER, 6);
  clusters_.bindBase(GL_SHADER_STORAGE_BUFFER, 7);
  ssdf_.terms.bind(7);
  ssdf_.means.bind(8);
  if (levels_.empty()) return;
  level_.terms.bind(11);
  level_.means.bind(12);
}

std::size_t GpuTransfer::bytes() const {
  const auto size = [](const gl::Texture& t, std::size_t texel) { return t ? at(t.width()) * at(t.height()) * at(t.layers()) * texel : 0; };
  const auto buffer = [](const gl::Buffer& b) { return b ? b.size() : 0; };
  return buffer(visibility_) + buffer(weights_) + buffer(vertices_) + buffer(clusters_) + size(ssdf_.terms, 8) + size(ssdf_.means, 2) + size(level_.terms, 8) +
         size(level_.means, 2);
}

}  // namespace chiaro
