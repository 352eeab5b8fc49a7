// Embree 3 or 4, whichever CMake found: the differences, and nothing else.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace whit {

/// One thread's queries with one coherence hint.
class EmbreeQuery {
 public:
#if RTC_VERSION_MAJOR >= 4
  explicit EmbreeQuery(bool coherent) {
    const RTCRayQueryFlags flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    intersect_.flags = flags;
    occluded_.flags = flags;
  }
  void intersect16(const int* valid, RTCScene scene, RTCRayHit16& packet) {
    rtcIntersect16(valid, scene, &packet, &intersect_);
  }
  void occluded16(const int* valid, RTCScene scene, RTCRay16& packet) {
    rtcOccluded16(valid, scene, &packet, &occluded_);
  }

 private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
#else
  explicit EmbreeQuery(bool coherent) {
    rtcInitIntersectContext(&context_);
    context_.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
  void intersect16(const int* valid, RTCScene scene, RTCRayHit16& packet) {
    rtcIntersect16(valid, scene, &context_, &packet);
  }
  void occluded16(const int* valid, RTCScene scene, RTCRay16& packet) {
    rtcOccluded16(valid, scene, &context_, &packet);
  }

 private:
  RTCIntersectContext context_;
#endif
};

}  // namespace whit
