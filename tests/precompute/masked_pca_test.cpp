// Principal components of rows of which a part does not matter, and what of a row that is.
#include "precompute/compression/masked_pca.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "precompute/compression/masked_projection.h"
#include "precompute/horizon_masks.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr std::size_t kRows = 600, kColumns = 300;
constexpr int kRank = 6;

/// Rows of rank kRank; each mask hides a third of the columns, and what is hidden is noise as large as the signal.
struct Hidden {
  FixedPointMatrix matrix{kRows, kColumns, 4.0f};
  Eigen::MatrixXd signal{kRows, kColumns};
  ColumnMasks masks;
  std::vector<float> weight;

  Hidden() {
    std::mt19937 random(5);
    std::normal_distribution<double> gaussian;
    const Eigen::MatrixXd left = Eigen::MatrixXd::NullaryExpr(kRows, kRank, [&] { return gaussian(random); });
    const Eigen::MatrixXd right = Eigen::MatrixXd::NullaryExpr(kRank, kColumns, [&] { return 0.2 * gaussian(random); });
    signal = (left * right).array() + 0.3;
    for (std::size_t j = 0; j < kColumns; ++j) weight.push_back(0.5f + static_cast<float>(j % 7) / 7.0f);
    for (std::size_t m = 0; m < 5; ++m) {
      auto& mask = masks.masks.emplace_back(kColumns, 1.0f);
      for (std::size_t j = 0; j < kColumns / 3; ++j) mask[(m * kColumns / 5 + j) % kColumns] = 0.0f;
    }
    masks.masks.emplace_back();  // of rows that matter whole
    std::vector<float> row(kColumns);
    for (std::size_t i = 0; i < kRows; ++i) {
      masks.ofRow.push_back(static_cast<std::uint16_t>(i % 6));
      const auto& mask = masks.of(i);
      for (std::size_t j = 0; j < kColumns; ++j)
        row[j] = static_cast<float>(!mask.empty() && mask[j] == 0.0f
                                        ? 0.5 * gaussian(random)
                                        : signal(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      matrix.setRow(i, row.data());
    }
  }

  RowMajor<float> rows() const {
    RowMajor<float> result(kRows, kColumns);
    for (Eigen::Index i = 0; i < result.size(); ++i)
      result.data()[i] = static_cast<float>(matrix.values[static_cast<std::size_t>(i)]) * matrix.step();
    return result;
  }
  /// Root mean square error of what the masks show.
  double shownError(const Pca& pca, const RowMajor<float>& coordinates) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < kRows; ++i)
      for (std::size_t j = 0; j < kColumns; ++j) {
        if (const auto& mask = masks.of(i); !mask.empty() && mask[j] == 0.0f) continue;
        double value = static_cast<double>(pca.mean[j]);
        for (std::size_t k = 0; k < static_cast<std::size_t>(pca.terms); ++k)
          value += static_cast<double>(coordinates(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) *
                                       pca.functions[k * kColumns + j]);
        sum += std::pow(value - signal(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), 2);
        count += 1.0;
      }
    return std::sqrt(sum / count);
  }
};

TEST(MaskedPca, FindsWhatShowsWhateverTheRestIs) {
  const Hidden hidden;
  const PcaSettings settings{.terms = kRank, .oversampling = 0, .iterations = 40};
  const MatrixBlocks blocks(hidden.matrix);
  const auto pca = computeMaskedPca(blocks, hidden.matrix.range, hidden.weight, hidden.masks, settings);
  ASSERT_EQ(pca.terms, kRank);
  const auto rows = hidden.rows();
  const auto coordinates = MaskedProjection(pca, hidden.weight, hidden.masks, 2)(rows.data(), kColumns, hidden.masks.ofRow);
  // The signal is about .5; the prior and the passes' slow end leave a hundredth of it.
  EXPECT_LE(hidden.shownError(pca, coordinates), 0.01);

  // Nor is that what is found without the masks.
  const ColumnMasks whole{.masks = {{}}, .ofRow = std::vector<std::uint16_t>(kRows, 0)};
  const auto plain = computePca(hidden.matrix, hidden.weight, settings);
  EXPECT_GE(hidden.shownError(plain, MaskedProjection(plain, hidden.weight, whole, 2)(rows.data(), kColumns, whole.ofRow)), 0.1);
}

TEST(MaskedPca, WithoutMasksIsTheOrdinaryOne) {
  const Hidden hidden;
  const ColumnMasks whole{.masks = {{}}, .ofRow = std::vector<std::uint16_t>(kRows, 0)};
  const auto masked =
      computeMaskedPca(MatrixBlocks(hidden.matrix), hidden.matrix.range, hidden.weight, whole, {.terms = 12, .iterations = 3});
  const auto plain = computePca(hidden.matrix, hidden.weight, {.terms = 12, .iterations = 4});
  ASSERT_EQ(masked.terms, plain.terms);
  for (std::size_t k = 0; k < 12; ++k) EXPECT_LE(std::abs(masked.energy[k] / plain.energy[k] - 1.0), 1e-3) << k;
  EXPECT_LE(std::abs(masked.totalEnergy / plain.totalEnergy - 1.0), 1e-5);
}

TEST(MaskedPca, ThreadsNeverChangeABit) {
  const Hidden hidden;
  const MatrixBlocks blocks(hidden.matrix);
  const auto one =
      computeMaskedPca(blocks, hidden.matrix.range, hidden.weight, hidden.masks, {.terms = 20, .iterations = 3, .threads = 1});
  const auto three =
      computeMaskedPca(blocks, hidden.matrix.range, hidden.weight, hidden.masks, {.terms = 20, .iterations = 3, .threads = 3});
  EXPECT_EQ(one.functions, three.functions);
  EXPECT_EQ(one.mean, three.mean);
  EXPECT_EQ(one.energy, three.energy);
  const auto rows = hidden.rows();
  const MaskedProjection a(one, hidden.weight, hidden.masks, 1), b(three, hidden.weight, hidden.masks, 3);
  EXPECT_EQ(a(rows.data(), kColumns, hidden.masks.ofRow), b(rows.data(), kColumns, hidden.masks.ofRow));
}

TEST(MaskedPca, RowsThatAreAllTheSameHaveNoTerm) {
  Hidden hidden;
  for (std::size_t i = 0; i < kRows; ++i) std::copy_n(hidden.matrix.row(0), kColumns, hidden.matrix.row(i));
  const auto pca = computeMaskedPca(MatrixBlocks(hidden.matrix), hidden.matrix.range, hidden.weight, hidden.masks,
                                    {.terms = 8, .iterations = 3});
  EXPECT_EQ(pca.terms, 0);
  const auto rows = hidden.rows();
  EXPECT_EQ(MaskedProjection(pca, hidden.weight, hidden.masks, 2)(rows.data(), kColumns, hidden.masks.ofRow).cols(), 0);
}

TEST(MaskedProjection, IsLeastSquaresOverWhatShows) {
  const Hidden hidden;
  const auto pca = computePca(hidden.matrix, hidden.weight, {.terms = 10});
  const auto rows = hidden.rows();
  const auto got = MaskedProjection(pca, hidden.weight, hidden.masks, 2)(rows.data(), kColumns, hidden.masks.ofRow);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{5}, kRows - 1}) {
    Eigen::MatrixXd functions(kColumns, pca.terms);
    Eigen::VectorXd value(kColumns);
    for (std::size_t j = 0; j < kColumns; ++j) {
      const auto& mask = hidden.masks.of(i);
      const double root = std::sqrt(static_cast<double>(hidden.weight[j]) * (mask.empty() ? 1.0 : static_cast<double>(mask[j])));
      const auto row = static_cast<Eigen::Index>(j);
      value[row] = root * static_cast<double>(rows(static_cast<Eigen::Index>(i), row) - pca.mean[j]);
      for (int k = 0; k < pca.terms; ++k)
        functions(row, k) = root * static_cast<double>(pca.functions[static_cast<std::size_t>(k) * kColumns + j]);
    }
    const Eigen::VectorXd expected = functions.colPivHouseholderQr().solve(value);
    // A hundredth of the weakest function's variance is known beforehand, so no more than some hundredths are drawn to 0.
    for (int k = 0; k < pca.terms; ++k)
      EXPECT_LE(std::abs(static_cast<double>(got(static_cast<Eigen::Index>(i), k)) - expected[k]), 0.05 * expected.norm())
          << i << " " << k;
  }
}

TEST(HorizonMasks, AllAboveMattersAndNothingFarBelow) {
  std::vector<Viewpoint> viewpoints;
  std::mt19937 random(2);
  std::normal_distribution<float> gaussian;
  for (int i = 0; i < 500; ++i)
    viewpoints.push_back({.normal = glm::normalize(glm::vec3(gaussian(random), gaussian(random), gaussian(random)))});
  viewpoints[7].doubleSided = true;
  const TransferRows::Layout layout{.resolution = 32,
                                    .samplingResolution = 32,
                                    .clamp = 0.265f,
                                    .levels = {{10.5f, 8}, {36.75f, 16}, {128.625f, 24}},
                                    .directions = {}};
  const std::size_t maps[] = {32, 8, 16, 24}, columns = 32 * 32 + 8 * 8 + 16 * 16 + 24 * 24;
  const auto masks = horizonMasks(viewpoints, layout, columns + 5, 8);
  EXPECT_LE(masks.masks.size(), 65u);
  ASSERT_EQ(masks.ofRow.size(), viewpoints.size());
  EXPECT_TRUE(masks.of(7).empty());
  for (std::size_t v = 0; v < viewpoints.size(); ++v) {
    if (v == 7) continue;
    const auto& mask = masks.of(v);
    ASSERT_EQ(mask.size(), columns + 5);
    std::size_t at = 0;
    for (const auto side : maps)
      for (std::size_t t = 0; t < side * side; ++t, ++at) {
        const auto w =
            lobe32::octahedralTexelDirection({static_cast<int>(t % side), static_cast<int>(t / side)}, static_cast<int>(side));
        const float sine = glm::dot(w, viewpoints[v].normal);
        ASSERT_GE(mask[at], 0.0f);
        ASSERT_LE(mask[at], 1.0f);
        if (sine >= 0.0f) {
          ASSERT_EQ(mask[at], 1.0f) << side << " " << t;
        }
        // A cell's normals are within .3 rad of its middle, so the nearest horizon is within .6, and a texel further down the sharper lobes have nothing left.
        if (side >= 24 && sine <= -0.95f) {
          ASSERT_LE(mask[at], 0.01f) << side << " " << t;
        }
      }
    for (; at < mask.size(); ++at) ASSERT_EQ(mask[at], 1.0f);
  }
}

}  // namespace
}  // namespace chiaro
