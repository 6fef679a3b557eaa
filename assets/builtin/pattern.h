#pragma once
/// Textures made by code: seamless patterns over (u, v) in [0,1]^2, v downwards as texture coordinates go.

#include <functional>
#include <glm/glm.hpp>

#include "assets/scene/scene.h"

namespace chiaro::builtin {

/// Smooth noise in about [-1,1] that repeats after 1 in both coordinates, with `cells` bumps a side.
double periodicNoise(glm::dvec2 uv, int cells, std::uint32_t seed);

/// `octaves` of it, each twice as fine and half as strong; in about [-1,1].
double periodicTurbulence(glm::dvec2 uv, int cells, int octaves, std::uint32_t seed);

/// 1 within `halfWidth` of the nearest multiple of 1, 0 beyond halfWidth + blur, smooth between.
double stripe(double x, double halfWidth, double blur);

/// Adds a PNG of `size` squared texels and a repeating texture of it; returns the texture's index.
/// Colour: linear in, sRGB-encoded in the file. Data: stored as it is. Values are clamped to [0,1].
int addColorTexture(Scene& scene, const std::string& name, int size, const std::function<glm::dvec3(glm::dvec2 uv)>& color);
int addDataTexture(Scene& scene, const std::string& name, int size, const std::function<glm::dvec3(glm::dvec2 uv)>& data);

/// A tangent-space normal map (+Y up the image) of a height field. `height` and the patch's size along u and v in the same unit.
int addNormalTexture(Scene& scene, const std::string& name, int size, glm::dvec2 patchSize,
                     const std::function<double(glm::dvec2 uv)>& height);

}  // namespace chiaro::builtin
