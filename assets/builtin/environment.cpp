#include "assets/builtin/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <system_error>

#include "assets/error.h"
#include "assets/image/image.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kWidth = 1024;
constexpr int kHeight = 512;

/// Radiance in one direction. `region` changes only across sharp edges, so that it tells which texels need more than one sample.
struct Look {
  glm::dvec3 radiance{0.0};
  int region = 0;
};
using Sky = std::function<Look(glm::dvec3)>;

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}


/// Steradians of one texel of a row.
double texelSolidAngle(int row, int width, int height) {
  return 2.0 * kPi / width * (std::cos(kPi * row / height) - std::cos(kPi * (row + 1) / height));
}

glm::dvec3 texelMean(const Sky& sky, int x, int y) {
  const auto look = [&](double dx, double dy) {
    return sky(lobe64::directionFromEquirect(glm::dvec2((x + dx) / kWidth, (y + dy) / kHeight)));
  };
  const Look center = look(0.5, 0.5);
  const bool edge = look(0.0, 0.0).region != center.region || look(1.0, 0.0).region != center.region ||
                    look(0.0, 1.0).region != center.region || look(1.0, 1.0).region != center.region;
  if (!edge) return center.radiance;
  constexpr int kSide = 8;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kSide * kSide; ++i) sum += look((i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide).radiance;
  return sum / static_cast<double>(kSide * kSide);
}

ImageRgb paint(const Sky& sky) {
  ImageRgb image{kWidth, kHeight, std::vector<glm::vec3>(static_cast<std::size_t>(kWidth) * kHeight)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) image.at(x, y) = glm::vec3(texelMean(sky, x, y));
  }
  return image;
}

// ---- sunny ----

/// 38 degrees up, to the front left of a viewer at +Z who looks along -Z.
const glm::dvec3 kSunDirection = glm::normalize(glm::dvec3(-0.62, 0.78, 0.55));
constexpr double kSunRadius = kPi / 180.0;  ///< the hazy disc; the bare sun's is a quarter of it
constexpr double kSunOverSky = 4.0;         ///< irradiance facing the sun over the sky's on the ground
const glm::dvec3 kSunColor(1.0, 0.93, 0.80);

/// Sky and ground without the disc: blue overhead, pale where the path through the haze is long, brighter about the sun.
glm::dvec3 clearSky(glm::dvec3 w) {
  const glm::dvec3 zenith(0.16, 0.34, 0.80);
  const glm::dvec3 haze(1.05, 1.12, 1.20);
  const double towardsSun = glm::dot(w, kSunDirection);
  if (w.y < 0.0) {
    const glm::dvec3 earth = glm::dvec3(0.44, 0.37, 0.27) * (1.0 + 0.15 * towardsSun);
    return glm::mix(earth, 0.8 * haze, std::exp(11.0 * w.y));
  }
  const double thickness = 1.0 / (w.y + 0.12);  // of the haze, in vertical depths
  const double hazy = 1.0 - std::exp(-0.28 * thickness);
  const double aureole = 0.55 * std::exp(-9.0 * (1.0 - towardsSun)) + 2.2 * std::exp(-160.0 * (1.0 - towardsSun));
  const double rayleigh = 0.75 * (1.0 + towardsSun * towardsSun) / 1.5 + 0.25;
  return glm::mix(zenith, haze, hazy) * rayleigh + kSunColor * aureole;
}

ImageRgb sunny() {
  // Irradiance of the sky on the ground, by rows and columns coarser than the picture's: it is smooth.
  double skyIrradiance = 0.0;
  constexpr int kRows = 256;
  for (int row = 0; row < kRows / 2; ++row) {
    for (int column = 0; column < 2 * kRows; ++column) {
      const glm::dvec3 w = lobe64::directionFromEquirect(glm::dvec2((column + 0.5) / (2 * kRows), (row + 0.5) / kRows));
      skyIrradiance += luminance(clearSky(w)) * w.y * texelSolidAngle(row, 2 * kRows, kRows);
    }
  }
  const double discSolidAngle = 2.0 * kPi * (1.0 - std::cos(kSunRadius));
  const double discRadiance = kSunOverSky * skyIrradiance / (discSolidAngle * luminance(kSunColor));
  return paint([=](glm::dvec3 w) -> Look {
    const bool inDisc = glm::dot(w, kSunDirection) > std::cos(kSunRadius);
    return {clearSky(w) + (inDisc ? discRadiance * kSunColor : glm::dvec3(0.0)), inDisc ? 1 : 0};
  });
}

// ---- overcast ----

/// CIE standard overcast sky (CIE S 011, Moon and Spencer): a third as bright at the horizon as overhead; below it, ground of albedo .2
/// under that sky, whose irradiance is 7 pi / 9 of the zenith's radiance.
ImageRgb overcast() {
  const glm::dvec3 zenith(0.94, 0.98, 1.05);
  const glm::dvec3 ground = zenith * glm::dvec3(0.22, 0.20, 0.17) * (7.0 / 9.0);
  return paint([=](glm::dvec3 w) -> Look {
    const glm::dvec3 sky = zenith * ((1.0 + 2.0 * std::max(w.y, 0.0)) / 3.0);
    // A soft horizon of 2 degrees: far ground seen through haze.
    return {glm::mix(ground, sky, smooth(-0.035, 0.0, w.y)), 0};
  });
}

// ---- windows ----

/// A rectangle of light on a wall of the room: the wall's axis and sign, then centre and half size along the other two axes (metres).
struct Window {
  int axis;
  double sign;
  glm::dvec2 center;
  glm::dvec2 halfSize;
  glm::dvec3 radiance;
};

/// Seen from the middle of the floor plan, 1.4 m up; x and z walls 4 and 5 m away, the ceiling 3.4 m above the floor.
constexpr glm::dvec3 kRoomLow(-4.0, -1.4, -5.0);
constexpr glm::dvec3 kRoomHigh(4.0, 2.0, 5.0);

/// Other two axes of a wall: (z, y) of an x wall, (x, z) of floor and ceiling, (x, y) of a z wall.
glm::dvec2 onWall(int axis, glm::dvec3 p) {
  return axis == 0 ? glm::dvec2(p.z, p.y) : axis == 1 ? glm::dvec2(p.x, p.z) : glm::dvec2(p.x, p.y);
}

ImageRgb windows() {
  static const std::array<Window, 6> kWindows{{
      {0, -1.0, {1.9, 0.55}, {0.80, 0.75}, {11.0, 12.5, 15.0}},  // a wide one in the left wall: cool daylight
      {0, -1.0, {-1.6, 0.55}, {0.40, 0.75}, {9.0, 10.5, 13.0}},  // its narrow neighbour
      {0, 1.0, {1.4, 0.35}, {0.22, 0.30}, {52.0, 30.0, 12.0}},   // small and warm on the right
      {2, -1.0, {1.7, 0.75}, {0.10, 0.70}, {30.0, 34.0, 40.0}},  // a slit straight ahead
      {2, 1.0, {1.1, 0.9}, {0.30, 0.22}, {34.0, 26.0, 18.0}},    // high up behind the viewer
      {1, 1.0, {-0.9, -1.2}, {0.16, 0.16}, {70.0, 68.0, 62.0}},  // a skylight
  }};
  return paint([](glm::dvec3 w) -> Look {
    // The wall that the direction leaves the room through, and where.
    int axis = 0;
    double distance = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const double along = (w[i] > 0.0 ? kRoomHigh[i] : kRoomLow[i]) / w[i];
      if (w[i] != 0.0 && along < distance) {
        distance = along;
        axis = i;
      }
    }
    const double sign = w[axis] > 0.0 ? 1.0 : -1.0;
    const glm::dvec3 point = distance * w;
    const glm::dvec2 at = onWall(axis, point);
    for (std::size_t i = 0; i < kWindows.size(); ++i) {
      const Window& window = kWindows[i];
      if (window.axis != axis || window.sign != sign) continue;
      const glm::dvec2 inside = glm::abs(at - window.center) - window.halfSize;
      if (inside.x < 0.0 && inside.y < 0.0) return {window.radiance, 10 + static_cast<int>(i)};
    }
    // Walls lit by the windows: each as a small lamp, its light falling with the square of the distance and the cosine at the wall.
    glm::dvec3 normal(0.0);
    normal[axis] = -sign;
    const glm::dvec3 albedo =
        axis == 1 ? (sign > 0.0 ? glm::dvec3(0.6) : glm::dvec3(0.30, 0.22, 0.16)) : glm::dvec3(0.46, 0.42, 0.38);
    glm::dvec3 light(0.035);
    for (const Window& window : kWindows) {
      glm::dvec3 lamp(0.0);
      lamp[window.axis] = window.sign > 0.0 ? kRoomHigh[window.axis] : kRoomLow[window.axis];
      const int first = window.axis == 0 ? 2 : 0;
      const int second = window.axis == 1 ? 2 : 1;
      lamp[first] = window.center.x;
      lamp[second] = window.center.y;
      const glm::dvec3 offset = lamp - point;
      const double squared = glm::dot(offset, offset) + 0.3;
      const double facing = std::max(0.0, glm::dot(normal, offset)) * std::abs(offset[window.axis]) / squared;
      light += window.radiance * (4.0 * window.halfSize.x * window.halfSize.y * facing / (kPi * squared));
    }
    return {albedo * light, 2 * axis + (sign > 0.0 ? 1 : 0)};
  });
}

}  // namespace

const std::vector<std::string>& builtinEnvironmentNames() {
  static const std::vector<std::string> names{"sunny", "overcast", "windows", "white", "black"};
  return names;
}

void requireEnvironment(const std::string& nameOrPath) {
  const auto& builtin = builtinEnvironmentNames();
  if (std::find(builtin.begin(), builtin.end(), nameOrPath) != builtin.end()) return;
  std::error_code ignored;
  if (std::filesystem::exists(nameOrPath, ignored)) return;
  throw inputError(nameOrPath, "no such file, and no built-in environment of that name",
                   "use sunny, overcast, windows, white, black, or a .hdr or .exr file");
}

Environment loadEnvironment(const std::string& nameOrPath) {
  requireEnvironment(nameOrPath);
  if (nameOrPath == "sunny") return {nameOrPath, sunny()};
  if (nameOrPath == "overcast") return {nameOrPath, overcast()};
  if (nameOrPath == "windows") return {nameOrPath, windows()};
  if (nameOrPath == "white") return {nameOrPath, paint([](glm::dvec3) { return Look{glm::dvec3(1.0), 0}; })};
  if (nameOrPath == "black") return {nameOrPath, paint([](glm::dvec3) { return Look{glm::dvec3(0.0), 0}; })};
  return {nameOrPath, readHdrImage(nameOrPath)};
}

float autoExposure(const Environment& environment) {
  // The mean of max(n.w, 0) over all normals is 1/4 whatever w is, so the mean irradiance is a quarter of the whole sphere's light.
  const ImageRgb& image = environment.radiance;
  double light = 0.0;
  for (int y = 0; y < image.height; ++y) {
    double row = 0.0;
    for (int x = 0; x < image.width; ++x) row += luminance(glm::dvec3(image.at(x, y)));
    light += row * texelSolidAngle(y, image.width, image.height);
  }
  // Under less light than this an exposure no longer fits a float, nor a picture under it any screen.
  constexpr double kLargest = 1e12;
  return light > 0.0 ? static_cast<float>(std::min(0.5 * kPi / (0.25 * light), kLargest)) : 1.0f;
}

}  // namespace chiaro
