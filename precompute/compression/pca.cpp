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
constexpr std::size_t kRowBlock = 128;
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

/// The centred matrix with its columns multiplied by sqrt(columnWeight), never built whole.
class Weighted {
 public:
  Weighted(const FixedPointMatrix& matrix, const std::vector<float>& columnWeight, int threads)
      : matrix_(matrix), threads_(threads), mean(matrix.columns), root(static_cast<Eigen::Index>(matrix.columns)) {
    for (std::size_t j = 0; j < matrix.columns; ++j) root[static_cast<Eigen::Index>(j)] = std::sqrt(columnWeight[j]);
    parallelBlocks(threads, blocks(matrix.columns, kColumnBlock), [&](std::size_t block) {
      const auto begin = block * kColumnBlock, end = std::min(begin + kColumnBlock, matrix.columns);
      std::vector<std::int64_t> sum(end - begin, 0);
      for (std::size_t i = 0; i < matrix.rows; ++i)
        for (std::size_t j = begin; j < end; ++j) sum[j - begin] += matrix.row(i)[j];
      for (std::size_t j = begin; j < end; ++j)
        mean[j] = static_cast<float>(static_cast<double>(sum[j - begin]) / static_cast<double>(matrix.rows) * static_cast<double>(matrix.step()));
    });
  }

  /// The matrix times `right` (#columns by l): #rows by l.
  RowMatrix times(const RowMatrix& right, StepCounter& steps) const {
    RowMatrix result(static_cast<Eigen::Index>(matrix_.rows), right.cols());
    parallelBlocks(threads_, blocks(matrix_.rows, kRowBlock), [&](std::size_t block) {
      const auto first = block * kRowBlock, count = std::min(kRowBlock, matrix_.rows - first);
      RowMatrix part(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(matrix_.columns));
      load(first, count, 0, matrix_.columns, part);
      result.middleRows(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count)) = product(part, right);
      steps.add();
    });
    return result;
  }

  /// The transposed matrix times `left` (#rows by l): #columns by l. Each block of columns sums over the rows in their order.
  RowMatrix transposedTimes(const RowMatrix& left, StepCounter& steps) const {
    RowMatrix result(static_cast<Eigen::Index>(matrix_.columns), left.cols());
    parallelBlocks(threads_, blocks(matrix_.columns, kColumnBlock), [&](std::size_t block) {
      const auto first = block * kColumnBlock, count = std::min(kColumnBlock, matrix_.columns - first);
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), left.cols());
      RowMatrix part;
      for (std::size_t row = 0; row < matrix_.rows; row += kRowBlock) {
        const auto rows = std::min(kRowBlock, matrix_.rows - row);
        part.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(count));
        load(row, rows, first, count, part);
        sum += productTransposedA(part, left.middleRows(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(rows))).cast<double>();
      }
      result.middleRows(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count)) = sum.cast<float>();
      steps.add();
    });
    return result;
  }

  double energy() const {
    std::vector<double> part(blocks(matrix_.rows, kRowBlock), 0.0);
    parallelBlocks(threads_, part.size(), [&](std::size_t block) {
      const auto first = block * kRowBlock, count = std::min(kRowBlock, matrix_.rows - first);
      RowMatrix rows(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(matrix_.columns));
      load(first, count, 0, matrix_.columns, rows);
      for (Eigen::Index i = 0; i < rows.rows(); ++i) part[block] += rows.row(i).cast<double>().squaredNorm();
    });
    double sum = 0.0;
    for (const double p : part) sum += p;
    return sum;
  }

 private:
  void load(std::size_t firstRow, std::size_t rowCount, std::size_t firstColumn, std::size_t columnCount, RowMatrix& part) const {
    const float step = matrix_.step();
    for (std::size_t i = 0; i < rowCount; ++i) {
      const auto* source = matrix_.row(firstRow + i) + firstColumn;
      auto* target = part.row(static_cast<Eigen::Index>(i)).data();
      for (std::size_t j = 0; j < columnCount; ++j)
        target[j] = (static_cast<float>(source[j]) * step - mean[firstColumn + j]) * root[static_cast<Eigen::Index>(firstColumn + j)];
    }
  }

  const FixedPointMatrix& matrix_;
  int threads_;

 public:
  std::vector<float> mean;
  Eigen::VectorXf root;
};

}  // namespace

void FixedPointMatrix::setRow(std::size_t i, const float* source) {
  auto* target = row(i);
  const float scale = 32767.0f / range;
  for (std::size_t j = 0; j < columns; ++j) {
    const float scaled = std::clamp(source[j] * scale, -32767.0f, 32767.0f);
    target[j] = static_cast<std::int16_t>(scaled + (scaled < 0.0f ? -0.5f : 0.5f));  // a form that compilers vectorise
  }
}

Pca computePca(const FixedPointMatrix& matrix, const std::vector<float>& columnWeight, const PcaSettings& settings,
               const std::function<void(double)>& progress) {
  const Weighted a(matrix, columnWeight, settings.threads);
  Pca result;
  result.mean = a.mean;
  result.totalEnergy = a.energy();

  double allWeight = 0.0;
  for (const float w : columnWeight) allWeight += static_cast<double>(w);
  const double leastEnergy = settings.leastRms * settings.leastRms * static_cast<double>(matrix.rows) * allWeight;
  const auto width = static_cast<Eigen::Index>(
      std::min({static_cast<std::size_t>(settings.terms + settings.oversampling), matrix.rows, matrix.columns}));
  if (!(result.totalEnergy > leastEnergy)) return result;

  const auto rowBlocks = blocks(matrix.rows, kRowBlock), columnBlocks = blocks(matrix.columns, kColumnBlock);
  const auto iterations = static_cast<std::size_t>(settings.iterations);
  StepCounter steps(iterations * (rowBlocks + columnBlocks) + rowBlocks, progress);

  RowMatrix basis(static_cast<Eigen::Index>(matrix.columns), width);
  for (Eigen::Index i = 0; i < basis.size(); ++i) basis.data()[i] = gaussian(settings.seed, static_cast<std::uint64_t>(i));
  for (std::size_t k = 0; k < iterations; ++k) basis = orthonormalised(a.transposedTimes(a.times(basis, steps), steps));

  const RowMatrix coordinates = a.times(basis, steps);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(width, width);
  for (Eigen::Index row = 0; row < coordinates.rows(); row += static_cast<Eigen::Index>(kRowBlock)) {
    const RowMajor<double> part =
        coordinates.middleRows(row, std::min(static_cast<Eigen::Index>(kRowBlock), coordinates.rows() - row)).cast<double>();
    gram += productTransposedA(part, part);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  const auto strongest = [&](int k) { return width - 1 - k; };  // the solver sorts upwards
  while (result.terms < std::min(settings.terms, static_cast<int>(width)) &&
         eigen.eigenvalues()[strongest(result.terms)] > leastEnergy)
    ++result.terms;

  RowMajor<double> rotation(width, result.terms);
  const RowMajor<double> wide = basis.cast<double>();
  for (int k = 0; k < result.terms; ++k) {
    rotation.col(k) = eigen.eigenvectors().col(strongest(k));
    // An eigenvector's sign is anyone's choice; ours: its largest entry is positive.
    const Eigen::VectorXd function = wide * rotation.col(k);
    Eigen::Index largest = 0;
    function.cwiseAbs().maxCoeff(&largest);
    if (function[largest] < 0.0) rotation.col(k) = -rotation.col(k);
    result.energy.push_back(eigen.eigenvalues()[strongest(k)]);
  }
  const RowMajor<double> functions = product(wide, rotation);
  result.functions.resize(static_cast<std::size_t>(result.terms) * matrix.columns);
  for (int k = 0; k < result.terms; ++k)
    for (std::size_t j = 0; j < matrix.columns; ++j)
      result.functions[static_cast<std::size_t>(k) * matrix.columns + j] =
          static_cast<float>(functions(static_cast<Eigen::Index>(j), k) / static_cast<double>(a.root[static_cast<Eigen::Index>(j)]));
  const RowMatrix weights = product(RowMajor<double>(coordinates.cast<double>()), rotation).cast<float>();
  result.weights.assign(weights.data(), weights.data() + weights.size());
  return result;
}

}  // namespace chiaro
