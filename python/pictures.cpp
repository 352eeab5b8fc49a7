// Pictures for Python: arrays are views of the renderer's own memory, which lives as long as any of them.

#include <fmt/format.h>

#include "python/convert.h"
#include "python/rendered_picture.h"

namespace whit::python {
namespace {

/// A view that keeps `owner`, and cannot be written to: the picture stays what was rendered.
py::array view(const float* values, std::vector<py::ssize_t> shape, const py::object& owner) {
  py::array_t<float> array(std::move(shape), values, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::array pixels(const py::object& self) {
  const Picture& p = self.cast<const RenderedPicture&>().result.picture;
  return view(p.rgb.data(), {p.height(), p.width(), 3}, self);
}

/// Of what there is beside the colours.
py::dict layers(const py::object& self) {
  const RenderResult& result = self.cast<const RenderedPicture&>().result;
  py::dict out;
  for (const AovPicture::Channel& c : result.aovs.channels)
    out[text(c.name)] = view(c.values.data(), {result.picture.height(), result.picture.width()}, self);
  return out;
}

DisplayWish display_wish(const std::string& shown_by, const std::string& ocio, std::optional<double> exposure) {
  return {shown_by, ocio, exposure};
}

py::array display(const RenderedPicture& picture, const std::string& shown_by, const std::string& ocio,
                  std::optional<double> exposure) {
  const DisplayWish wish = display_wish(shown_by, ocio, exposure);
  auto bytes = [&] {
    const py::gil_scoped_release released;
    return std::make_unique<std::vector<uint8_t>>(display_values(picture, wish));
  }();
  const Picture& p = picture.result.picture;
  const uint8_t* const values = bytes->data();
  const py::capsule owner(bytes.release(), [](void* all) { delete static_cast<std::vector<uint8_t>*>(all); });
  return py::array_t<uint8_t>({p.height(), p.width(), 3}, values, owner);
}

py::list save_to(const RenderedPicture& picture, const std::string& path, const std::string& beside,
                 const std::string& shown_by, const std::string& ocio, std::optional<double> exposure,
                 bool full_float) {
  SaveWish wish;
  static_cast<DisplayWish&>(wish) = display_wish(shown_by, ocio, exposure);
  wish.path = path, wish.display = beside, wish.full_float = full_float;
  const std::vector<std::string> warnings = [&] {
    const py::gil_scoped_release released;
    return save(picture, wish);
  }();
  py::list out;
  for (const std::string& warning : warnings) out.append(text(warning));
  return out;
}

py::tuple window(const RenderedPicture& picture) {
  const Box2i& w = picture.result.picture.window;
  return py::make_tuple(w.min.x, w.min.y, w.max.x, w.max.y);
}

py::tuple resolution(const RenderedPicture& picture) {
  const Vec2i& size = picture.result.picture.resolution;
  return py::make_tuple(size.x, size.y);
}

py::object target(const RenderedPicture& picture) {
  return picture.target ? to_python(Json(*picture.target)) : py::object(py::none());
}

}  // namespace

void add_pictures(py::module_& module) {
  py::class_<RenderedPicture>(module, "Picture")
      .def("pixels", &pixels)
      .def("layers", &layers)
      .def("address", [](const RenderedPicture& p) { return reinterpret_cast<uintptr_t>(p.result.picture.rgb.data()); })
      .def("window", &window)
      .def("resolution", &resolution)
      .def("samples_per_pixel", [](const RenderedPicture& p) { return p.result.samples_per_pixel; })
      .def("complete", [](const RenderedPicture& p) { return p.result.complete; })
      .def("statistics", [](const RenderedPicture& p) { return to_python(Json(p.statistics)); })
      .def("target", &target)
      .def("said", [](const RenderedPicture& p) { return to_python(p.said); })
      .def("display", &display)
      .def("save", &save_to);
}

}  // namespace whit::python
