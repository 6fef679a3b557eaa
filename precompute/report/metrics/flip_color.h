#pragma once
/// The colour spaces of FLIP (Andersson et al. 2020). Linear Rec.709 in, white at XYZ of (1,1,1).

#include <glm/glm.hpp>

namespace chiaro::flip {

/// Luminance and opponent colours, linear in XYZ: CIELAB without its cube root. In this space the contrast sensitivity filters work.
glm::dvec3 yCxCzFromLinear(const glm::dvec3& rgb);
glm::dvec3 linearFromYCxCz(const glm::dvec3& yCxCz);

/// CIELAB with a and b times L / 100 (Hunt: colours look stronger where it is bright).
glm::dvec3 huntLabFromLinear(const glm::dvec3& rgb);

/// |difference in L| plus the distance in (a, b) (Abasi et al. 2020), to the power .7.
double colorDistance(const glm::dvec3& huntLab, const glm::dvec3& otherHuntLab);

/// colorDistance to [0,1]: up to .4 of the largest distance (that of green and blue) takes the range up to .95.
double remappedDistance(double distance);

}  // namespace chiaro::flip
