#pragma once
/// Embree 3 (Debian 12) and Embree 4 (Debian 13) behind one spelling: the only file that knows which one it is.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace chiaro::embree {

#if RTC_VERSION_MAJOR >= 4

inline void intersect1(RTCScene scene, RTCRayHit& rayHit) { rtcIntersect1(scene, &rayHit); }

inline void occluded1(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }

/// The rays share an origin and neighbouring directions, which Embree wants to be told.
inline void occluded16(const int* valid, RTCScene scene, RTCRay16& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &rays, &arguments);
}

#else

inline void intersect1(RTCScene scene, RTCRayHit& rayHit) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &rayHit);
}

inline void occluded1(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}

/// The rays share an origin and neighbouring directions, which Embree wants to be told.
inline void occluded16(const int* valid, RTCScene scene, RTCRay16& rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &context, &rays);
}

#endif

}  // namespace chiaro::embree
