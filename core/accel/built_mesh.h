// A mesh with an Embree scene of its own, which outlives the ray tracers that have it.
#pragma once

#include <memory>

#include "core/accel/device.h"

namespace whit {

class BuiltMesh {
 public:
  BuiltMesh(std::shared_ptr<AccelDevice> device, const MeshView& mesh, std::shared_ptr<const void> owner, bool robust)
      : device_(std::move(device)), owner_(std::move(owner)), scene_(device_->new_scene(robust)), robust_(robust) {
    RTCGeometry g = device_->new_mesh(mesh, user_);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(scene_, g, 0);
    rtcReleaseGeometry(g);
    rtcCommitScene(scene_);
  }
  ~BuiltMesh() { rtcReleaseScene(scene_); }
  BuiltMesh(const BuiltMesh&) = delete;
  BuiltMesh& operator=(const BuiltMesh&) = delete;

  RTCScene scene() const { return scene_; }
  size_t triangle_count() const { return user_.mesh.triangle_count; }

  /// Accel::watch_ends(), once and for all.
  void watch_ends() {
    if (watches_) return;
    watches_ = true;
    AccelDevice::set_flags(scene_, robust_, kQueryFilter);
    rtcCommitGeometry(rtcGetGeometry(scene_, 0));
    rtcCommitScene(scene_);
  }

 private:
  std::shared_ptr<AccelDevice> device_;
  std::shared_ptr<const void> owner_;
  RTCScene scene_;
  GeometryUser user_;
  bool robust_ = true, watches_ = false;
};

}  // namespace whit
