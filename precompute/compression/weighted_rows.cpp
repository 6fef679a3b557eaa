#include "precompute/compression/weighted_rows.h"

#include <algorithm>
#include <cmath>

namespace chiaro {
namespace {

// Block shapes are part of the result's bits: they never depend on the number of threads.
constexpr std::size_t kColumnBlock = 256;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

WeightedRows::WeightedRows(const RowBlocks& rows, float range, const std::vector<float>& columnWeight, int threads)
    : mean(rows.columns()), root(index(rows.columns())), rows_(rows), step_(range / 32767.0f), threads_(threads) {
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

double WeightedRows::energy() const {
  std::vector<double> part(rows_.blocks(), 0.0);
  forEachStrip([&](std::size_t first, const Strip& strip) {
    parallelBlocks(threads_, strip.size(), [&](std::size_t b) {
      Matrix rows(index(rows_.rowsOf(first + b)), index(rows_.columns()));
      load(strip[b], 0, rows);
      for (Eigen::Index i = 0; i < rows.rows(); ++i) part[first + b] += rows.row(i).cast<double>().squaredNorm();
    });
  });
  double sum = 0.0;
  for (const double p : part) sum += p;
  return sum;
}

void WeightedRows::times(const Matrix& right, StepCounter& steps,
                         const std::function<void(std::size_t block, const Matrix&)>& use) const {
  forEachStrip([&](std::size_t first, const Strip& strip) {
    std::vector<Matrix> products(strip.size());
    multiply(first, strip, right, products, steps);
    for (std::size_t b = 0; b < strip.size(); ++b) use(first + b, products[b]);
  });
}

WeightedRows::Matrix WeightedRows::covarianceTimes(const Matrix& right, StepCounter& steps) const {
  const auto columns = rows_.columns();
  RowMajor<double> sum = RowMajor<double>::Zero(index(columns), right.cols());
  forEachStrip([&](std::size_t first, const Strip& strip) {
    std::vector<Matrix> products(strip.size());
    multiply(first, strip, right, products, steps);
    parallelBlocks(threads_, columnBlocks(), [&](std::size_t block) {
      const auto begin = block * kColumnBlock, count = std::min(kColumnBlock, columns - begin);
      Matrix part;
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

WeightedRows::Filled WeightedRows::filledCovariance(const ColumnMasks& masks, const Matrix& basis,
                                                    std::vector<Matrix>& coordinates, StepCounter& steps) const {
  const auto columns = rows_.columns();
  Filled result{.covariance = RowMajor<double>::Zero(index(columns), basis.cols()),
                .mean = Eigen::RowVectorXd::Zero(index(columns))};
  std::vector<double> energy(rows_.blocks(), 0.0);
  forEachStrip([&](std::size_t first, const Strip& strip) {
    std::vector<Matrix> filled(strip.size());
    parallelBlocks(threads_, strip.size(), [&](std::size_t b) {
      auto& part = filled[b];
      part.resize(index(rows_.rowsOf(first + b)), index(columns));
      load(strip[b], 0, part);
      fill(first + b, masks, productTransposedB(coordinates[first + b], basis), part);
      coordinates[first + b] = product(part, basis);
      for (Eigen::Index i = 0; i < part.rows(); ++i) energy[first + b] += static_cast<double>(part.row(i).squaredNorm());
      steps.add();
    });
    parallelBlocks(threads_, columnBlocks(), [&](std::size_t block) {
      const auto begin = block * kColumnBlock, count = std::min(kColumnBlock, columns - begin);
      for (std::size_t b = 0; b < strip.size(); ++b) {
        const auto part = filled[b].middleCols(index(begin), index(count));
        result.covariance.middleRows(index(begin), index(count)) +=
            productTransposedA(part, coordinates[first + b]).cast<double>();
        result.mean.segment(index(begin), index(count)) += part.cast<double>().colwise().sum();
      }
    });
    steps.add(strip.size());
  });
  result.mean /= static_cast<double>(rows_.rows());
  for (const double e : energy) result.energy += e;
  return result;
}

std::size_t WeightedRows::columnBlocks() const { return (rows_.columns() + kColumnBlock - 1) / kColumnBlock; }

void WeightedRows::forEachStrip(const std::function<void(std::size_t first, const Strip&)>& use) const {
  const auto most = std::max<std::size_t>(kStripBytes / (2 * RowBlocks::kRows * std::max<std::size_t>(rows_.columns(), 1)), 1);
  std::vector<std::vector<std::byte>> room(std::min(most, rows_.blocks()));
  for (std::size_t first = 0; first < rows_.blocks(); first += most) {
    Strip strip(std::min(most, rows_.blocks() - first));
    parallelBlocks(threads_, strip.size(), [&](std::size_t b) { strip[b] = rows_.block(first + b, room[b]); });
    use(first, strip);
  }
}

void WeightedRows::multiply(std::size_t first, const Strip& strip, const Matrix& right, std::vector<Matrix>& products,
                            StepCounter& steps) const {
  parallelBlocks(threads_, strip.size(), [&](std::size_t b) {
    Matrix part(index(rows_.rowsOf(first + b)), index(rows_.columns()));
    load(strip[b], 0, part);
    products[b] = product(part, right);
    steps.add();
  });
}

void WeightedRows::load(const std::int16_t* block, std::size_t firstColumn, Matrix& part) const {
  for (Eigen::Index i = 0; i < part.rows(); ++i) {
    const auto* source = block + static_cast<std::size_t>(i) * rows_.columns() + firstColumn;
    auto* target = part.row(i).data();
    for (std::size_t j = 0; j < static_cast<std::size_t>(part.cols()); ++j)
      target[j] = (static_cast<float>(source[j]) * step_ - mean[firstColumn + j]) * root[index(firstColumn + j)];
  }
}

void WeightedRows::fill(std::size_t block, const ColumnMasks& masks, const Matrix& guess, Matrix& part) const {
  for (Eigen::Index i = 0; i < part.rows(); ++i) {
    const auto& mask = masks.of(block * RowBlocks::kRows + static_cast<std::size_t>(i));
    if (mask.empty()) continue;
    const float* known = mask.data();
    const auto* from = guess.row(i).data();
    auto* to = part.row(i).data();
    for (std::size_t j = 0; j < static_cast<std::size_t>(part.cols()); ++j) to[j] = from[j] + known[j] * (to[j] - from[j]);
  }
}

}  // namespace chiaro
