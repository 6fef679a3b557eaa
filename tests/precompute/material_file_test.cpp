// Readers of measured reflectance, on files that the tests make.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lzma.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/material/abc_model.h"
#include "precompute/material/csv_file.h"
#include "precompute/material/half_difference.h"
#include "precompute/material/material_file.h"
#include "precompute/material/material_fit.h"
#include "precompute/material/sgd_model.h"
#include "precompute/material/xz_file.h"

namespace chiaro {
namespace {

using lobe64::Vec3;
using testing::HasSubstr;

std::vector<std::uint8_t> bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

Vec3 direction(double theta, double phi) {
  return Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
}

template <typename Work>
void expectInputError(const Work& work, const std::string& about, ExitCode code = ExitCode::unreadableInput) {
  try {
    work();
    FAIL() << "nothing was thrown, wanted: " << about;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_THAT(error.what(), HasSubstr(about));
  }
}

std::vector<std::uint8_t> packed(const std::vector<std::uint8_t>& bytes) {
  std::vector<std::uint8_t> stream(lzma_stream_buffer_bound(bytes.size()));
  std::size_t size = 0;
  EXPECT_EQ(
      lzma_easy_buffer_encode(1, LZMA_CHECK_CRC64, nullptr, bytes.data(), bytes.size(), stream.data(), &size, stream.size()),
      LZMA_OK);
  stream.resize(size);
  return stream;
}

/// Smooth in all three angles, and different in each channel.
Vec3 smooth(const Vec3& wo, const Vec3& wi) {
  const double c = dot(wo, lobe64::halfVector(wo, wi)), z = wo.z * wi.z;
  return Vec3(0.1 + 0.3 * c, 0.2 + 0.1 * z, 0.4 * c * z + 0.05);
}

const std::vector<std::uint8_t>& smoothFile() {
  static const auto file = merlFileOf(smooth);
  return file;
}

TEST(HalfDifference, GoesBothWays) {
  for (const double th : {0.0, 1e-6, .1, .7, 1.4})
    for (const double td : {0.0, .2, .9, 1.5})
      for (const double pd : {-2.5, -.3, .4, 3.0}) {
        const auto pair = directionPair({th, td, pd});
        EXPECT_LE(std::abs(glm::length(pair.wi) - 1.0), 1e-14);
        const auto angles = halfDifference(pair.wo, pair.wi);
        EXPECT_LE(std::abs(angles.thetaHalf - th), 1e-12);
        EXPECT_LE(std::abs(angles.thetaDiff - td), 1e-12);
        // An azimuth means nothing where its radius is 0.
        if (td > 0.0 && th > 0.0) {
          EXPECT_LE(std::abs(angles.phiDiff - pd), 1e-8);
        }
        const auto exchanged = halfDifference(pair.wi, pair.wo);
        if (td > 0.0 && th > 0.0) {
          EXPECT_LE(std::abs(std::cos(exchanged.phiDiff - angles.phiDiff) + 1.0), 1e-12);  // reciprocity
        }
      }
}

// The whole measure is that of two spheres: (4 pi)^2; phiDiff over [0, 2 pi], the half vector over the sphere.
TEST(HalfDifference, MeasureIsThatOfTwoSpheres) {
  double sum = 0.0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      sum += halfDifferenceMeasure({(i + .5) / kSteps * lobe64::kPi, (j + .5) / kSteps * lobe64::kHalfPi, 0.0}) * lobe64::kTwoPi;
  sum *= lobe64::kPi / kSteps * lobe64::kHalfPi / kSteps;
  EXPECT_LE(std::abs(sum / (16.0 * lobe64::kPi * lobe64::kPi) - 1.0), 1e-4);
}

TEST(MerlFile, ReadsWhatWasWritten) {
  ASSERT_EQ(smoothFile().size(), MerlTable::kFileBytes);
  const MerlTable table = readMerl(smoothFile(), "smooth");
  for (const auto& [h, d, p] : {std::array<std::size_t, 3>{0, 0, 0}, {40, 20, 100}, {10, 40, 179}}) {
    const auto pair = directionPair({MerlTable::thetaHalfOf(h), MerlTable::thetaDiffOf(d), MerlTable::phiDiffOf(p)});
    const Vec3 truth = smooth(pair.wo, pair.wi), value = table.bin(h, d, p);
    for (int c = 0; c < 3; ++c) EXPECT_LE(std::abs(value[c] / truth[c] - 1.0), 1e-6);  // float
  }
  // Between centres: what a linear look-up in such bins costs a smooth function.
  for (const double th : {.05, .3, .6})
    for (const double td : {.1, .5})
      for (const double pd : {-3.1, .01, 1.0, 3.13}) {
        const auto pair = directionPair({th, td, pd});
        const Vec3 truth = smooth(pair.wo, pair.wi), value = table.at(halfDifference(pair.wo, pair.wi));
        for (int c = 0; c < 3; ++c) EXPECT_LE(std::abs(value[c] - truth[c]), 2e-3) << th << ' ' << td << ' ' << pd;
      }
  EXPECT_GT(table.measuredShare(), 0.3);
  EXPECT_LT(table.measuredShare(), 1.0);  // bins below the surface
}

TEST(MerlFile, MissingBinsAreFilledByTheirNeighboursAndElseNaN) {
  auto file = smoothFile();
  const double missing = -1.0;
  const auto index = [](std::size_t h, std::size_t d, std::size_t p) { return p + 180 * (d + 90 * h); };
  std::memcpy(&file[12 + 8 * (index(30, 10, 50) + MerlTable::kBins)], &missing, 8);  // one channel is enough
  const MerlTable table = readMerl(file, "holes");
  EXPECT_TRUE(std::isnan(table.bin(30, 10, 50).x));
  const HalfDifference at{MerlTable::thetaHalfOf(30), MerlTable::thetaDiffOf(10), MerlTable::phiDiffOf(50) + .004};
  const auto pair = directionPair(at);
  EXPECT_LE(std::abs(table.at(at).x - smooth(pair.wo, pair.wi).x), 1e-2);
  EXPECT_TRUE(std::isnan(table.at({1.5, 1.5, 0.0}).x));  // far below the surface
  EXPECT_TRUE(std::isnan(table.at({std::nan(""), .1, .1}).x));
}

TEST(MerlFile, RefusesWhatIsWrong) {
  const auto& good = smoothFile();
  const auto read = [](const std::vector<std::uint8_t>& file) { return [file] { readMerl(file, "a.binary"); }; };
  expectInputError(read({}), "cut short");
  expectInputError(read({good.begin(), good.begin() + 11}), "cut short");
  expectInputError(read({good.begin(), good.end() - 1}), "cut short: it has 34992011 of 34992012");
  auto wrong = good;
  wrong.push_back(0);
  expectInputError(read(wrong), "too long");
  wrong = good;
  wrong[4] = 91;
  expectInputError(read(wrong), "header is not 90, 90, 180: number 2 is 91");
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    wrong = good;
    std::memcpy(&wrong[12 + 8 * 5], &value, 8);
    expectInputError(read(wrong), "value 5 is not finite");
  }
  wrong = merlFileOf([](const Vec3&, const Vec3&) { return Vec3(std::nan("")); });
  expectInputError(read(wrong), "no measured value");
  expectInputError([] { readMerlFile("nothing.binary"); }, "nothing.binary");
}

TEST(MerlFile, Xz) {
  const auto stream = packed(smoothFile());
  writeFileAtomically("smooth.binary.xz", stream);
  const MerlTable table = readMerlFile("smooth.binary.xz");
  EXPECT_EQ(table.bin(40, 20, 100).x, readMerl(smoothFile(), "").bin(40, 20, 100).x);
  EXPECT_EQ(readMaterials("smooth.binary.xz")[0].name, "smooth");
  writeFileAtomically("cut.binary.xz",
                      std::vector<std::uint8_t>(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(stream.size() / 2)));
  expectInputError([] { readMerlFile("cut.binary.xz"); }, "cut short");
  auto damaged = stream;
  damaged[damaged.size() / 2] ^= 0x55;
  writeFileAtomically("damaged.binary.xz", damaged);
  expectInputError([] { readMerlFile("damaged.binary.xz"); }, "damaged.binary.xz");
  writeFileAtomically("plain.binary.xz", std::string_view("not packed at all"));
  expectInputError([] { readMerlFile("plain.binary.xz"); }, "no .xz file");
  writeFileAtomically("small.binary.xz", packed({1, 2, 3}));
  expectInputError([] { readMerlFile("small.binary.xz"); }, "cut short");
  EXPECT_EQ(unpackedXz(packed(std::vector<std::uint8_t>(1000, 7)), 10, "").size(),
            11u);  // a little more than was wanted, never all
}

TEST(Csv, RowsAndNumbers) {
  const auto rows = readCsv(bytesOf("a,b\r\n\n\"x, \"\"y\"\"\",2\n"), "t.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].line, 3u);
  EXPECT_EQ(rows[1].fields, (std::vector<std::string>{"x, \"y\"", "2"}));
  EXPECT_EQ(csvNumber(" 2.43e+004 ", "t", 1), 24300.0);
  for (const char* bad : {"", "  ", "nan", "inf", "1e999", "1.0x", "0x10", "--1"})
    expectInputError([&] { csvNumber(bad, "t.csv", 7); }, "t.csv:7");
  expectInputError([] { readCsv(bytesOf("a,\"b\n"), "t.csv"); }, "t.csv:1: a quote is not closed");
  expectInputError([] { readCsv(bytesOf("\n \n"), "t.csv"); }, "no rows");
  expectInputError([] { readCsv({std::vector<std::uint8_t>{65, 0, 66}}, "t.csv"); }, "zero byte");
}

TEST(NdfTable, ReadsAndRefuses) {
  const auto table = readNdfTable(bytesOf("degrees,value\n0,2\n10,1\n20,0\n"), "n.csv");
  EXPECT_LE(std::abs(table.at(5.0 / 180 * lobe64::kPi) - 1.5), 1e-12);
  EXPECT_EQ(table.at(0.0), 2.0);
  EXPECT_EQ(table.at(1.0), 0.0);
  EXPECT_EQ(table.peak(), 2.0);
  const auto refused = [](const std::string& text, const std::string& about) {
    expectInputError([&] { readNdfTable(bytesOf(text), "n.csv"); }, about);
  };
  refused("0,1\n10,2\n", "2 rows of numbers");
  refused("0,1\n10,1,1\n20,1\n", "n.csv:2: has 3 fields");
  refused("0,1\n20,1\n20,1\n", "n.csv:3: the angle 20 is not above");
  refused("0,1\n20,1\n91,1\n", "not between 0 and 90");
  refused("0,1\n20,-1\n30,1\n", "negative");
  refused("0,0\n20,0\n30,0\n", "0 everywhere");
  refused("0,1\n20,nan\n30,0\n", "no finite number");
}

// ---- the models of the tables ------------------------------------------------------------------------------------------------------------

TEST(DielectricFresnel, KnownValues) {
  EXPECT_LE(std::abs(dielectricFresnel(1.0, 1.5) - 0.04), 1e-14);
  EXPECT_LE(std::abs(dielectricFresnel(0.0, 1.5) - 1.0), 1e-14);
  // Brewster's angle: half of the perpendicular part, ((n^2 - 1) / (n^2 + 1))^2 / 2.
  const double brewster = std::atan(1.5), perpendicular = (1.5 * 1.5 - 1) / (1.5 * 1.5 + 1);
  EXPECT_LE(std::abs(dielectricFresnel(std::cos(brewster), 1.5) - .5 * perpendicular * perpendicular), 1e-12);
  EXPECT_EQ(dielectricFresnel(.1, 1 / 1.5), 1.0);
}

TEST(AbcModel, FormulaReciprocityAndHorizon) {
  const AbcModel model{.diffuse = Vec3(.3, .2, .1), .a = Vec3(5, 6, 7), .b = 100, .c = 1.2, .ior = 1.5};
  const auto rho = abcReflectance(model);
  const Vec3 n(0, 0, 1);
  // At the normal D = A, G = 1, F = .04.
  EXPECT_LE(std::abs(rho(n, n).y - (.2 + .04 * 6) / lobe64::kPi), 1e-12);
  const Vec3 wo = direction(.5, .1), wi = direction(1.1, 2.0);
  EXPECT_LE(glm::length(rho(wo, wi) - rho(wi, wo)), 1e-12);
  const Vec3 wh = lobe64::halfVector(wo, wi);
  const double d = 5 / std::pow(1 + 100 * (1 - wh.z), 1.2),
               g = std::min({1.0, 2 * wh.z * wo.z / dot(wo, wh), 2 * wh.z * wi.z / dot(wo, wh)});
  EXPECT_LE(std::abs(rho(wo, wi).x - (.3 + dielectricFresnel(dot(wo, wh), 1.5) * g * d / (wo.z * wi.z)) / lobe64::kPi), 1e-12);
  EXPECT_EQ(rho(wo, -wi), Vec3(0.0));
}

TEST(SgdModel, FormulaAndExtremes) {
  const SgdChannel c{
      .rhoD = .1, .rhoS = .5, .alpha = .2, .p = .7, .f0 = .3, .f1 = .05, .kap = 4, .lambda = 3, .c = .01, .k = 8, .theta0 = .2};
  const auto rho = sgdReflectance({c, c, c});
  const double d = 4 * std::exp(-.2) / (lobe64::kPi * std::pow(.2, .7));
  EXPECT_LE(std::abs(rho(Vec3(0, 0, 1), Vec3(0, 0, 1)).x - (.1 + .5 * (.3 - .05) * d) / lobe64::kPi), 1e-12);
  const Vec3 wo = direction(.5, .1), wi = direction(1.1, 2.0);
  EXPECT_LE(glm::length(rho(wo, wi) - rho(wi, wo)), 1e-12);
  // The table has c up to 1e38, k up to 800, lambda up to 1e7, theta0 below 0: finite and not negative all the same.
  for (const double cc : {1e38, 1e-8, 0.0})
    for (const double k : {855.0, 6.7})
      for (const double theta0 : {-.6, 1.2})
        for (const double angle : {0.0, .3, 1.5, 1.5707963}) {
          const SgdChannel e{.rhoD = 0,
                             .rhoS = .1,
                             .alpha = 2e-5,
                             .p = 1e-12,
                             .f0 = 0,
                             .f1 = -1,
                             .kap = 6e4,
                             .lambda = 9e6,
                             .c = cc,
                             .k = k,
                             .theta0 = theta0};
          const Vec3 value = sgdReflectance({e, e, e})(direction(angle, 0), direction(angle, lobe64::kPi));
          EXPECT_TRUE(value.x >= 0.0 && std::isfinite(value.x))
              << cc << ' ' << k << ' ' << theta0 << ' ' << angle << ' ' << value.x;
        }
}

// Each family beside the project's own model of the same shape, which is tested elsewhere.
TEST(NganModel, LobesBesideOurModels) {
  const Vec3 wo = direction(.4, .1), wi = direction(.7, 2.8);
  const auto ours = [&](int kind, double x) {
    return lobe64::modelTimesCosine(lobe64::reflectanceModel(kind, x, x), wo, wi) / wi.z;
  };
  EXPECT_LE(std::abs(nganLobe({.family = NganFamily::ward, .width = .3}, wo, wi) / ours(lobe64::kWard, .3) - 1), 1e-12);
  EXPECT_LE(
      std::abs(nganLobe({.family = NganFamily::ashikhminShirley, .width = 30}, wo, wi) / ours(lobe64::kAshikhminShirley, 30) - 1),
      1e-12);
  EXPECT_LE(
      std::abs(
          nganLobe({.family = NganFamily::wardDuer, .width = .3}, wo, wi) * std::sqrt(wo.z * wi.z) / ours(lobe64::kWard, .3) - 1),
      1e-12);
  const Vec3 wh = lobe64::halfVector(wo, wi);
  EXPECT_LE(
      std::abs(nganLobe({.family = NganFamily::blinnPhong, .width = 30}, wo, wi) - 32 / lobe64::kTwoPi * std::pow(wh.z, 30)),
      1e-12);
  const double tan2 = 1 / (wh.z * wh.z) - 1;
  EXPECT_LE(
      std::abs(nganLobe({.family = NganFamily::cookTorrance, .width = .3}, wo, wi) -
               grooveMasking(wo, wi, wh) * std::exp(-tan2 / .09) / (lobe64::kFourPi * .09 * std::pow(wh.z, 4) * wo.z * wi.z)),
      1e-12);
  // Lafortune's lobe is 1 for the mirror direction with these coefficients.
  const Vec3 mirror(-wo.x, -wo.y, wo.z);
  EXPECT_LE(std::abs(nganLobe({.family = NganFamily::lafortune, .width = 50, .cxy = -1, .cz = 1}, wo, mirror) - 1), 1e-12);
  EXPECT_EQ(nganLobe({.family = NganFamily::lafortune, .width = 50, .cxy = 1, .cz = .1}, wo, mirror), 0.0);
}

TEST(MaterialFile, TablesByTheirColumns) {
  writeFileAtomically(
      "abc.csv",
      std::string_view(
          "material,kD_r,kD_g,kD_b,A_r,A_g,A_b,B,C,ior\nred,.5,.1,.1,1,1,1,20,1.5,1.4\nblue,.1,.1,.5,1,1,1,20,1.5,1.4\n"));
  const auto abc = readMaterials("abc.csv");
  ASSERT_EQ(abc.size(), 2u);
  EXPECT_EQ(abc[1].name, "blue");
  EXPECT_EQ(abc[1].form, MaterialForm::abc);
  EXPECT_GT(abc[1].reflectance(Vec3(0, 0, 1), Vec3(0, 0, 1)).z, .5 / lobe64::kPi);
  EXPECT_EQ(readMaterial("abc.csv", "red").name, "red");
  expectInputError([] { readMaterial("abc.csv", ""); }, "has 2 materials", ExitCode::usage);
  expectInputError([] { readMaterial("abc.csv", "green"); }, "has no \"green\"", ExitCode::usage);

  std::string names = "material,alias", values = "stone,", end;
  for (const char* column : {"rhoD", "rhoS", "alpha", "p", "f0", "f1", "kap", "lambda", "c", "k", "theta0", "error"})
    for (const char* channel : {"_r", "_g", "_b"}) names += std::string(",") + column + channel, values += ",0.5";
  writeFileAtomically("sgd.csv", names + "\n" + values + "\n");
  EXPECT_EQ(readMaterial("sgd.csv", "").form, MaterialForm::sgd);

  const std::string lobes =
      "\"Lambertian scale=(0.1,0.2,0.3)  | CookTorrance scale=(1e-1,2.43e+004,0) m=0.2 F0=0.1 | LafortuneIso scale=(1,1,1) "
      "Cxy=-0.6 Cz=0.5 Exponent=14.1\"";
  writeFileAtomically("ngan.csv", "material,fit,error,lobes\nA,Ngan-CookTorrance,0.1," + lobes + "\n");
  const auto ngan = readMaterial("ngan.csv", "A/Ngan-CookTorrance");
  ASSERT_TRUE(ngan.ngan.has_value());
  EXPECT_EQ(ngan.ngan->diffuse, Vec3(.1, .2, .3));
  ASSERT_EQ(ngan.ngan->lobes.size(), 2u);
  EXPECT_EQ(ngan.ngan->lobes[0].scale.y, 24300.0);
  EXPECT_EQ(ngan.ngan->lobes[0].f0, .1);
  EXPECT_EQ(ngan.ngan->lobes[1].cxy, -.6);

  writeFileAtomically("facets.csv", std::string_view("0,1\n5,.5\n10,.1\n"));
  EXPECT_TRUE(readMaterial("facets.csv", "").ndf.has_value());
}

TEST(MaterialFile, RefusesWhatIsWrong) {
  const auto refused = [](const std::string& name, const std::string& text, const std::string& about) {
    writeFileAtomically(name, text);
    expectInputError([&] { readMaterials(name); }, about);
  };
  const std::string abc = "material,kD_r,kD_g,kD_b,A_r,A_g,A_b,B,C,ior\n";
  refused("a.csv", abc, "no rows under");
  refused("a.csv", abc + "x,1,1,1,1,1,1,1,1\n", "a.csv:2: has 9 fields, the line of names 10");
  refused("a.csv", abc + "x,1,1,1,1,1,1,1,1,nan\n", "a.csv:2: \"nan\" is no finite number");
  refused("a.csv", abc + "x,1,1,1,1,1,1,1,1,0\n", "a.csv:2: ior is not above 0");
  refused("a.csv", "material,kD_r\nx,1\n", "no column \"kD_g\"");
  refused("a.csv", "material,colour\nx,1\n", "no table that is known");
  refused("a.txt", "material,colour\nx,1\n", "of no form that is known");
  const std::string ngan = "material,fit,error,lobes\n";
  refused("n.csv", ngan + "x,y,0,Phong scale=(1\n", "n.csv:2");
  refused("n.csv", ngan + "x,y,0,\"Phong scale=(1,1,1)\"\n", "the lobe \"Phong\" is not known");
  refused("n.csv", ngan + "x,y,0,\"Ward scale=(1,1,1)\"\n", "Ward has no ax");
  refused("n.csv", ngan + "x,y,0,\"Ward scale=(1,1,1) ax=-1\"\n", "Ward has ax=-1");
  refused("n.csv", ngan + "x,y,0,\"Ward scale=(1,1) ax=.1\"\n", "has not three numbers");
  refused("n.csv", ngan + "x,y,0,\"Ward ax=.1\"\n", "has no scale");
  refused("n.csv", ngan + "x,y,0,\"Ward scale=(1,1,1) ax\"\n", "not NAME=VALUE");
}

}  // namespace
}  // namespace chiaro
