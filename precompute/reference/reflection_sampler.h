#pragma once
/// Directions of light drawn as a surface reflects: from the reflection, the coat or the cosine, one of them at random. Tangent frame, as reference/brdf.h.

#include "precompute/reference/brdf.h"

namespace chiaro::reference {

class ReflectionSampler {
 public:
  /// Keeps a reference to `brdf`. The rest of both shares goes to the cosine.
  ReflectionSampler(const Brdf& brdf, glm::dvec3 wo, double reflectionShare, double coatShare)
      : brdf_(brdf), wo_(wo), reflectionShare_(reflectionShare * (1.0 - coatShare)), coatShare_(coatShare) {}

  /// choice in (0,1), random in (0,1)^2.
  glm::dvec3 sample(double choice, glm::dvec2 random) const {
    if (choice < reflectionShare_) return sampleReflection(brdf_, wo_, random);
    return choice < reflectionShare_ + coatShare_ ? sampleCoat(brdf_, wo_, random) : sampleCosine(random);
  }

  /// Per steradian.
  double density(glm::dvec3 wi) const {
    const double density = reflectionShare_ * reflectionDensity(brdf_, wo_, wi) + (1.0 - reflectionShare_ - coatShare_) * cosineDensity(wi);
    return coatShare_ > 0.0 ? density + coatShare_ * coatDensity(brdf_, wo_, wi) : density;
  }

 private:
  const Brdf& brdf_;
  glm::dvec3 wo_;
  double reflectionShare_, coatShare_;
};

}  // namespace chiaro::reference
