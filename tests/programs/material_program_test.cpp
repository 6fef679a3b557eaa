// `chiaro-precompute material` as its users meet it, and `chiaro-report brdf --measured`, on files that the tests make.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/image/image.h"
#include "assets/scene/load_scene.h"
#include "precompute/material/material_fit.h"
#include "precompute/material/merl_file.h"
#include "precompute/report/brdf/factorisation.h"
#include "precompute/report/brdf/measured_study.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

using testing::HasSubstr;

std::string textOf(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  return {bytes.begin(), bytes.end()};
}
nlohmann::json jsonOf(const std::filesystem::path& path) { return nlohmann::json::parse(textOf(path)); }

/// GGX of width .2, F0 (.3, .2, .1), F90 1, on diffuse (.1, .2, .4).
const char* ggxFile() {
  static const bool made = [] {
    MaterialFit fit;
    fit.width = fit.width2 = .2;
    fit.diffuse = {.1, .2, .4};
    fit.specular = {.3, .2, .1};
    writeFileAtomically("known.binary", merlFileOf(fittedReflectance(modelFamily(lobe64::kGgx), fit)));
    return true;
  }();
  return made ? "known.binary" : "";
}

const char* tableFile() {
  writeFileAtomically(
      "table.csv",
      std::string_view(
          "material,kD_r,kD_g,kD_b,A_r,A_g,A_b,B,C,ior\nred,.5,.1,.1,5,5,5,40,1.6,1.4\nblue,.1,.1,.5,9,9,9,120,1.5,1.6\n"));
  return "table.csv";
}

Finished material(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "material");
  arguments.insert(arguments.end(), {"--size", "16", "--samples", "4"});
  return runProgram("chiaro-precompute", arguments);
}

void expectOneLine(const Finished& run, ExitCode code, const std::string& about) {
  EXPECT_EQ(run.code, static_cast<int>(code)) << run.err;
  EXPECT_EQ(run.errorLines(), 1) << run.err;
  EXPECT_EQ(run.err.rfind("chiaro-precompute: ", 0), 0u) << run.err;
  EXPECT_THAT(run.err, HasSubstr(about));
}

TEST(MaterialProgram, FitsAFileAndWritesEverything) {
  const Finished run = material({ggxFile(), "-o", "known.gltf", "--name", "My \"gold\""});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("chosen"));
  const auto gltf = jsonOf("known.gltf");
  EXPECT_EQ(gltf["asset"]["version"], "2.0");
  EXPECT_EQ(gltf["extensionsUsed"], nlohmann::json::array({"CHIARO_materials_reflectance"}));
  ASSERT_EQ(gltf["materials"].size(), 1u);
  const auto& m = gltf["materials"][0];
  EXPECT_EQ(m["name"], "My \"gold\"");
  EXPECT_EQ(m["pbrMetallicRoughness"]["metallicFactor"], 0.0);
  EXPECT_LE(std::abs(m["pbrMetallicRoughness"]["roughnessFactor"].get<double>() - std::sqrt(.2)), 1e-3);
  const auto& reflectance = m["extensions"]["CHIARO_materials_reflectance"];
  EXPECT_EQ(reflectance["model"], "ggx");
  const double diffuse[] = {.1, .2, .4}, f0[] = {.3, .2, .1};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LE(std::abs(m["pbrMetallicRoughness"]["baseColorFactor"][c].get<double>() - diffuse[c]), 1e-3);
    EXPECT_LE(std::abs(reflectance["specularColor"][c].get<double>() - f0[c]), 1e-3);
  }
  for (std::size_t k = 0; k < 2; ++k) EXPECT_LE(std::abs(reflectance["width"][k].get<double>() - .2), 1e-3);

  const auto json = jsonOf("known.json");
  EXPECT_EQ(json["chosen"], "ggx");
  ASSERT_EQ(json["models"].size(), 6u);
  EXPECT_LE(json["models"][0]["equation_11"]["model"].get<double>(), 1e-5);
  EXPECT_LE(json["models"][0]["equation_11"]["mixture"].get<double>(), 1e-3);
  EXPECT_EQ(json["models"][0]["lobes"].size(), 3u);
  for (const auto& one : json["models"]) EXPECT_GE(one["error"].get<double>(), json["models"][0]["error"].get<double>());
  EXPECT_THAT(textOf("known.svg"), HasSubstr("<svg xmlns"));
  const Image8 picture = readPng("known.png");
  EXPECT_EQ(picture.width, 32);
  EXPECT_EQ(picture.height, 16);
}

TEST(MaterialProgram, TableRowsAndF90) {
  ASSERT_EQ(material({tableFile(), "--row", "blue", "--model", "beckmann", "--lobes", "2", "-o", "blue.gltf", "-q"}).code, 0);
  const auto m = jsonOf("blue.gltf")["materials"][0];
  EXPECT_EQ(m["name"], "blue");
  // An ABC material's F does not reach 1 where it is measured: F0 and F90 are KHR_materials_specular's.
  const auto& specular = m["extensions"]["KHR_materials_specular"];
  const double f90 = specular["specularFactor"].get<double>(), f0 = .04 * specular["specularColorFactor"][0].get<double>() * f90;
  EXPECT_GT(f90, 0.0);
  EXPECT_LT(f90, .999);
  EXPECT_LE(f0, f90 * (1 + 1e-9));
  EXPECT_FALSE(m["extensions"]["CHIARO_materials_reflectance"].contains("specularColor"));
  const auto json = jsonOf("blue.json");
  EXPECT_LE(std::abs(json["models"][0]["f0"][0].get<double>() - f0), 1e-9);
  EXPECT_EQ(json["models"][0]["lobes"].size(), 2u);

  const Finished one =
      material({tableFile(), "--row", "blue", "--model", "beckmann", "--f90", "1", "--metric", "cosine", "-o", "blue1.gltf"});
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_TRUE(jsonOf("blue1.gltf")["materials"][0]["extensions"]["CHIARO_materials_reflectance"].contains("specularColor"));
  EXPECT_EQ(jsonOf("blue1.json")["metric"], "cosine");

  const Finished two = material({tableFile(), "--row", "red", "--model", "ggx", "--specular-lobes", "2", "-o", "red.gltf"});
  ASSERT_EQ(two.code, 0) << two.err;
  EXPECT_EQ(jsonOf("red.gltf")["materials"].size(), 1u);
}

TEST(MaterialProgram, Distribution) {
  std::string text = "degrees,value\n";
  for (int i = 0; i <= 90; ++i)
    text += std::to_string(i) + "," + std::to_string(7 * std::pow(std::cos(i * lobe64::kPi / 180), 40)) + "\n";
  writeFileAtomically("facets.csv", text);
  const Finished run = material({"facets.csv", "--lobes", "1", "-o", "facets.gltf"});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto reflectance = jsonOf("facets.gltf")["materials"][0]["extensions"]["CHIARO_materials_reflectance"];
  // Blinn-Phong and Ashikhmin-Shirley are one distribution where they are round; the exponent is what was tabulated.
  EXPECT_TRUE(reflectance["model"] == "blinnPhong" || reflectance["model"] == "ashikhminShirley") << reflectance["model"];
  EXPECT_LE(std::abs(reflectance["width"][0].get<double>() / 40 - 1), .02);
  const auto json = jsonOf("facets.json");
  EXPECT_LE(json["distribution"]["lobes_error"].get<double>(), .01);
  EXPECT_LE(std::abs(json["distribution"]["lobes"][0]["sharpness"].get<double>() / 41 - 1), .02);  // n + 1
  EXPECT_EQ(readPng("facets.png").width, 16);
}

TEST(MaterialProgram, GoesOntoASceneWhenItIsBaked) {
  std::filesystem::remove("onto.glb");  // of an earlier run
  ASSERT_EQ(material({ggxFile(), "--model", "ggx", "-o", "onto.gltf"}).code, 0);
  const std::vector<std::string> bake{"builtin:sphere", "-o", "onto.glb", "--resolution", "16", "--terms", "8",
                                      "--directions",   "8"};
  const auto with = [&](const std::string& material) {
    auto arguments = bake;
    arguments.insert(arguments.end(), {"--material", material});
    return runProgram("chiaro-precompute", arguments);
  };
  expectOneLine(with("white"), ExitCode::usage, "--material");
  expectOneLine(with("=onto.gltf"), ExitCode::usage, "--material");
  expectOneLine(with("black=onto.gltf"), ExitCode::usage, "no material \"black\": it has white");
  expectOneLine(with("white=nothing.gltf"), ExitCode::unreadableInput, "nothing.gltf");
  EXPECT_FALSE(std::filesystem::exists("onto.glb"));
  const Finished run = with("white=onto.gltf");
  ASSERT_EQ(run.code, 0) << run.err;
  const Scene scene = loadScene("onto.glb");
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "white");
  EXPECT_LE(std::abs(scene.materials[0].baseColorFactor.z - .4f), 1e-3f);
  EXPECT_LE(std::abs(scene.materials[0].roughnessFactor - std::sqrt(.2f)), 1e-3f);
}

TEST(MaterialProgram, TheSameWhateverTheThreads) {
  ASSERT_EQ(material({tableFile(), "--row", "red", "-o", "a.gltf", "--threads", "1"}).code, 0);
  ASSERT_EQ(material({tableFile(), "--row", "red", "-o", "b.gltf", "--threads", "3"}).code, 0);
  for (const char* ending : {".gltf", ".json", ".svg", ".png"})
    EXPECT_EQ(readFile(std::string("a") + ending), readFile(std::string("b") + ending)) << ending;
}

TEST(MaterialProgram, WrongUsageIsOneLineAndTwo) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{}, "file"},
      {{"x.binary"}, "--output"},
      {{"x.binary", "-o", "x.glb"}, "does not end in .gltf"},
      {{tableFile(), "-o", "x.gltf"}, "--row"},
      {{tableFile(), "-o", "x.gltf", "--row", "green"}, "has no \"green\""},
      {{tableFile(), "-o", "x.gltf", "--row", "red", "--model", "phong"}, "--model"},
      {{tableFile(), "-o", "x.gltf", "--row", "red", "--lobes", "5"}, "--lobes"},
      {{tableFile(), "-o", "x.gltf", "--row", "red", "--specular-lobes", "3"}, "--specular-lobes"},
      {{tableFile(), "-o", "x.gltf", "--row", "red", "--metric", "l1"}, "--metric"},
      {{tableFile(), "-o", "x.gltf", "--row", "red", "--f90", "0"}, "--f90"},
      {{tableFile(), "-o", "x.gltf", "--row", "red", "--threads", "-1"}, "--threads"},
      {{tableFile(), "-o", "x.gltf", "--row", "red", "--frobnicate"}, "--frobnicate"}};
  for (const auto& [arguments, about] : cases) {
    expectOneLine(material(arguments), ExitCode::usage, about);
    EXPECT_FALSE(std::filesystem::exists("x.gltf"));
    EXPECT_FALSE(std::filesystem::exists("x.json"));
  }
}

TEST(MaterialProgram, BadFilesAreOneLineAndThreeOrFour) {
  writeFileAtomically("short.binary", std::string_view("\x5a\0\0\0", 4));
  expectOneLine(material({"short.binary", "-o", "x.gltf"}), ExitCode::unreadableInput, "short.binary: is cut short");
  expectOneLine(material({"nothing.binary", "-o", "x.gltf"}), ExitCode::unreadableInput, "nothing.binary");
  expectOneLine(material({tableFile(), "--row", "red", "-o", "x.gltf", "-e", "nowhere.hdr"}), ExitCode::unreadableInput,
                "nowhere.hdr");
  expectOneLine(material({tableFile(), "--row", "red", "-o", "no/folder/x.gltf"}), ExitCode::unwritableOutput,
                "no/folder/x.gltf");
  EXPECT_FALSE(std::filesystem::exists("x.gltf"));
}

// ---- the report ------------------------------------------------------------------------------------------------------------------------------

TEST(MeasuredReport, FilesOfAFolder) {
  std::filesystem::create_directories("folder/deep");
  std::filesystem::create_directories("empty");
  tableFile();
  std::filesystem::copy_file("table.csv", "folder/deep/table.csv", std::filesystem::copy_options::overwrite_existing);
  writeFileAtomically("folder/other.csv", std::string_view("a,b\n1,2\n"));
  writeFileAtomically("folder/notes.txt", std::string_view("material,\n"));
  const auto files = measuredFiles({"folder", "table.csv"});
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0], "folder/deep/table.csv");
  EXPECT_THROW(measuredFiles({"empty"}), Error);
}

// A model as data: its nine lobes cost what they cost against the model, and Ngan's own parameters come back from their own reflectance.
TEST(MeasuredReport, KnownMaterials) {
  writeFileAtomically(
      "ngan.csv",
      std::string_view("material,fit,error,lobes\n"
                       "MERL-known,Ngan-Ward,0.1,\"Lambertian scale=(0.1,0.2,0.3)  | Ward scale=(0.2,0.2,0.2) ax=0.2\"\n"
                       "MERL-known,Ngan-CookTorrance,0.1,\"Lambertian scale=(0.1,0.2,0.3)  | CookTorrance scale=(0.3,0.3,0.3) "
                       "m=0.2 F0=0.2\"\n"));
  const MeasuredStudy study = studyMeasured({ggxFile(), "ngan.csv"}, true, 2, [](const std::string&, double) {});
  ASSERT_EQ(study.materials.size(), 3u);
  const MeasuredMaterial& known = study.materials[0];
  EXPECT_EQ(known.best.kind, lobe64::kGgx);
  EXPECT_LE(known.best.error, 1e-5);
  EXPECT_LE(known.cosineModel, 1e-5);
  EXPECT_LE(known.ours, .01);
  EXPECT_LT(known.ours, known.best.isotropicError);
  EXPECT_GT(known.factored16, known.factored64);
  EXPECT_GT(known.factored64, known.factored256);
  EXPECT_LE(known.factored256, .01);
  EXPECT_EQ(study.materials[1].best.kind, lobe64::kWard);
  ASSERT_EQ(study.refits.size(), 2u);
  EXPECT_EQ(study.refits[0].publishedWidth, .2);
  EXPECT_TRUE(std::isfinite(study.refits[0].error));
  for (const auto& figure : study.figures) EXPECT_FALSE(figure.curves.empty());
}

// A model's own factorisation, by its values.
TEST(MeasuredReport, FactorisationOfValuesIsThatOfTheModel) {
  const auto model = lobe64::reflectanceModel(lobe64::kGgx, .4, .4);
  const auto value = [&](const lobe64::Vec3& wo, const lobe64::Vec3& wi) { return lobe64::modelTimesCosine(model, wo, wi); };
  const auto a = factorisationErrors(model, lobe64::kHalfPi, 24, 48, {4, 16}),
             b = factorisationErrors(RoundReflectance(value), lobe64::kHalfPi, 24, 48, {4, 16});
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(a[k], b[k]);
}

}  // namespace
}  // namespace chiaro
