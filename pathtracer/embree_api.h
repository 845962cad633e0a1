// The one place that knows which Embree there is: versions 3 and 4 differ in how a query takes its options.
#pragma once

#include <span>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace plumb {

enum class RayCoherence { coherent, incoherent };

#if RTC_VERSION_MAJOR >= 4

constexpr RTCSceneFlags filter_per_query = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
using EmbreeContext = RTCRayQueryContext;

#else

constexpr RTCSceneFlags filter_per_query = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
using EmbreeContext = RTCIntersectContext;

#endif

// The options of queries; made once for many rays.
class EmbreeQuery {
public:
    // `filter` is asked about every hit of scenes built with filter_per_query, and may ask user_of() back.
    explicit EmbreeQuery(RayCoherence coherence, RTCFilterFunctionN filter = nullptr, const void* user = nullptr) {
        context_.user = user;
#if RTC_VERSION_MAJOR >= 4
        rtcInitRayQueryContext(&context_);
        rtcInitIntersectArguments(&intersect_);
        rtcInitOccludedArguments(&occluded_);
        unsigned flags =
            coherence == RayCoherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
        if (filter) flags |= RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
        intersect_.flags = occluded_.flags = static_cast<RTCRayQueryFlags>(flags);
        intersect_.context = occluded_.context = &context_;
        intersect_.filter = occluded_.filter = filter;
#else
        rtcInitIntersectContext(&context_);
        context_.flags = coherence == RayCoherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                             : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        context_.filter = filter;
#endif
    }
    EmbreeQuery(const EmbreeQuery&) = delete;
    EmbreeQuery& operator=(const EmbreeQuery&) = delete;

    static const void* user_of(const RTCFilterFunctionNArguments* arguments) {
        return static_cast<const Context*>(arguments->context)->user;
    }

#if RTC_VERSION_MAJOR >= 4
    void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_); }
    void intersect(RTCScene scene, const int* valid, RTCRayHit4& rays) {
        rtcIntersect4(valid, scene, &rays, &intersect_);
    }
    void intersect(RTCScene scene, const int* valid, RTCRayHit8& rays) {
        rtcIntersect8(valid, scene, &rays, &intersect_);
    }
    void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
        rtcIntersect16(valid, scene, &rays, &intersect_);
    }
    void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_); }
    void occluded(RTCScene scene, const int* valid, RTCRay4& rays) { rtcOccluded4(valid, scene, &rays, &occluded_); }
    void occluded(RTCScene scene, const int* valid, RTCRay8& rays) { rtcOccluded8(valid, scene, &rays, &occluded_); }
    void occluded(RTCScene scene, const int* valid, RTCRay16& rays) { rtcOccluded16(valid, scene, &rays, &occluded_); }
#else
    void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
    void intersect(RTCScene scene, const int* valid, RTCRayHit4& rays) {
        rtcIntersect4(valid, scene, &context_, &rays);
    }
    void intersect(RTCScene scene, const int* valid, RTCRayHit8& rays) {
        rtcIntersect8(valid, scene, &context_, &rays);
    }
    void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
        rtcIntersect16(valid, scene, &context_, &rays);
    }
    void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context_, &ray); }
    void occluded(RTCScene scene, const int* valid, RTCRay4& rays) { rtcOccluded4(valid, scene, &context_, &rays); }
    void occluded(RTCScene scene, const int* valid, RTCRay8& rays) { rtcOccluded8(valid, scene, &context_, &rays); }
    void occluded(RTCScene scene, const int* valid, RTCRay16& rays) { rtcOccluded16(valid, scene, &context_, &rays); }
    // Streams, which version 4 has no more.
    void intersect(RTCScene scene, std::span<RTCRayHit> rays) {
        rtcIntersect1M(scene, &context_, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRayHit));
    }
    void occluded(RTCScene scene, std::span<RTCRay> rays) {
        rtcOccluded1M(scene, &context_, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRay));
    }
#endif

private:
    struct Context : EmbreeContext {
        const void* user = nullptr;
    };

    Context context_;
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments intersect_;
    RTCOccludedArguments occluded_;
#endif
};

}  // namespace plumb
