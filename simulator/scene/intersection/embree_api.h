#pragma once

/// Embree 3 or 4, whichever SaccadeDependencies.cmake found and states as SACCADE_EMBREE_MAJOR.
/// Version 4 hands the flags of a query, and the query to the filter, by other structures than
/// version 3; every other name that is used here is the same in both.
#if SACCADE_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace saccade::embree {

/// Whether the rays of a packet are expected to take the same path through the tree: a matter of
/// speed alone.
enum class Coherence { kCoherent, kIncoherent };

/// One query of a packet of rays. A filter finds it again by query_of(), so that a class derived from it
/// carries what the filter needs.
struct Query {
#if SACCADE_EMBREE_MAJOR >= 4
  RTCRayQueryContext context;  ///< first, so that its address is that of the query
  RTCRayQueryFlags flags;

  explicit Query(Coherence coherence)
      : flags(coherence == Coherence::kCoherent ? RTC_RAY_QUERY_FLAG_COHERENT
                                                : RTC_RAY_QUERY_FLAG_INCOHERENT) {
    rtcInitRayQueryContext(&context);
  }
#else
  RTCIntersectContext context;  ///< first, so that its address is that of the query

  explicit Query(Coherence coherence) {
    rtcInitIntersectContext(&context);
    context.flags = coherence == Coherence::kCoherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                      : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
#endif
};

/// The nearest hit of the rays with `valid` -1; `valid`: 16, aligned to 64 bytes.
inline void intersect16(const int* valid, RTCScene scene, Query& query, RTCRayHit16& packet) {
#if SACCADE_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = query.flags;
  arguments.context = &query.context;
  rtcIntersect16(valid, scene, &packet, &arguments);
#else
  rtcIntersect16(valid, scene, &query.context, &packet);
#endif
}

/// Sets tfar of the blocked rays to minus infinity; `valid`: 16, aligned to 64 bytes.
inline void occluded16(const int* valid, RTCScene scene, Query& query, RTCRay16& packet) {
#if SACCADE_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = query.flags;
  arguments.context = &query.context;
  rtcOccluded16(valid, scene, &packet, &arguments);
#else
  rtcOccluded16(valid, scene, &query.context, &packet);
#endif
}

/// The query that a filter was called for.
[[nodiscard]] inline const Query& query_of(const RTCFilterFunctionNArguments& arguments) {
  return *reinterpret_cast<const Query*>(arguments.context);
}

}  // namespace saccade::embree
