#pragma once
/// The microfacet model whose distribution is nearest to one that is given.

#include <functional>

namespace chiaro {

struct NdfWidth {
  int kind = 0;        ///< kCookTorrance .. kAshikhminShirley
  double width = 0.1;  ///< as FitFamily takes it
  double scale = 1.0;  ///< times the model's distribution of peak 1
  double error = 0.0;  ///< root of the squared difference over the hemisphere, by that of the distribution
};

/// Width and scale of least L2 error over the hemisphere; the scale follows from the width. `ndf` as for fitNdfMixture.
NdfWidth fitNdfWidth(int kind, const std::function<double(double)>& ndf);

}  // namespace chiaro
