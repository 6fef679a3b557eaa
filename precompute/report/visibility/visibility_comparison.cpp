#include "precompute/report/visibility/visibility_comparison.h"

#include "precompute/report/visibility/haar_method.h"
#include "precompute/report/visibility/map_methods.h"
#include "precompute/report/visibility/sh_method.h"
#include "precompute/report/visibility/visibility_study.h"

namespace chiaro {
std::vector<std::unique_ptr<VisibilityMethod>> baselineMethods(const VisibilityInput& input) {
  auto methods = makeShMethods(input, {5, 7, 10});
  for (auto& method : makeHaarMethods(input, {24, 48, 96})) methods.push_back(std::move(method));
  const OctahedralGrid grid(input.resolution);
  const TracedVertices traced(input, grid);
  for (const auto& kind : {binaryVisibility(), ssdfWithHorizon(), ssdfOfOccluders()})
    methods.push_back(makePcaMethod(input, traced, kind));
  methods.push_back(makeUncompressedMethod(input, traced, ssdfOfOccluders()));
  methods.push_back(makeUnoccludedMethod());
  return methods;
}

VisibilityComparison compareVisibility(const VisibilityStudy& study, const MethodMaker& makeMethods, const ProgressHandler& progress) {
  if (progress) progress("methods", 0.0);
  const auto methods = makeMethods(study.input());
  std::vector<const VisibilityMethod*> asked;
  for (const auto& method : methods) asked.push_back(method.get());
  auto result = study.facts();
  result.methods = study.errorsOf(asked, progress);
  return result;
}

VisibilityComparison compareVisibility(const Scene& scene, const MethodMaker& makeMethods, const VisibilitySettings& settings, const ProgressHandler& progress) {
  return compareVisibility(VisibilityStudy(scene, settings, progress), makeMethods, progress);
}

}  // namespace chiaro
