// error: no matching (function|constructor)
// The category of a plugin follows from its base, so that a material cannot be registered as a light.
#include "core/plugin/material.h"
#include "core/plugin/registry.h"

struct Glow : whit::Material {
  void lobes(const whit::ShadingBatch&, whit::LobeSet&) const override {}
};

const whit::Register<Glow> glow{"light", "glow", "A material under a light's name."};
