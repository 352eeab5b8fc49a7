// Comparisons of pictures for Python.

#include <fmt/format.h>

#include <cmath>

#include "core/compare/compare.h"
#include "core/compare/comparison_json.h"
#include "core/compare/heatmap.h"
#include "core/compare/measures.h"
#include "core/compare/report_page.h"
#include "core/compare/settings.h"
#include "python/convert.h"
#include "python/rendered_picture.h"

namespace whit::python {
namespace {

/// The two pictures, and what they differ by.
struct Compared {
  PicturePair pair;
  Comparison comparison;
  Limits limits;
};

/// One of the two: a file, or planes in memory.
struct Operand {
  std::string name;
  std::optional<PicturePlanes> planes;
};

/// Of bytes (a path), a Picture, or an array of float32, height x width x channels, without gaps.
Operand operand(const py::object& from, const std::string& name) {
  if (py::isinstance<py::bytes>(from)) return {from.cast<std::string>(), {}};
  if (py::isinstance<RenderedPicture>(from)) return {name, planes_of(from.cast<const RenderedPicture&>())};
  const auto array = from.cast<py::array_t<float, py::array::c_style>>();
  return {name, planes_of(ArrayView{array.data(), static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)),
                                    static_cast<int>(array.shape(2))})};
}

/// Each limit in the words of the command, which says what is wrong with them.
void take_limits(const py::dict& from, bool below, CompareSettings& said) {
  Limits limits;
  for (const auto& [name, value] : from) {
    const std::string word = fmt::format("{}={}", name.cast<std::string>(), value.cast<double>());
    if (const std::string problem = add_limit(word, below, limits); !problem.empty())
      throw Failure(FailureKind::Usage, fmt::format("{}: {}", below ? "fail_below" : "fail_above", problem));
  }
  said.limits.insert(limits.of.begin(), limits.of.end());
}

template <class T>
void take_said(const py::dict& from, const char* key, std::optional<T>& to) {
  if (from.contains(key) && !from[key].is_none()) to = from[key].cast<T>();
}

CompareRequest request_of(const py::dict& from) {
  CompareSettings said;
  take_limits(from["fail_above"], false, said);
  take_limits(from["fail_below"], true, said);
  take_said(from, "hard_fail", said.hard_fail), take_said(from, "fail_pixels", said.fail_pixels);
  take_said(from, "pixel_error", said.pixel_error), take_said(from, "exact", said.exact);
  take_said(from, "allow_nonfinite", said.allow_nonfinite), take_said(from, "noise", said.noise);
  take_said(from, "alpha", said.alpha), take_said(from, "channels", said.channels);
  take_said(from, "colour_space", said.colour_space);
  CompareRequest request;
  said.apply(request);
  take(from, "measures", request.slow);
  for (const std::string& name : request.slow) {
    if (!find_measure(name)) throw Failure(FailureKind::Usage, fmt::format("measures: there is no \"{}\"", name));
  }
  if (from.contains("crop") && !from["crop"].is_none()) {
    const auto c = from["crop"].cast<std::array<int, 4>>();
    request.pair.crop = true;
    request.pair.window = {{c[0], c[2]}, {c[1] - 1, c[3] - 1}};
  }
  return request;
}

PicturePlanes read(const std::string& path) {
  Result<PicturePlanes> planes = read_planes(path);
  if (!planes.ok()) throw Failure(FailureKind::File, planes.error);
  return std::move(planes.value);
}

std::unique_ptr<Compared> compare_operands(Operand a, Operand b, const CompareRequest& request) {
  auto out = std::make_unique<Compared>();
  out->limits = request.limits;
  if (!a.planes && !b.planes) {
    out->comparison = compare_files(a.name, b.name, request, &out->pair);
  } else {
    PairRequest reading = request.pair;
    reading.statistics |= request.limits.exact;
    for (Operand* one : {&a, &b})
      if (!one->planes) one->planes = read(one->name);
    Result<PicturePair> pair = make_pair_of(std::move(*a.planes), std::move(*b.planes), a.name, b.name, reading);
    if (!pair.ok()) throw Failure(FailureKind::File, pair.error);
    out->pair = std::move(pair.value);
    out->comparison = compare_pair(out->pair, request);
  }
  if (!out->comparison.cannot.empty()) throw Failure(FailureKind::File, out->comparison.cannot);
  return out;
}

std::unique_ptr<Compared> compare(const py::object& a, const py::object& b, const py::dict& options) {
  const CompareRequest request = request_of(options);
  Operand first = operand(a, "a"), second = operand(b, "b");
  return wait_for([&](Attention&) { return compare_operands(std::move(first), std::move(second), request); },
                  py::none());
}

void save_heatmap(const Compared& compared, const std::string& path, bool is_signed, double full) {
  const py::gil_scoped_release released;
  const std::string problem =
      write_heatmap(path, compared.pair, is_signed ? HeatSign::Signed : HeatSign::Absolute, full);
  if (!problem.empty()) throw Failure(FailureKind::File, problem);
}

py::str page(const Compared& compared, const std::string& title) {
  const std::string html = [&] {
    const py::gil_scoped_release released;
    ReportPage all;
    all.add(compared.comparison, &compared.pair);
    return all.html(title);
  }();
  return text(html);
}

py::list failures(const Compared& compared) {
  py::list out;
  for (const whit::Failure& f : compared.comparison.failed) out.append(text(failure_text(f)));
  return out;
}

std::vector<std::string> measure_list() {
  std::vector<std::string> names;
  for (const MeasureRow& row : all_measures()) names.emplace_back(row.name);
  return names;
}

}  // namespace

void add_comparisons(py::module_& module) {
  py::class_<Compared>(module, "Comparison")
      .def("same", [](const Compared& c) { return c.comparison.same(); })
      .def("report", [](const Compared& c) { return to_python(Json(to_json(c.comparison, c.limits))); })
      .def("verdict", [](const Compared& c) { return text(verdict_text(c.comparison)); })
      .def("failures", &failures)
      .def("save_heatmap", &save_heatmap)
      .def("page", &page);
  module.def("compare", &compare);
  module.def("measure_names", &measure_list);
}

}  // namespace whit::python
