#include "runtime/environment/sphere_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "runtime/parallel.h"

namespace chiaro {
namespace {

constexpr double kPi = std::numbers::pi;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Columns6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

/// Rows j and rows-1-j share |cos theta|, so only the northern half is tabulated; even l+m is symmetric, odd antisymmetric.
struct NorthernRows {
  Eigen::ArrayXd cosTheta, sinTheta;
  explicit NorthernRows(int rows) : cosTheta(rows / 2), sinTheta(rows / 2) {
    for (int j = 0; j < rows / 2; ++j) {
      const double theta = (j + 0.5) * kPi / rows;
      cosTheta[j] = std::cos(theta);
      sinTheta[j] = std::sin(theta);
    }
  }
};

/// Walks the orthonormal associated Legendre functions of one order, `kBlock` degrees at a time, over northern rows.
/// Rows so near the pole that every wanted degree is negligible (m far above l sin theta) are left out: they would also
/// only produce denormals.
class LegendreWalk {
 public:
  static constexpr int kBlock = 32;

  LegendreWalk(const NorthernRows& rows, int order, int bandCount) : order_(order), degree_(order) {
    const int north = static_cast<int>(rows.cosTheta.size());
    while (first_ < north && order > bandCount * rows.sinTheta[first_] + 60) ++first_;
    const int active = north - first_;
    x_ = rows.cosTheta.tail(active);
    // P_mm = sqrt((2m+1)/(4 pi) * prod (2k-1)/(2k)) sin^m theta
    double logScale = std::log((2.0 * order + 1) / (4 * kPi));
    for (int k = 1; k <= order; ++k) logScale += std::log((2.0 * k - 1) / (2.0 * k));
    current_ = std::exp(0.5 * logScale) * rows.sinTheta.tail(active).pow(order);
    previous_ = Eigen::ArrayXd::Zero(active);
    even_.resize(active, kBlock / 2);
    odd_.resize(active, kBlock / 2);
  }

  int firstRow() const { return first_; }
  int activeRows() const { return static_cast<int>(x_.size()); }

  /// Degrees l = m + start .. m + start + count - 1; start is a multiple of kBlock, even and odd l - m apart.
  void nextBlock(int count) {
    for (int k = 0; k < count; ++k) {
      ((k & 1) ? odd_ : even_).col(k / 2) = current_.matrix();
      advance();
    }
  }
  auto even(int count) const { return even_.leftCols((count + 1) / 2); }
  auto odd(int count) const { return odd_.leftCols(count / 2); }

 private:
  static double factor(double l, double m) { return std::sqrt((4 * l * l - 1) / (l * l - m * m)); }

  /// P_{l+1} = a_{l+1} (x P_l - P_{l-1} / a_l)
  void advance() {
    const double a = factor(degree_ + 1, order_);
    const double b = degree_ > order_ ? a / factor(degree_, order_) : 0.0;
    previous_ = (a * x_) * current_ - b * previous_;
    previous_.swap(current_);
    ++degree_;
  }

  int order_;
  int degree_;
  int first_ = 0;
  Eigen::ArrayXd x_, current_, previous_;
  Eigen::MatrixXd even_, odd_;
};

/// Fejer's first rule: nodes (j + .5) pi / rows, weights of integral f(theta) sin(theta) dtheta; exact for degrees below rows.
std::vector<double> fejerWeights(int rows) {
  std::vector<double> weights(static_cast<std::size_t>(rows));
  for (int j = 0; j < rows; ++j) {
    const double theta = (j + 0.5) * kPi / rows;
    double sum = 1.0;
    for (int k = 1; k <= (rows - 1) / 2; ++k) sum -= 2.0 * std::cos(2 * k * theta) / (4.0 * k * k - 1);
    weights[static_cast<std::size_t>(j)] = 2.0 / rows * sum;
  }
  return weights;
}

/// One row of the analysis as a mix of image rows.
struct RowMix {
  int first = 0;
  std::vector<double> weights;
};

/// Enough rows to resolve the bands: an integer subdivision of the image's rows with linear interpolation, or, for
/// taller images, solid-angle-weighted means of the rows each one covers. Both keep each image row's total.
std::vector<RowMix> analysisRows(int imageHeight, int bandCount) {
  const int wanted = 2 * bandCount;
  std::vector<RowMix> mixes;
  if (imageHeight <= wanted) {
    int subdivision = (wanted + imageHeight - 1) / imageHeight;
    if (imageHeight * subdivision % 2 != 0) ++subdivision;
    for (int j = 0; j < imageHeight * subdivision; ++j) {
      const double y = std::clamp((j + 0.5) / subdivision - 0.5, 0.0, imageHeight - 1.0);
      const int first = std::min(static_cast<int>(y), imageHeight - 1);
      const double fraction = y - first;
      RowMix mix{first, {1.0 - fraction}};
      if (fraction > 0.0) mix.weights.push_back(fraction);
      mixes.push_back(std::move(mix));
    }
    return mixes;
  }
  for (int j = 0; j < wanted; ++j) {
    const double top = static_cast<double>(j) * imageHeight / wanted;
    const double bottom = static_cast<double>(j + 1) * imageHeight / wanted;
    RowMix mix{static_cast<int>(top), {}};
    double total = 0.0;
    for (int y = mix.first; y < bottom && y < imageHeight; ++y) {
      const double from = std::max<double>(y, top) * kPi / imageHeight, to = std::min<double>(y + 1, bottom) * kPi / imageHeight;
      mix.weights.push_back(std::cos(from) - std::cos(to));
      total += mix.weights.back();
    }
    for (double& weight : mix.weights) weight /= total;
    mixes.push_back(std::move(mix));
  }
  return mixes;
}

/// Integral over phi of f e^{-i m phi} for m < bandCount, one image row; rows of the result are m, columns as in SphereSpectrum.
void azimuthalSpectrum(const ImageRgb& map, int y, int bandCount, Eigen::FFT<double>& fft, Columns6& result) {
  const int width = map.width;
  std::vector<std::complex<double>> signal(static_cast<std::size_t>(width)), spectrum;
  result.resize(bandCount, 6);
  for (int channel = 0; channel < 3; ++channel) {
    for (int x = 0; x < width; ++x) signal[static_cast<std::size_t>(x)] = map.at(x, y)[channel];
    if (width == 1)
      spectrum = signal;  // too short for the library's transform
    else
      fft.fwd(spectrum, signal);
    for (int m = 0; m < bandCount; ++m) {
      const double halfStep = kPi * m / width;  // half a texel in radians, times m
      const double sinc = m == 0 ? 1.0 : std::sin(halfStep) / halfStep;
      const double tent = sinc * sinc;  // linear interpolation between texel centres
      const std::complex<double> value =
          spectrum[static_cast<std::size_t>(m % width)] * std::polar(2 * kPi / width * tent, -halfStep);
      result(m, channel) = value.real();
      result(m, channel + 3) = value.imag();
    }
  }
}

void analyseOrder(int m, const NorthernRows& north, const RowMatrix& symmetric, const RowMatrix& antisymmetric, int bandCount,
                  Columns6& coefficients) {
  coefficients.setZero(bandCount - m, 6);
  LegendreWalk walk(north, m, bandCount);
  if (walk.activeRows() == 0) return;
  const Columns6 plus = symmetric.block(walk.firstRow(), 6 * m, walk.activeRows(), 6);
  const Columns6 minus = antisymmetric.block(walk.firstRow(), 6 * m, walk.activeRows(), 6);
  for (int start = 0; start < bandCount - m; start += LegendreWalk::kBlock) {
    const int count = std::min(LegendreWalk::kBlock, bandCount - m - start);
    walk.nextBlock(count);
    const Columns6 even = walk.even(count).transpose() * plus;
    const Columns6 odd = walk.odd(count).transpose() * minus;
    for (int k = 0; k < count; ++k) coefficients.row(start + k) = (k & 1) ? odd.row(k / 2) : even.row(k / 2);
  }
}

/// Fourier coefficients of order m of every grid row (rows x 6).
void synthesiseOrder(int m, const SphereSpectrum& spectrum, const std::vector<double>& bandFactors, const NorthernRows& north,
                     int bandCount, Columns6& rows) {
  const int half = static_cast<int>(north.cosTheta.size());
  rows.setZero(2 * half, 6);
  LegendreWalk walk(north, m, bandCount);
  const int active = walk.activeRows();
  if (active == 0) return;
  const Columns6& coefficients = spectrum.orders[static_cast<std::size_t>(m)];
  Columns6 even = Columns6::Zero(active, 6), odd = Columns6::Zero(active, 6);
  for (int start = 0; start < bandCount - m; start += LegendreWalk::kBlock) {
    const int count = std::min(LegendreWalk::kBlock, bandCount - m - start);
    walk.nextBlock(count);
    Columns6 evenBands((count + 1) / 2, 6), oddBands(count / 2, 6);
    for (int k = 0; k < count; ++k) {
      const double factor = bandFactors[static_cast<std::size_t>(m + start + k)];
      if (k & 1)
        oddBands.row(k / 2) = factor * coefficients.row(start + k);
      else
        evenBands.row(k / 2) = factor * coefficients.row(start + k);
    }
    even.noalias() += walk.even(count) * evenBands;
    odd.noalias() += walk.odd(count) * oddBands;
  }
  rows.middleRows(walk.firstRow(), active) = even + odd;
  rows.middleRows(half, active) = (even - odd).colwise().reverse();
}

}  // namespace

std::vector<double> sgBandFactors(double sharpness, double cutoff) {
  if (sharpness <= 0.0) return {1.0};
  // Downward recurrence rho_{l-1} = rho_{l+1} + (2l+1)/sharpness rho_l is stable; start where rho is far below any cutoff
  // and scale so that rho_0 = 1.
  const int start = 20 + static_cast<int>(std::ceil(std::sqrt(120.0 * sharpness)));
  std::vector<double> factors(static_cast<std::size_t>(start) + 2, 0.0);
  factors[static_cast<std::size_t>(start)] = 1.0;
  for (int l = start; l > 0; --l) {
    const auto at = static_cast<std::size_t>(l);
    factors[at - 1] = factors[at + 1] + (2.0 * l + 1.0) / sharpness * factors[at];
    if (factors[at - 1] > 1e200)
      for (std::size_t k = at - 1; k < factors.size(); ++k) factors[k] *= 1e-200;
  }
  const double scale = 1.0 / factors[0];
  std::size_t count = 0;
  while (count < factors.size() && (factors[count] *= scale) >= cutoff) ++count;
  factors.resize(std::max<std::size_t>(count, 1));
  return factors;
}

SphereSpectrum analyse(const ImageRgb& map, int bandCount, int threads) {
  std::vector<Columns6> imageRows(static_cast<std::size_t>(map.height));
  constexpr int kRowsAJob = 16;
  parallelFor((map.height + kRowsAJob - 1) / kRowsAJob, threads, [&](int job) {
    Eigen::FFT<double> fft;
    for (int y = job * kRowsAJob; y < std::min(map.height, (job + 1) * kRowsAJob); ++y)
      azimuthalSpectrum(map, y, bandCount, fft, imageRows[static_cast<std::size_t>(y)]);
  });

  const std::vector<RowMix> mixes = analysisRows(map.height, bandCount);
  const int rows = static_cast<int>(mixes.size());
  const std::vector<double> weights = fejerWeights(rows);
  RowMatrix symmetric(rows / 2, 6 * bandCount), antisymmetric(rows / 2, 6 * bandCount);
  const auto mixed = [&](int j) {
    const RowMix& mix = mixes[static_cast<std::size_t>(j)];
    Columns6 sum = Columns6::Zero(bandCount, 6);
    for (std::size_t k = 0; k < mix.weights.size(); ++k)
      sum += mix.weights[k] * imageRows[static_cast<std::size_t>(mix.first) + k];
    return Columns6(weights[static_cast<std::size_t>(j)] * sum);
  };
  parallelFor(rows / 2, threads, [&](int j) {
    const Columns6 north = mixed(j), south = mixed(rows - 1 - j);
    for (int m = 0; m < bandCount; ++m) {
      symmetric.block<1, 6>(j, 6 * m) = north.row(m) + south.row(m);
      antisymmetric.block<1, 6>(j, 6 * m) = north.row(m) - south.row(m);
    }
  });

  SphereSpectrum spectrum;
  spectrum.bandCount = bandCount;
  spectrum.orders.resize(static_cast<std::size_t>(bandCount));
  const NorthernRows north(rows);
  parallelFor(bandCount, threads, [&](int m) {
    analyseOrder(m, north, symmetric, antisymmetric, bandCount, spectrum.orders[static_cast<std::size_t>(m)]);
  });
  return spectrum;
}

SphereGrid::SphereGrid(int height)
    : width_(2 * height),
      height_(height),
      values_(3 * static_cast<std::size_t>(2 * height + 2 * kBorder) * static_cast<std::size_t>(height + 2 * kBorder)) {}

void SphereGrid::closeBorder() {
  const auto copy = [&](int i, int j, int fromI, int fromJ) { std::copy_n(texel(fromI, fromJ), 3, texel(i, j)); };
  for (int k = 0; k < kBorder; ++k)
    for (int i = 0; i < width_; ++i) {
      copy(i, -1 - k, (i + width_ / 2) % width_, k);
      copy(i, height_ + k, (i + width_ / 2) % width_, height_ - 1 - k);
    }
  for (int j = -kBorder; j < height_ + kBorder; ++j)
    for (int k = 0; k < kBorder; ++k) {
      copy(-1 - k, j, width_ - 1 - k, j);
      copy(width_ + k, j, k, j);
    }
}

glm::vec3 SphereGrid::interpolate(float u, float v) const {
  const auto split = [](float x, int& base, float w[4]) {
    const float floorX = std::floor(x);
    base = static_cast<int>(floorX);
    const float t = x - floorX, p = t + 1, q = t - 1, r = t - 2;
    w[0] = -t * q * r / 6;
    w[1] = p * q * r / 2;
    w[2] = -p * t * r / 2;
    w[3] = p * t * q / 6;
  };
  int i, j;
  float wx[4], wy[4];
  split(u * static_cast<float>(width_) - 0.5f, i, wx);
  split(v * static_cast<float>(height_) - 0.5f, j, wy);
  i = std::clamp(i, -1, width_ - 1);
  j = std::clamp(j, -1, height_ - 1);
  glm::vec3 sum(0.0f);
  for (int b = 0; b < 4; ++b) {
    const float* row = texel(i - 1, j - 1 + b);
    for (int a = 0; a < 4; ++a) {
      const float w = wx[a] * wy[b];
      for (int c = 0; c < 3; ++c) sum[c] += w * row[3 * a + c];
    }
  }
  return sum;
}

SphereGrid synthesise(const SphereSpectrum& spectrum, const std::vector<double>& bandFactors, int height, int threads) {
  const int bandCount = std::min(spectrum.bandCount, static_cast<int>(bandFactors.size()));
  const NorthernRows north(height);
  std::vector<Columns6> orders(static_cast<std::size_t>(bandCount));
  parallelFor(bandCount, threads,
              [&](int m) { synthesiseOrder(m, spectrum, bandFactors, north, bandCount, orders[static_cast<std::size_t>(m)]); });

  SphereGrid grid(height);
  const int width = grid.width();
  std::vector<std::complex<double>> phases(static_cast<std::size_t>(bandCount));  // texel centres lie half a texel after phi = 0
  for (int m = 0; m < bandCount; ++m) phases[static_cast<std::size_t>(m)] = std::polar(1.0, kPi * m / width);
  constexpr int kRowsAJob = 16;
  parallelFor((height + kRowsAJob - 1) / kRowsAJob, threads, [&](int job) {
    Eigen::FFT<double> fft;
    fft.SetFlag(Eigen::FFT<double>::Unscaled);
    fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    std::vector<std::complex<double>> half(static_cast<std::size_t>(width / 2 + 1));
    std::vector<double> signal(static_cast<std::size_t>(width));
    for (int j = job * kRowsAJob; j < std::min(height, (job + 1) * kRowsAJob); ++j)
      for (int channel = 0; channel < 3; ++channel) {
        std::fill(half.begin(), half.end(), std::complex<double>{});
        for (int m = 0; m < bandCount; ++m) {
          const Columns6& order = orders[static_cast<std::size_t>(m)];
          half[static_cast<std::size_t>(m)] =
              std::complex<double>(order(j, channel), order(j, channel + 3)) * phases[static_cast<std::size_t>(m)];
        }
        fft.inv(signal.data(), half.data(), width);
        for (int i = 0; i < width; ++i) grid.texel(i, j)[channel] = static_cast<float>(signal[static_cast<std::size_t>(i)]);
      }
  });
  grid.closeBorder();
  return grid;
}

}  // namespace chiaro
