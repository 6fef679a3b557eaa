#pragma once
/// The reflectance models a material may ask for by CHIARO_materials_reflectance (docs/format.md).

#include <optional>
#include <string>
#include <vector>

namespace chiaro {

/// Of the specular part; what each is: shaders/lobe/ndf.glsl.
enum class Reflectance { ggx, cookTorrance, beckmann, blinnPhong, ward, ashikhminShirley };
inline constexpr int kReflectanceCount = 6;

/// As files and options spell them, in the order of Reflectance.
const std::vector<std::string>& reflectanceNames();
/// All of them in one line, for messages and help.
std::string reflectanceNameList();
std::optional<Reflectance> reflectanceFromName(const std::string& name);

/// Whether a width is the exponent of a cosine: Blinn-Phong, Ashikhmin-Shirley.
constexpr bool hasExponent(Reflectance r) { return r == Reflectance::blinnPhong || r == Reflectance::ashikhminShirley; }
/// Whether there is one width for all directions: Cook-Torrance, Blinn-Phong.
constexpr bool isRound(Reflectance r) { return r == Reflectance::cookTorrance || r == Reflectance::blinnPhong; }

inline constexpr float kLeastWidth = 1e-4f, kMostWidth = 1.0f;
inline constexpr float kLeastExponent = 1.0f, kMostExponent = 1e6f;

/// A roughness width alpha and the exponent that stands for it, n = 2 / alpha^2 - 2.
float alphaFromExponent(float exponent);
float exponentFromAlpha(float alpha);

}  // namespace chiaro
