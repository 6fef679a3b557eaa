#pragma once
/// The fitted tables of the reflectance models that a scene has, in one texture array for shaders/stage/models.glsl.

#include "runtime/gl/texture.h"
#include "runtime/render/material_features.h"

namespace chiaro {

/// Layers of one model but GGX: those of ReflectanceTable, then its albedo (what F0 scales, what Fresnel adds; unused).
inline constexpr int kReflectanceLayers = 9;

/// The fitted table of GGX, which every scene may need, in a texture array. A second or two, once a process.
gl::Texture makeGgxTexture();

/// In the order of MaterialFeatures::tablePlace(). An empty texture where there is no model. Some seconds a model, once a process.
gl::Texture makeReflectanceTextures(const MaterialFeatures& features);

}  // namespace chiaro
