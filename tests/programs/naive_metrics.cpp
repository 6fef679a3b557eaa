#include "tests/programs/naive_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace chiaro::naive {
namespace {

constexpr double kPi = std::numbers::pi;

using Color = std::array<double, 3>;
using Colors = std::vector<Color>;
using Weight = std::function<double(double, double)>;

struct Window {
  int radius;
  std::vector<double> weights;
  double& at(int x, int y) { return weights[static_cast<std::size_t>((y + radius) * (2 * radius + 1) + x + radius)]; }
};

Window windowOf(int radius, const Weight& weight) {
  Window window{radius, std::vector<double>(static_cast<std::size_t>((2 * radius + 1) * (2 * radius + 1)))};
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x) window.at(x, y) = weight(x, y);
  return window;
}

Window summingToOne(Window window) {
  double sum = 0;
  for (const double w : window.weights) sum += w;
  for (double& w : window.weights) w /= sum;
  return window;
}

Window balanced(Window window) {
  double up = 0, down = 0;
  for (const double w : window.weights) (w > 0 ? up : down) += std::abs(w);
  for (double& w : window.weights) w /= w > 0 ? up : down;
  return window;
}

std::vector<double> filtered(const std::vector<double>& values, int width, int height, Window window) {
  std::vector<double> result(values.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = -window.radius; j <= window.radius; ++j)
        for (int i = -window.radius; i <= window.radius; ++i)
          sum += window.at(i, j) *
                 values[static_cast<std::size_t>(std::clamp(y + j, 0, height - 1) * width + std::clamp(x + i, 0, width - 1))];
      result[static_cast<std::size_t>(y * width + x)] = sum;
    }
  return result;
}

double decode(double s) { return s > 0.04045 ? std::pow((s + 0.055) / 1.055, 2.4) : s / 12.92; }
double encode(double l) { return l > 0.0031308 ? 1.055 * std::pow(l, 1 / 2.4) - 0.055 : 12.92 * l; }

// White point and inverse as the authors' program rounds them.
constexpr double kM[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                             {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                             {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double kInverse[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                   {-0.969224334, 1.875930071, 0.041554224},
                                   {0.055639423, -0.204011202, 1.057148933}};
constexpr double kWhite[3] = {0.950428545, 1.0, 1.088900371};

Color times(const double (&m)[3][3], const Color& v) {
  Color result{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) result[r] += m[r][c] * v[c];
  return result;
}

Color yCxCz(const Color& linear) {
  const Color v = times(kM, linear);
  return {116 * v[1] - 16, 500 * (v[0] / kWhite[0] - v[1]), 200 * (v[1] - v[2] / kWhite[2])};
}

Color linearOf(const Color& c) {
  const double y = (c[0] + 16) / 116;
  return times(kInverse, {(y + c[1] / 500) * kWhite[0], y, (y - c[2] / 200) * kWhite[2]});
}

Color huntLab(const Color& linear) {
  Color v = times(kM, linear);
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = v[i] / kWhite[i], d = 6.0 / 29;
    v[i] = t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
  }
  const double lightness = 116 * v[1] - 16;
  return {lightness, .01 * lightness * 500 * (v[0] - v[1]), .01 * lightness * 200 * (v[1] - v[2])};
}

double distance(const Color& a, const Color& b) {
  return std::pow(std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]), .7);
}

struct Seen {
  Colors colors;
  std::vector<double> edges, points;
};

Seen seen(const ImageRgb& shown, double ppd) {
  const int w = shown.width, h = shown.height;
  std::vector<std::vector<double>> planes(3, std::vector<double>(shown.texels.size()));
  for (std::size_t i = 0; i < shown.texels.size(); ++i) {
    const glm::vec3 t = shown.texels[i];
    const Color c = yCxCz({decode(t.r), decode(t.g), decode(t.b)});
    for (std::size_t k = 0; k < 3; ++k) planes[k][i] = c[k];
  }
  std::vector<double> luminance = planes[0];
  for (double& v : luminance) v = (v + 16) / 116;

  constexpr double kA1[3] = {1, 1, 34.1}, kB1[3] = {.0047, .0053, .04}, kA2[3] = {0, 0, 13.5}, kB2[3] = {1e-5, 1e-5, .025};
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(.04 / (2 * kPi * kPi)) * ppd));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto csf = [&](double x, double y) {
      const double z = (x * x + y * y) / (ppd * ppd);
      return kA1[k] * std::sqrt(kPi / kB1[k]) * std::exp(-kPi * kPi * z / kB1[k]) +
             kA2[k] * std::sqrt(kPi / kB2[k]) * std::exp(-kPi * kPi * z / kB2[k]);
    };
    planes[k] = filtered(planes[k], w, h, summingToOne(windowOf(radius, csf)));
  }
  Seen result;
  for (std::size_t i = 0; i < shown.texels.size(); ++i) {
    Color c = linearOf({planes[0][i], planes[1][i], planes[2][i]});
    for (double& v : c) v = std::clamp(v, 0.0, 1.0);
    result.colors.push_back(huntLab(c));
  }

  const double sd = .5 * .082 * ppd;
  const int reach = static_cast<int>(std::ceil(3 * sd));
  const auto strength = [&](const std::function<double(double)>& detector) {
    const auto bell = [&](double x, double y) { return std::exp(-(x * x + y * y) / (2 * sd * sd)); };
    const auto across =
        filtered(luminance, w, h, balanced(windowOf(reach, [&](double x, double y) { return detector(x) * bell(x, y); })));
    const auto down =
        filtered(luminance, w, h, balanced(windowOf(reach, [&](double x, double y) { return detector(y) * bell(x, y); })));
    std::vector<double> both;
    for (std::size_t i = 0; i < across.size(); ++i) both.push_back(std::hypot(across[i], down[i]));
    return both;
  };
  result.edges = strength([](double x) { return -x; });
  result.points = strength([&](double x) { return x * x / (sd * sd) - 1; });
  return result;
}

}  // namespace

std::vector<double> flip(const ImageRgb& reference, const ImageRgb& test, double pixelsPerDegree) {
  const Seen truth = seen(reference, pixelsPerDegree), ours = seen(test, pixelsPerDegree);
  const double largest = distance(huntLab({0, 1, 0}), huntLab({0, 0, 1}));
  std::vector<double> map;
  for (std::size_t i = 0; i < truth.colors.size(); ++i) {
    const double d = distance(truth.colors[i], ours.colors[i]), turn = .4 * largest;
    const double color = d < turn ? .95 * d / turn : .95 + .05 * (d - turn) / (largest - turn);
    const double feature =
        std::max(std::abs(truth.edges[i] - ours.edges[i]), std::abs(truth.points[i] - ours.points[i])) / std::sqrt(2.0);
    map.push_back(std::pow(color, 1 - std::sqrt(feature)));
  }
  return map;
}

std::vector<double> hdrFlip(const ImageRgb& reference, const ImageRgb& test, double pixelsPerDegree) {
  const auto tone = [](double x) {
    x *= .6;
    return std::clamp(x * (2.51 * x + .03) / (x * (2.43 * x + .59) + .14), 0.0, 1.0);
  };
  double low = 0, high = 100;  // what the tone map shows at .85, by bisection
  for (int i = 0; i < 100; ++i) (tone(.5 * (low + high)) < .85 ? low : high) = .5 * (low + high);
  std::vector<double> luminances;
  for (const glm::dvec3 c : reference.texels) luminances.push_back(.2126 * c.r + .7152 * c.g + .0722 * c.b);
  std::sort(luminances.begin(), luminances.end());
  const std::size_t n = luminances.size();
  const double start = std::log2(low / luminances.back());
  const double stop = std::log2(low / (.5 * (luminances[(n - 1) / 2] + luminances[n / 2])));
  const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
  const auto exposed = [&](ImageRgb image, double exposure) {
    for (glm::vec3& texel : image.texels)
      for (int c = 0; c < 3; ++c) texel[c] = static_cast<float>(encode(tone(std::exp2(exposure) * std::max(0.0f, texel[c]))));
    return image;
  };
  std::vector<double> map(n, 0.0);
  for (int i = 0; i < count; ++i) {
    const double exposure = start + i * (stop - start) / (count - 1);
    const auto one = flip(exposed(reference, exposure), exposed(test, exposure), pixelsPerDegree);
    for (std::size_t k = 0; k < n; ++k) map[k] = std::max(map[k], one[k]);
  }
  return map;
}

double ssim(const ImageRgb& a, const ImageRgb& b) {
  const auto luma = [](const glm::vec3& c) {
    return .299 * static_cast<double>(c.r) + .587 * static_cast<double>(c.g) + .114 * static_cast<double>(c.b);
  };
  Window window = summingToOne(windowOf(5, [](double x, double y) { return std::exp(-(x * x + y * y) / (2 * 1.5 * 1.5)); }));
  double sum = 0;
  int count = 0;
  for (int y = 5; y < a.height - 5; ++y)
    for (int x = 5; x < a.width - 5; ++x) {
      const auto over = [&](const std::function<double(double, double)>& f) {
        double s = 0;
        for (int j = -5; j <= 5; ++j)
          for (int i = -5; i <= 5; ++i) s += window.at(i, j) * f(luma(a.at(x + i, y + j)), luma(b.at(x + i, y + j)));
        return s;
      };
      const double ma = over([](double p, double) { return p; }), mb = over([](double, double q) { return q; });
      const double va = over([&](double p, double) { return (p - ma) * (p - ma); });
      const double vb = over([&](double, double q) { return (q - mb) * (q - mb); });
      const double ab = over([&](double p, double q) { return (p - ma) * (q - mb); });
      sum += (2 * ma * mb + 1e-4) * (2 * ab + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
      ++count;
    }
  return sum / count;
}

}  // namespace chiaro::naive
