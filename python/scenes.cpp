// Scenes and renders for Python. Arguments come as dicts, which the package's functions have checked.

#include <memory>

#include "python/convert.h"
#include "python/kept_scene.h"
#include "python/plan_wish.h"

namespace whit::python {
namespace {

void take_plan(const py::dict& from, PlanWish& to) {
  Overrides& o = to.overrides;
  take(from, "integrator", o.integrator), take(from, "sampler", o.sampler);
  take(from, "lights", o.lights), take(from, "texture_filter", o.texture_filter);
  if (from.contains("maxdepth") && !from["maxdepth"].is_none()) o.max_depth = from["maxdepth"].cast<int>();
  if (from.contains("rrthreshold") && !from["rrthreshold"].is_none())
    o.rr_threshold = from["rrthreshold"].cast<double>();
  if (from.contains("without") && !from["without"].is_none())
    to.without = from["without"].cast<std::vector<std::string>>();
  if (from.contains("only") && !from["only"].is_none()) to.only = from["only"].cast<std::vector<std::string>>();
}

template <class T>
void take_optional(const py::dict& from, const char* key, std::optional<T>& to) {
  if (from.contains(key) && !from[key].is_none()) to = from[key].cast<T>();
}

SceneWish scene_wish(const py::dict& from) {
  SceneWish to;
  take_plan(from, to);
  take(from, "world", to.world), take(from, "spp", to.spp), take(from, "footprint_spp", to.footprint_spp);
  take(from, "seed", to.seed), take(from, "quick", to.quick), take(from, "strict", to.strict);
  take(from, "keep_going", to.keep_going), take(from, "texture_memory", to.texture_memory);
  take(from, "extending", to.extending), take(from, "fast_traversal", to.fast_traversal);
  to.model = model_wish(from);
  return to;
}

RenderWish render_wish(const py::dict& from) {
  RenderWish to;
  take_optional(from, "camera", to.camera), take_optional(from, "crop", to.crop);
  std::optional<std::array<int, 2>> resolution;
  take_optional(from, "resolution", resolution);
  if (resolution) to.resolution = Vec2i((*resolution)[0], (*resolution)[1]);
  take_optional(from, "spp", to.spp), take_optional(from, "seed", to.seed);
  take(from, "aovs", to.aovs), take(from, "threads", to.threads);
  take(from, "target_error", to.goal.error), take(from, "confidence", to.goal.confidence);
  take(from, "time_limit", to.time_limit), take(from, "max_samples", to.max_samples);
  take(from, "command", to.command);
  return to;
}

using PicturePtr = std::unique_ptr<RenderedPicture>;

PicturePtr render(const SceneSource& source, const py::dict& scene, const py::dict& wish, const py::object& progress) {
  const SceneWish built_with = scene_wish(scene);
  const RenderWish rendered_with = render_wish(wish);
  return wait_for(
      [&](Attention& attention) {
        return KeptScene(source, built_with, rendered_with).render(rendered_with, attention);
      },
      progress);
}

std::unique_ptr<KeptScene> keep(const SceneSource& source, const py::dict& scene) {
  const SceneWish built_with = scene_wish(scene);
  return wait_for([&](Attention&) { return std::make_unique<KeptScene>(source, built_with, RenderWish()); },
                  py::none());
}

PicturePtr render_kept(KeptScene& scene, const py::dict& wish, const py::object& progress) {
  const RenderWish rendered_with = render_wish(wish);
  return wait_for([&](Attention& attention) { return scene.render(rendered_with, attention); }, progress);
}

}  // namespace

PlanWish plan_wish(const py::dict& from) {
  PlanWish to;
  take_plan(from, to);
  return to;
}

ModelWish model_wish(const py::dict& from) {
  ModelWish to;
  take(from, "model_scene", to.scene), take(from, "model_camera", to.camera), take(from, "model_variant", to.variant);
  take_optional(from, "model_time", to.time);
  take(from, "allow_outside", to.allow_outside);
  return to;
}

void add_scenes(py::module_& module) {
  py::class_<SceneSource>(module, "Source").def(py::init([](const std::string& path, const py::object& given) {
    SceneSource source{path, {}};
    if (!given.is_none()) source.text = given.cast<std::string>();
    return source;
  }));
  py::class_<KeptScene>(module, "Scene")
      .def(py::init(&keep))
      .def("render", &render_kept)
      .def("camera", &KeptScene::camera)
      .def("resolution",
           [](const KeptScene& scene) { return py::make_tuple(scene.resolution().x, scene.resolution().y); })
      .def("samples_per_pixel", &KeptScene::samples_per_pixel)
      .def("said", [](const KeptScene& scene) { return to_python(scene.said()); });
  module.def("render", &render);
}

}  // namespace whit::python
