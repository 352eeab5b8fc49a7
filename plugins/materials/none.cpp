// A surface that is not there: rays pass on unchanged. It still blocks shadow rays, as in pbrt-v3.
#include "core/plugin/material.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

struct None : Material {
  bool is_interface() const override { return true; }
  void lobes(const ShadingBatch& /*s*/, LobeSet& /*out*/) const override {}
};

const Register<None> none{std::vector<std::string>{""}, "none", "No surface: rays pass on unchanged."};

}  // namespace
}  // namespace whit
