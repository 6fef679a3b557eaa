#pragma once
/// What the older way costs: the best factorisation of rho (n.wi)(n.wo) into K products of a function of light and one of view (equation (10)).

#include <functional>
#include <vector>

#include "shaders/cpp/lobe.h"

namespace chiaro {

/// Squared relative error (equation (11)) of the optimal factorisation with each number of terms, views from the normal to `widest` radians.
/// A round model is diagonal in azimuth frequencies: one SVD each, all singular values sorted; `polar` Gauss nodes by `azimuths`. Others are mirrored in
/// two planes: four SVDs. Too coarse a grid for a lobe makes its error too small.
std::vector<double> factorisationErrors(const lobe64::ReflectanceModel& model, double widest, int polar, int azimuths,
                                        const std::vector<int>& terms);

/// rho (n.wi) of a round reflectance; may be NaN, which counts as 0.
using RoundReflectance = std::function<double(const lobe64::Vec3& wo, const lobe64::Vec3& wi)>;

/// The same for any round reflectance, both directions from the normal to `widest` radians.
std::vector<double> factorisationErrors(const RoundReflectance& timesCosine, double widest, int polar, int azimuths, const std::vector<int>& terms);

}  // namespace chiaro
