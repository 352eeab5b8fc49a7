#include "core/accel/device.h"

#include <utility>

#include "core/accel/built_mesh.h"

namespace whit {

std::shared_ptr<AccelDevice> make_accel_device(const std::string& config) {
  return std::make_shared<AccelDevice>(config);
}

std::shared_ptr<BuiltMesh> build_mesh(std::shared_ptr<AccelDevice> device, const MeshView& mesh,
                                      std::shared_ptr<const void> owner, bool robust) {
  return std::make_shared<BuiltMesh>(std::move(device), mesh, std::move(owner), robust);
}

}  // namespace whit
