// Embree's device: what it is asked for, what it says, and how much memory it takes. Ray tracers may share one.
#pragma once

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <string>
#include <utility>

#include "core/accel/embree_geometry.h"
#include "core/plugin/memory_limit.h"

namespace whit {

class AccelDevice {
 public:
  explicit AccelDevice(const std::string& config) : device_(rtcNewDevice(config.empty() ? nullptr : config.c_str())) {
    if (!device_) throw OutOfMemory("the ray tracer's library does not start");
    rtcSetDeviceErrorFunction(
        device_,
        [](void* self, RTCError code, const char* text) {
          static_cast<AccelDevice*>(self)->note(code, text ? text : "unknown");
        },
        this);
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* self, ssize_t change, bool) {
          static_cast<AccelDevice*>(self)->bytes += change;
          return true;
        },
        this);
  }
  ~AccelDevice() { rtcReleaseDevice(device_); }
  AccelDevice(const AccelDevice&) = delete;
  AccelDevice& operator=(const AccelDevice&) = delete;

  RTCDevice get() const { return device_; }
  bool can(RTCDeviceProperty property) const { return rtcGetDeviceProperty(device_, property) != 0; }
  RTCScene new_scene(bool robust) const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    set_flags(scene, robust, RTC_SCENE_FLAG_NONE);
    return scene;
  }
  static void set_flags(RTCScene scene, bool robust, RTCSceneFlags flags) {
    rtcSetSceneFlags(scene, robust ? flags | RTC_SCENE_FLAG_ROBUST : flags);
  }
  /// Triangles, to be committed and attached.
  RTCGeometry new_mesh(const MeshView& mesh, GeometryUser& user) const {
    RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions, 0, 3 * sizeof(float),
                               mesh.vertex_count);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices, 0, 3 * sizeof(uint32_t),
                               mesh.triangle_count);
    user.mesh = mesh;
    rtcSetGeometryUserData(g, &user);
    return g;
  }
  /// Of what Embree was asked since the last call; "" when all went well. Throws OutOfMemory where that was it.
  std::string problem() {
    const RTCError code = rtcGetDeviceError(device_);
    const std::lock_guard lock(mutex_);
    const std::string error = std::exchange(error_, {});
    if (std::exchange(out_of_memory_, false) || code == RTC_ERROR_OUT_OF_MEMORY)
      throw OutOfMemory("the ray tracer has not enough memory");
    if (code == RTC_ERROR_NONE && error.empty()) return {};
    return fmt::format("the ray tracer could not be built: {}", error.empty() ? "unknown error" : error);
  }

  std::atomic<ssize_t> bytes{0};

 private:
  /// Meshes are built on several threads.
  void note(RTCError code, const char* text) {
    const std::lock_guard lock(mutex_);
    error_ = text;
    // What follows it may be called by another name.
    out_of_memory_ = out_of_memory_ || code == RTC_ERROR_OUT_OF_MEMORY;
  }

  RTCDevice device_;
  std::mutex mutex_;
  std::string error_;
  bool out_of_memory_ = false;
};

}  // namespace whit
