#pragma once
/// What chiaro-report was asked to do.

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "assets/image/display.h"
#include "assets/scene/camera_spec.h"
#include "assets/scene/reflectance.h"

namespace CLI {
class App;
}

namespace chiaro {

/// What the third picture of a case shows: too bright and too dark, FLIP of what the screen shows, FLIP of radiance.
enum class ErrorMapKind { difference, flip, hdrFlip };

struct ReportOptions {
  std::filesystem::path scene;            ///< a baked .glb
  std::filesystem::path other;            ///< a baked .glb that takes the place of the reference; empty: none
  std::filesystem::path output;           ///< a folder, made where missing
  std::vector<std::string> environments;  ///< names or files; never empty after finishReportOptions()
  std::vector<float> roughnesses;         ///< perceptual, of every material; empty: the scene's own
  std::optional<float> metallic;          ///< of every material, with or without `roughnesses`
  glm::ivec2 size{480, 300};              ///< pixels
  CameraSpec camera;
  std::vector<Light> lights;      ///< beside the scene's own
  int supersample = 2;            ///< supersample^2 shaded points a pixel, in the picture and in the reference alike
  int samples = 128;              ///< of the reference, light and BRDF sample pairs a pixel
  std::optional<float> exposure;  ///< absent: autoExposure() of each environment
  ToneMap toneMap = ToneMap::neutral;
  bool shadows = true;
  std::vector<Reflectance> models;   ///< of every material; empty: the scene's own
  bool energyCompensation = false;
  int lobes = 0;                     ///< RenderSettings::lobes
  ErrorMapKind errorMap = ErrorMapKind::difference;
  std::optional<double> failUnder;  ///< dB
  std::optional<double> failOver;   ///< RMSE
  int threads = 0;
  bool quiet = false;
};

/// The option values as text, before finishReportOptions() turns them into the above.
struct ReportOptionTexts {
  std::string scene, other, output;
  std::string size = "480x300";
  std::string camera = "auto";
  std::string exposure = "auto";
  std::string toneMap = "neutral";
  std::vector<std::string> models;
  std::vector<std::string> lights;
  std::string errorMap = "difference";
  bool noShadows = false;
};

/// "480x300". Throws Error (usage).
glm::ivec2 sizeFrom(const std::string& text);

/// Declares every option on `app`; the two structures must outlive its parse().
void declareReportOptions(CLI::App& app, ReportOptions& options, ReportOptionTexts& texts);

/// Checks and converts what parse() left, and that the output folder can be made. Makes nothing. Throws Error (usage,
/// unreadableInput, unwritableOutput).
void finishReportOptions(ReportOptions& options, const ReportOptionTexts& texts);

}  // namespace chiaro
