// The one place that knows which Embree there is: versions 3 and 4 differ in how a query takes its options.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace plumb {

enum class RayCoherence { coherent, incoherent };

#if RTC_VERSION_MAJOR >= 4

inline RTCRayQueryFlags embree_flags(RayCoherence coherence) {
    return coherence == RayCoherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}

inline void embree_intersect(RTCScene scene, RTCRayHit& ray, RayCoherence coherence) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = embree_flags(coherence);
    rtcIntersect1(scene, &ray, &arguments);
}

inline void embree_occluded(RTCScene scene, RTCRay& ray, RayCoherence coherence) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = embree_flags(coherence);
    rtcOccluded1(scene, &ray, &arguments);
}

#else

inline RTCIntersectContext embree_context(RayCoherence coherence) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherence == RayCoherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                        : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

inline void embree_intersect(RTCScene scene, RTCRayHit& ray, RayCoherence coherence) {
    RTCIntersectContext context = embree_context(coherence);
    rtcIntersect1(scene, &context, &ray);
}

inline void embree_occluded(RTCScene scene, RTCRay& ray, RayCoherence coherence) {
    RTCIntersectContext context = embree_context(coherence);
    rtcOccluded1(scene, &context, &ray);
}

#endif

}  // namespace plumb
