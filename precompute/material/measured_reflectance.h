#pragma once
/// Reflectance as data or as somebody's formula gives it.

#include <functional>
#include <string>

#include "shaders/cpp/lobe.h"

namespace chiaro {

/// rho(wo, wi), 1/sr by channel, of a round material: unit directions in the tangent frame (z normal). NaN in every channel where the data say
/// nothing.
using ReflectanceFunction = std::function<lobe64::Vec3(const lobe64::Vec3& wo, const lobe64::Vec3& wi)>;

/// Rec.709.
inline double luminance(const lobe64::Vec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

}  // namespace chiaro
