#include "precompute/compression/pca.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "precompute/compression/product.h"
#include "precompute/parallel.h"

namespace chiaro {
namespace {

using RowMatrix = RowMajor<float>;

// Block shapes are part of the result's bits: they never depend on the number of threads.
constexpr std::size_t kColumnBlock = 256;

std::size_t blocks(std::size_t count, std::size_t size) { return (count + size - 1) / size; }

/// A standard normal number that depends on its index alone (splitmix64, Box and Muller).
float gaussian(std::uint64_t seed, std::uint64_t index) {
  const auto mix = [](std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
  };
  const auto unit = [](std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; };
  const auto key = mix(seed) + 2 * index;
  return static_cast<float>(std::sqrt(-2.0 * std::log(unit(mix(key)))) * std::cos(2.0 * std::numbers::pi * unit(mix(key + 1))));
}

constexpr std::size_t kStripBytes = std::size_t{64} << 20;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// The centred matrix with its columns multiplied by sqrt(columnWeight), never built whole.
class Weighted {
 public:
  Weighted(const RowBlocks& rows, float range, const std::vector<float>& columnWeight, int threads)
      : rows_(rows), step_(range / 32767.0f), threads_(threads), mean(rows.columns()), root(index(rows.columns())) {
    const auto columns = rows.columns();
    for (std::size_t j = 0; j < columns; ++j) root[index(j)] = std::sqrt(columnWeight[j]);
    std::vector<std::int64_t> sum(columns, 0);
    forEachStrip([&](std::size_t first, const Strip& strip) {
      parallelBlocks(threads_, columnBlocks(), [&](std::size_t block) {
        const auto begin = block * kColumnBlock, end = std::min(begin + kColumnBlock, columns);
        for (std::size_t b = 0; b < strip.size(); ++b)
          for (std::size_t i = 0; i < rows_.rowsOf(first + b); ++i)
            for (std::size_t j = begin; j < end; ++j) sum[j] += strip[b][i * columns + j];
      });
    });
    for (std::size_t j = 0; j < columns; ++j)
      mean[j] = static_cast<float>(static_cast<double>(sum[j]) / static_cast<double>(rows.rows()) * static_cast<double>(step_));
  }

  std::size_t columnBlocks() const { return blocks(rows_.columns(), kColumnBlock); }

  /// The matrix times `right` (#columns by l): `use` gets the product of each block of rows, in their order.
  void times(const RowMatrix& right, StepCounter& steps, const std::function<void(std::size_t block, const RowMatrix&)>& use) const {
    forEachStrip([&](std::size_t first, const Strip& strip) {
      std::vector<RowMatrix> products(strip.size());
      multiply(first, strip, right, products, steps);
      for (std::size_t b = 0; b < strip.size(); ++b) use(first + b, products[b]);
    });
  }

  /// The transposed matrix times the matrix times `right`: #columns by l. Each block of columns sums over the rows in their order.
  RowMatrix covarianceTimes(const RowMatrix& right, StepCounter& steps) const {
    const auto columns = rows_.columns();
    RowMajor<double> sum = RowMajor<double>::Zero(index(columns), right.cols());
    forEachStrip([&](std::size_t first, const Strip& strip) {
      std::vector<RowMatrix> products(strip.size());
      multiply(first, strip, right, products, steps);
      parallelBlocks(threads_, columnBlocks(), [&](std::size_t block) {
        const auto begin = block * kColumnBlock, count = std::min(kColumnBlock, columns - begin);
        RowMatrix part;
        for (std::size_t b = 0; b < strip.size(); ++b) {
          part.resize(products[b].rows(), index(count));
          load(strip[b], begin, part);
          sum.middleRows(index(begin), index(count)) += productTransposedA(part, products[b]).cast<double>();
        }
      });
      steps.add(strip.size());
    });
    return sum.cast<float>();
  }

  double energy() const {
    std::vector<double> part(rows_.blocks(), 0.0);
    forEachStrip([&](std::size_t first, const Strip& strip) {
      parallelBlocks(threads_, strip.size(), [&](std::size_t b) {
        RowMatrix rows(index(rows_.rowsOf(first + b)), index(rows_.columns()));
        load(strip[b], 0, rows);
        for (Eigen::Index i = 0; i < rows.rows(); ++i) part[first + b] += rows.row(i).cast<double>().squaredNorm();
      });
    });
    double sum = 0.0;
    for (const double p : part) sum += p;
    return sum;
  }

 private:
  using Strip = std::vector<const std::int16_t*>;  ///< blocks of rows, one behind the other

  /// How many blocks are read at once never changes the result: sums go block by block.
  void forEachStrip(const std::function<void(std::size_t first, const Strip&)>& use) const {
    const auto most = std::max<std::size_t>(kStripBytes / (2 * RowBlocks::kRows * std::max<std::size_t>(rows_.columns(), 1)), 1);
    std::vector<std::vector<std::byte>> room(std::min(most, rows_.blocks()));
    for (std::size_t first = 0; first < rows_.blocks(); first += most) {
      Strip strip(std::min(most, rows_.blocks() - first));
      parallelBlocks(threads_, strip.size(), [&](std::size_t b) { strip[b] = rows_.block(first + b, room[b]); });
      use(first, strip);
    }
  }

  void multiply(std::size_t first, const Strip& strip, const RowMatrix& right, std::vector<RowMatrix>& products, StepCounter& steps) const {
    parallelBlocks(threads_, strip.size(), [&](std::size_t b) {
      RowMatrix part(index(rows_.rowsOf(first + b)), index(rows_.columns()));
      load(strip[b], 0, part);
      products[b] = product(part, right);
      steps.add();
    });
  }

  /// Columns firstColumn, ... of a block's first rows, as many as `part` has.
  void load(const std::int16_t* block, std::size_t firstColumn, RowMatrix& part) const {
    for (Eigen::Index i = 0; i < part.rows(); ++i) {
      const auto* source = block + static_cast<std::size_t>(i) * rows_.columns() + firstColumn;
      auto* target = part.row(i).data();
      for (std::size_t j = 0; j < static_cast<std::size_t>(part.cols()); ++j)
        target[j] = (static_cast<float>(source[j]) * step_ - mean[firstColumn + j]) * root[index(firstColumn + j)];
    }
  }

  const RowBlocks& rows_;
  float step_;
  int threads_;

 public:
  std::vector<float> mean;
  Eigen::VectorXf root;
};

/// A matrix in memory, as blocks.
class MatrixBlocks : public RowBlocks {
 public:
  explicit MatrixBlocks(const FixedPointMatrix& matrix) : RowBlocks(matrix.rows, matrix.columns), matrix_(matrix) {}
  const std::int16_t* block(std::size_t block, std::vector<std::byte>&) const override { return matrix_.row(block * kRows); }

 private:
  const FixedPointMatrix& matrix_;
};

}  // namespace

void toFixedPoint(const float* values, std::size_t count, float range, std::int16_t* out) {
  const float scale = 32767.0f / range;
  for (std::size_t j = 0; j < count; ++j) out[j] = roundedToInt16(values[j] * scale);
}

void FixedPointMatrix::setRow(std::size_t i, const float* source) { toFixedPoint(source, columns, range, row(i)); }

Pca leadingTerms(const Pca& pca, int terms) {
  Pca result;
  result.terms = std::min(terms, pca.terms);
  const auto count = static_cast<std::size_t>(result.terms);
  result.mean = pca.mean;
  result.functions.assign(pca.functions.begin(), pca.functions.begin() + index(count * pca.mean.size()));
  result.energy.assign(pca.energy.begin(), pca.energy.begin() + index(count));
  result.totalEnergy = pca.totalEnergy;
  return result;
}

Pca computePca(const FixedPointMatrix& matrix, const std::vector<float>& columnWeight, const PcaSettings& settings,
               const std::function<void(double)>& progress) {
  return computePca(MatrixBlocks(matrix), matrix.range, columnWeight, settings, progress);
}

std::size_t pcaMemory(std::size_t rows, std::size_t columns, const PcaSettings& settings) {
  const auto width = std::min({static_cast<std::size_t>(settings.terms + settings.oversampling), rows, columns});
  const auto strip = std::min(kStripBytes, 2 * rows * columns) + 2 * RowBlocks::kRows * columns;
  const auto threads = static_cast<std::size_t>(threadCount(settings.threads));
  // The widest moment is orthonormalising: the block, its copy in double, its factors and the result. Rows in use are held as floats too.
  return strip + strip / columns * width * 2 + threads * RowBlocks::kRows * columns * 4 + columns * width * 36 + rows * width * 4;
}

Pca computePca(const RowBlocks& rows, float range, const std::vector<float>& columnWeight, const PcaSettings& settings,
               const std::function<void(double)>& progress) {
  const auto columns = rows.columns();
  const Weighted a(rows, range, columnWeight, settings.threads);
  Pca result;
  result.mean = a.mean;
  result.totalEnergy = a.energy();

  double allWeight = 0.0;
  for (const float w : columnWeight) allWeight += static_cast<double>(w);
  const double leastEnergy = settings.leastRms * settings.leastRms * static_cast<double>(rows.rows()) * allWeight;
  const auto width = index(std::min({static_cast<std::size_t>(settings.terms + settings.oversampling), rows.rows(), columns}));
  if (!(result.totalEnergy > leastEnergy)) return result;

  const auto iterations = static_cast<std::size_t>(settings.iterations);
  StepCounter steps((2 * iterations + 1) * rows.blocks(), progress);

  RowMatrix basis(index(columns), width);
  for (Eigen::Index i = 0; i < basis.size(); ++i) basis.data()[i] = gaussian(settings.seed, static_cast<std::uint64_t>(i));
  for (std::size_t k = 0; k < iterations; ++k) basis = orthonormalised(a.covarianceTimes(basis, steps));

  auto& weights = result.weights;  // first the coordinates in the basis
  weights.resize(rows.rows() * static_cast<std::size_t>(width));
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(width, width);
  a.times(basis, steps, [&](std::size_t block, const RowMatrix& coordinates) {
    const RowMajor<double> part = coordinates.cast<double>();
    gram += productTransposedA(part, part);
    std::copy_n(coordinates.data(), coordinates.size(), weights.begin() + index(block * RowBlocks::kRows) * width);
  });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  const auto strongest = [&](int k) { return width - 1 - k; };  // the solver sorts upwards
  while (result.terms < std::min(settings.terms, static_cast<int>(width)) &&
         eigen.eigenvalues()[strongest(result.terms)] > leastEnergy)
    ++result.terms;

  RowMajor<double> rotation(width, result.terms);
  result.functions.resize(static_cast<std::size_t>(result.terms) * columns);
  for (int k = 0; k < result.terms; ++k) rotation.col(k) = eigen.eigenvectors().col(strongest(k));
  {
    const RowMajor<double> functions = product(RowMajor<double>(basis.cast<double>()), rotation);
    for (int k = 0; k < result.terms; ++k) {
      // An eigenvector's sign is anyone's choice; ours: its largest entry is positive.
      Eigen::Index largest = 0;
      functions.col(k).cwiseAbs().maxCoeff(&largest);
      const double sign = functions(largest, k) < 0.0 ? -1.0 : 1.0;
      rotation.col(k) *= sign;
      result.energy.push_back(eigen.eigenvalues()[strongest(k)]);
      for (std::size_t j = 0; j < columns; ++j)
        result.functions[static_cast<std::size_t>(k) * columns + j] = static_cast<float>(sign * functions(index(j), k) / static_cast<double>(a.root[index(j)]));
    }
  }
  // Turned in place, block by block: there are no more terms than there were columns.
  auto to = weights.begin();
  for (std::size_t b = 0; b < rows.blocks(); ++b) {
    const Eigen::Map<const RowMatrix> coordinates(weights.data() + b * RowBlocks::kRows * static_cast<std::size_t>(width), index(rows.rowsOf(b)), width);
    const RowMatrix turned = product(RowMajor<double>(coordinates.cast<double>()), rotation).cast<float>();
    to = std::copy_n(turned.data(), turned.size(), to);
  }
  weights.erase(to, weights.end());
  return result;
}

}  // namespace chiaro
