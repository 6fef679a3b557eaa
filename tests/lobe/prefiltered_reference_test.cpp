/// Where a lobe's visible fraction is read from, against maps whose values are known.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Levels {
  int count;
  double first, ratio;
  double sharpness(int level) const { return first * std::pow(ratio, level); }
};
// The bake's own, one level, two close ones, many.
constexpr Levels kLevels[] = {{4, 3, 3.5}, {1, 128, 2}, {1, .25, 2}, {2, 8, 1.25}, {8, 1, 4}, {40, .01, 1.5}};

/// By float arithmetic, as the GPU's, and by double.
std::vector<lobe64::VisibilitySource> sources(double sharpness, const Levels& l) {
  const auto f =
      lobe32::visibilitySource(static_cast<float>(sharpness), l.count, static_cast<float>(l.first), static_cast<float>(l.ratio));
  return {lobe64::visibilitySource(sharpness, l.count, l.first, l.ratio),
          {f.level, static_cast<double>(f.next), static_cast<double>(f.ssdf)}};
}

void expectValid(const lobe64::VisibilitySource& s, int count) {
  EXPECT_GE(s.level, 0);
  EXPECT_LT(s.level, count);
  EXPECT_GE(s.next, 0.0);
  EXPECT_LE(s.next, 1.0);
  EXPECT_GE(s.ssdf, 0.0);
  EXPECT_LE(s.ssdf, 1.0);
  if (s.level == count - 1) {
    EXPECT_EQ(s.next, 0.0);
  }
}

/// One number that grows with sharpness: the place among the levels, and the SSDF's share.
double place(const lobe64::VisibilitySource& s) { return s.level + s.next + s.ssdf; }

TEST(VisibilitySource, NeverALevelThatIsNotThere) {
  for (const auto& l : kLevels) {
    std::vector<double> list{0, -0.0, 1e-300, 1e-40, 1e6, 1e10, 3e38, 1e300, kInfinity, -1, -kInfinity, kNan};
    // Level borders and the floats beside them, where rounding decides.
    for (int i = 0; i <= l.count; ++i) {
      const auto s = static_cast<float>(l.sharpness(i));
      for (const float near : {std::nextafter(s, 0.0f), s, std::nextafter(s, 1e30f)}) list.push_back(static_cast<double>(near));
    }
    for (double s = 1e-6; s < 2e6; s *= 1.001) list.push_back(s);
    for (const double s : list)
      for (const auto& source : sources(s, l)) {
        SCOPED_TRACE(testing::Message() << s << " of " << l.count << " levels from " << l.first);
        expectValid(source, l.count);
      }
  }
}

TEST(VisibilitySource, RightAtTheLevelsOwnSharpness) {
  constexpr double kRounding = 2e-5;  // of a float's logarithm, over the logarithm of the closest ratio, 40 levels up
  for (const auto& l : kLevels)
    for (int i = 0; i < l.count; ++i)
      for (const auto& source : sources(l.sharpness(i), l)) EXPECT_NEAR(source.level + source.next, i, kRounding) << l.count << ' ' << i;
}

// A map that holds log(sharpness) of its level must read log(sharpness) between levels: that is the interpolation the levels are made for.
TEST(VisibilitySource, LinearInTheLogarithmBetweenLevels) {
  constexpr double kRounding = 1e-5;  // float logarithms
  for (const auto& l : kLevels)
    for (double s = l.first; s < l.sharpness(l.count - 1); s *= 1.01)
      for (const auto& source : sources(s, l)) {
        const double read =
            std::log(l.sharpness(source.level)) * (1 - source.next) + std::log(l.sharpness(source.level + 1)) * source.next;
        EXPECT_NEAR(read, std::log(s), kRounding) << s;
        if (s <= .4999 * l.sharpness(l.count - 1)) {
          EXPECT_EQ(source.ssdf, 0.0);
        }
      }
}

TEST(VisibilitySource, BroaderThanTheFirstReadsTheFirst) {
  for (const auto& l : kLevels)
    for (const double s : {0.0, 1e-300, 1e-6, .5 * l.first, l.first})
      for (const auto& source : sources(s, l)) {
        EXPECT_EQ(source.level, 0);
        EXPECT_EQ(source.next, 0.0);
        if (s <= .4999 * l.sharpness(l.count - 1)) {
          EXPECT_EQ(source.ssdf, 0.0);
        }
      }
}

TEST(VisibilitySource, SharpLobesReadTheSsdfAlone) {
  for (const auto& l : kLevels)
    for (const double s : {1.601 * l.sharpness(l.count - 1), 100 * l.sharpness(l.count - 1), 1e30, kInfinity, kNan})
      for (const auto& source : sources(s, l)) {
        EXPECT_EQ(source.ssdf, 1.0) << s << " of " << l.count;
        EXPECT_EQ(source.level, l.count - 1);
        EXPECT_EQ(source.next, 0.0);
      }
}

TEST(VisibilitySource, ContinuousAndMonotone) {
  constexpr double kStep = 1.0005;
  constexpr double kRounding = 2e-5;  // as above
  for (const auto& l : kLevels) {
    // Steepest: the levels' logarithm and the middle of the passage, a cubic of slope 3/2 over log(1.6 / .5).
    const double most = std::log(kStep) * (1 / std::log(l.ratio) + 1.5 / std::log(3.2)) + kRounding;
    for (std::size_t precision = 0; precision < 2; ++precision) {
      double before = 0;
      for (double s = 1e-3; s < 2e6; s *= kStep) {
        const double now = place(sources(s, l)[precision]);
        EXPECT_GE(now, before - kRounding) << s;
        EXPECT_LE(now, before + most) << s;
        before = now;
      }
      EXPECT_LE(std::abs(before - l.count), l.sharpness(l.count - 1) < 1e6 ? 0.0 : kInfinity);
    }
  }
}

// Half way through the passage in the logarithm, half the SSDF; flat at both ends, so that no kink shows.
TEST(VisibilitySource, PassageToTheSsdf) {
  for (const auto& l : kLevels) {
    const double last = l.sharpness(l.count - 1);
    const auto at = [&](double t) { return lobe64::visibilitySource(.5 * last * std::pow(3.2, t), l.count, l.first, l.ratio).ssdf; };
    EXPECT_NEAR(at(.5), .5, 1e-9);
    for (const double t : {.1, .25, .4}) EXPECT_NEAR(at(t) + at(1 - t), 1.0, 1e-9);
    EXPECT_LE(at(1e-3), 1e-5);
    EXPECT_GE(at(1 - 1e-3), 1 - 1e-5);
  }
}

}  // namespace
}  // namespace chiaro
