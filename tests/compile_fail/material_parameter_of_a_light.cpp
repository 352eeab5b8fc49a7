// error: only a material has materials as parameters
// Names of materials are resolved where materials are made, and nowhere else.
#include "core/plugin/light.h"
#include "core/plugin/material.h"
#include "core/plugin/registry.h"

struct Lamp : whit::Light {
  std::shared_ptr<whit::Material> glass;
  void sample(const whit::LightSamples&) const override {}
};

const whit::Register<Lamp> lamp{"lamp", "A light with a material.",
                                whit::param(&Lamp::glass, "glass", whit::Unit::None, "Its glass.")};
