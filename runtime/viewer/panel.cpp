#include "runtime/viewer/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "runtime/render/upsample_spec.h"
#include "runtime/viewer/view_options.h"

namespace chiaro {
namespace {

float linearOfSrgb(float encoded) { return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f); }

/// A combo box over names; the index picked now, if any.
std::optional<std::size_t> chooser(const char* label, const std::vector<std::string>& names, std::size_t current, const char* shown = nullptr) {
  std::optional<std::size_t> picked;
  const char* preview = shown != nullptr ? shown : current < names.size() ? names[current].c_str() : "";
  if (!ImGui::BeginCombo(label, preview)) return picked;
  for (std::size_t i = 0; i < names.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(names[i].c_str(), shown == nullptr && i == current)) picked = i;
    ImGui::PopID();
  }
  ImGui::EndCombo();
  return picked;
}

void drawLight(PanelState& state, PanelActions& actions) {
  if (!ImGui::CollapsingHeader("Light", ImGuiTreeNodeFlags_DefaultOpen)) return;
  std::vector<std::string> names;  // of a file, the name without its folders
  for (const auto& name : state.environments) names.push_back(std::filesystem::path(name).filename().string());
  actions.environment = chooser("environment", names, state.environment);
  ImGui::SliderFloat("rotation", &state.rotationDegrees, -180.0f, 180.0f, "%.0f deg");
  ImGui::Checkbox("shadows", &state.shadows);
  ImGui::SameLine();
  ImGui::Checkbox("background", &state.background);
}

/// Azimuth and elevation of where the light comes from.
bool drawDirection(Light& light) {
  const glm::vec3 from = -light.direction;
  float azimuth = std::atan2(from.x, from.z), elevation = std::asin(std::clamp(from.y, -1.0f, 1.0f));
  const bool turned = ImGui::SliderAngle("azimuth", &azimuth, -180.0f, 180.0f);
  if (!(ImGui::SliderAngle("elevation", &elevation, -90.0f, 90.0f) || turned)) return false;
  light.direction = -glm::vec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation), std::cos(azimuth) * std::cos(elevation));
  return true;
}

bool drawLamp(Light& light, float sceneSize) {
  bool changed = false;
  const bool sun = light.type == LightType::directional, coned = light.type == LightType::spot || light.type == LightType::disk;
  if (!sun) changed |= ImGui::DragFloat3("position", &light.position.x, 0.002f * sceneSize, 0.0f, 0.0f, "%.3f");
  if (sun || coned) changed |= drawDirection(light);
  if (sun) changed |= ImGui::SliderAngle("angular radius", &light.angle, 0.0f, 90.0f, "%.2f deg");
  if (light.type == LightType::sphere || light.type == LightType::disk)
    changed |= ImGui::DragFloat("radius", &light.radius, 0.0005f * sceneSize, 0.0f, sceneSize, "%.4f");
  changed |= ImGui::DragFloat(sun ? "lux" : "candela", &light.intensity, 0.01f * std::max(light.intensity, 0.1f), 0.0f, 1e6f, "%.4g");
  changed |= ImGui::ColorEdit3("colour", &light.color.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR);
  // A typed value may leave its range.
  light.angle = std::clamp(light.angle, 0.0f, 1.57079637f);
  light.radius = std::max(light.radius, 0.0f);
  light.intensity = std::max(light.intensity, 0.0f);
  light.color = glm::max(light.color, glm::vec3(0.0f));
  return changed;
}

void drawLamps(PanelState& state, PanelActions& actions) {
  if (state.lights.empty() || !ImGui::CollapsingHeader("Lights of the scene", ImGuiTreeNodeFlags_DefaultOpen)) return;
  static const char* const kKinds[] = {"sun", "point", "spot", "sphere", "disk"};
  ImGui::PushID("lights");
  for (std::size_t i = 0; i < state.lights.size(); ++i) {
    auto& light = state.lights[i];
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::TreeNodeEx("light", ImGuiTreeNodeFlags_None, "%zu  %s %s", i, kKinds[static_cast<std::size_t>(light.type)], light.name.c_str())) {
      actions.lightsChanged |= drawLamp(light, state.sceneSize);
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  ImGui::PopID();
  actions.copyLights = ImGui::Button("Copy as --light");
}

void drawUpsampling(PanelState& state) {
  ImGui::SliderInt("upsample", &state.upsample, 1, kLargestUpsample, "%d x");
  state.upsample = std::clamp(state.upsample, 1, kLargestUpsample);
  if (state.upsample == 1) return;
  if (const auto picked = chooser("weights", upsampleWeightNames(), static_cast<std::size_t>(state.upsampleWeights)))
    state.upsampleWeights = static_cast<UpsampleWeights>(*picked);
  bool timed = state.recompute.milliseconds > 0.0f;
  if (ImGui::Checkbox("recompute by time", &timed)) state.recompute = timed ? RecomputeBudget{0.0f, 1.0f} : RecomputeBudget{};
  float percent = 100.0f * state.recompute.share;
  if (timed) ImGui::SliderFloat("recompute", &state.recompute.milliseconds, 0.1f, 20.0f, "%.1f ms");
  else if (ImGui::SliderFloat("recompute", &percent, 0.0f, 100.0f, "%.0f %% of pixels")) state.recompute.share = std::clamp(percent, 0.0f, 100.0f) / 100.0f;
}

void drawPicture(PanelState& state, PanelActions& actions) {
  if (!ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::Checkbox("automatic exposure", &state.autoExposure);
  ImGui::SliderFloat("exposure", &state.exposureStops, -10.0f, 10.0f, "%+.1f stops");
  static const std::vector<std::string> kToneMaps{"neutral", "aces", "clamp"};
  if (const auto picked = chooser("tone map", kToneMaps, static_cast<std::size_t>(state.toneMap))) state.toneMap = static_cast<ToneMap>(*picked);
  ImGui::SliderInt("supersample", &state.supersample, 1, 8, "%d x");
  state.supersample = std::clamp(state.supersample, 1, 8);
  drawUpsampling(state);
  if (const auto picked = chooser("show", debugViewNames(), static_cast<std::size_t>(state.debugView)))
    state.debugView = static_cast<DebugView>(*picked);
  ImGui::InputText("file", state.pictureName.data(), state.pictureName.size());
  if (ImGui::Button("Save picture")) actions.savePicture = true;
  ImGui::SameLine();
  ImGui::TextDisabled(".png or .exr");
}

void drawCamera(PanelState& state, PanelActions& actions) {
  if (!ImGui::CollapsingHeader("Camera")) return;
  if (!state.cameras.empty()) actions.camera = chooser("go to", state.cameras, 0, "cameras of the file");
  actions.fovChanged = ImGui::SliderFloat("field of view", &state.verticalFovDegrees, 2.0f, 150.0f, "%.0f deg");
  actions.frameScene = ImGui::Button("Frame the scene (F)");
  ImGui::SameLine();
  actions.copyCamera = ImGui::Button("Copy as --camera");
}

bool drawMaterial(Material& material) {
  const glm::vec3 shown = displayColor(glm::vec3(material.baseColorFactor), 1.0f, ToneMap::clamp);
  glm::vec3 color = shown;
  bool changed = false;
  if (ImGui::ColorEdit3("base colour", &color.x)) {
    material.baseColorFactor = glm::vec4(linearOfSrgb(color.x), linearOfSrgb(color.y), linearOfSrgb(color.z), material.baseColorFactor.a);
    changed = true;
  }
  changed |= ImGui::SliderFloat("roughness", &material.roughnessFactor, 0.0f, 1.0f);
  changed |= ImGui::SliderFloat("metallic", &material.metallicFactor, 0.0f, 1.0f);
  changed |= ImGui::SliderFloat("anisotropy", &material.anisotropyStrength, 0.0f, 1.0f);
  changed |= ImGui::SliderAngle("its direction", &material.anisotropyRotation, -180.0f, 180.0f);
  // A value typed into a slider may leave its range; the shading's formulas hold inside only.
  material.roughnessFactor = std::clamp(material.roughnessFactor, 0.0f, 1.0f);
  material.metallicFactor = std::clamp(material.metallicFactor, 0.0f, 1.0f);
  material.anisotropyStrength = std::clamp(material.anisotropyStrength, 0.0f, 1.0f);
  if (material.metallicRoughnessTexture != kNone || material.baseColorTexture != kNone) ImGui::TextDisabled("multiplies its textures");
  return changed;
}

void drawMaterials(PanelState& state, PanelActions& actions) {
  if (!ImGui::CollapsingHeader("Materials", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const ImGuiTreeNodeFlags open = state.materials.size() == 1 ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None;
  for (std::size_t i = 0; i < state.materials.size(); ++i) {
    auto& material = state.materials[i];
    ImGui::PushID(static_cast<int>(i));
    const char* name = material.name.empty() ? "material" : material.name.c_str();
    if (ImGui::TreeNodeEx("material", open, "%zu  %s", i, name)) {
      if (drawMaterial(material)) actions.materialsChanged = true;
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  actions.resetMaterials = ImGui::Button("As in the file");
}

void drawTimes(PanelState& state) {
  if (!ImGui::CollapsingHeader("Frame time", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const auto& values = state.history.values();
  const float highest = values.empty() ? 1.0f : *std::max_element(values.begin(), values.end());
  char label[64];
  std::snprintf(label, sizeof label, "%.2f ms of GPU", static_cast<double>(state.history.latest()));
  ImGui::PlotLines("##times", values.data(), static_cast<int>(values.size()), 0, label, 0.0f, 1.1f * highest,
                   ImVec2(ImGui::GetContentRegionAvail().x, 4.0f * ImGui::GetTextLineHeight()));
  for (const auto& [name, milliseconds] : state.passes) ImGui::Text("%8.2f ms  %s", milliseconds, name.c_str());
  ImGui::Checkbox("draw all the time", &state.continuous);
}

void drawFacts(const PanelState& state) {
  ImGui::Separator();
  ImGui::TextWrapped("%s", state.sceneLine.c_str());
  ImGui::TextWrapped("%s", state.driverLine.c_str());
}

/// In the lower right corner, where no scrolling hides it.
void drawStatus(const PanelState& state) {
  if (state.busyLine.empty() && state.message.empty()) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float unit = ImGui::GetFontSize();
  ImGui::SetNextWindowPos(ImVec2(display.x - 0.5f * unit, display.y - 0.5f * unit), ImGuiCond_Always, ImVec2(1.0f, 1.0f));
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
  if (ImGui::Begin("status", nullptr, kFlags)) {
    ImGui::PushTextWrapPos(std::max(20.0f * unit, display.x - 28.0f * unit));
    if (!state.busyLine.empty()) ImGui::TextUnformatted(state.busyLine.c_str());
    const ImVec4 color = state.messageIsError ? ImVec4(1.0f, 0.45f, 0.4f, 1.0f) : ImVec4(0.6f, 0.9f, 0.6f, 1.0f);
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    if (!state.message.empty()) ImGui::TextUnformatted(state.message.c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

}  // namespace

void FrameHistory::add(float milliseconds) {
  if (values_.size() == kLength) values_.erase(values_.begin());
  values_.push_back(milliseconds);
}

PanelActions drawPanel(PanelState& state) {
  PanelActions actions;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float unit = ImGui::GetFontSize();
  ImGui::SetNextWindowPos(ImVec2(0.5f * unit, 0.5f * unit), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(25.0f * unit, std::max(10.0f * unit, display.y - unit)), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Chiaro")) {
    ImGui::PushItemWidth(14.0f * unit);
    drawLight(state, actions);
    drawLamps(state, actions);
    drawPicture(state, actions);
    drawCamera(state, actions);
    drawMaterials(state, actions);
    drawTimes(state);
    drawFacts(state);
    ImGui::PopItemWidth();
  }
  ImGui::End();
  drawStatus(state);
  return actions;
}

float exposureFactor(const PanelState& state, float autoExposure) {
  return (state.autoExposure ? autoExposure : 1.0f) * std::exp2(state.exposureStops);
}

}  // namespace chiaro
