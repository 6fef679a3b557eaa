#pragma once
/// A light as a person names it on a command line.

#include <string>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

/// `KIND[,KEY=NUMBERS]...`, KIND one of sun, point, spot, sphere, disk. Keys, each at most once:
///
///   at=X,Y,Z          metres; needed but for the sun
///   direction=X,Y,Z   the way the light travels, or
///   target=X,Y,Z      a point in it; one of both is needed for sun (seen from the origin), spot and disk
///   radius=R          metres, 0 or more (sphere and disk, where it is needed)
///   angle-deg=A       angular radius, 0 to 90 (sun; 0 where left out)
///   intensity=I       or I,I,I for red, green and blue: lux of the sun, candela of the others, 0 or more; 1 where left out
///   cone-deg=I,O      inner and outer cone, 0 <= I < O <= 90 (spot: 0,45 where left out; disk: all that is in front of it)
///   range=R           metres, above 0 (not the sun)
///
/// Throws Error (usage), whose `where` is `option`.
Light parseLightSpec(const std::string& text, const std::string& option = "--light");

/// The text that parses to this light (but for its name and rounding).
std::string lightSpec(const Light& light);

}  // namespace chiaro
