#pragma once
/// Reflectance as data or as somebody's formula gives it.

#include <functional>
#include <string>

#include "assets/image/image.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {

/// rho(wo, wi), 1/sr by channel, of a round material: unit directions in the tangent frame (z normal). NaN in every channel where the data say
/// nothing.
using ReflectanceFunction = std::function<lobe64::Vec3(const lobe64::Vec3& wo, const lobe64::Vec3& wi)>;

}  // namespace chiaro
