#include "python/convert.h"

#include <variant>

namespace whit::python {
namespace {

/// As whit/_errors.py knows it.
const char* kind_name(FailureKind kind) {
  switch (kind) {
    case FailureKind::Usage: return "usage";
    case FailureKind::Scene: return "scene";
    case FailureKind::File: return "file";
    case FailureKind::Limit: break;
  }
  return "limit";
}

}  // namespace

py::str text(const std::string& bytes) {
  PyObject* const decoded =
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "surrogateescape");
  if (!decoded) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

py::object to_python(const Json& json) {
  struct Visitor {
    py::object operator()(std::monostate) const { return py::none(); }
    py::object operator()(bool truth) const { return py::bool_(truth); }
    py::object operator()(int64_t number) const { return py::int_(number); }
    py::object operator()(double number) const { return py::float_(number); }
    py::object operator()(const std::string& bytes) const { return text(bytes); }
    py::object operator()(const Json::Array& elements) const {
      py::list out;
      for (const Json& element : elements) out.append(to_python(element));
      return out;
    }
    py::object operator()(const Json::Object& members) const {
      py::dict out;
      for (const auto& [name, member] : members) out[text(name)] = to_python(member);
      return out;
    }
  };
  return std::visit(Visitor(), json.value);
}

py::dict to_python(const Said& said) {
  py::dict out;
  out["severity"] = text(said.severity), out["name"] = text(said.name);
  out["message"] = text(said.message), out["remedy"] = text(said.remedy);
  out["file"] = text(said.file), out["line"] = said.line, out["column"] = said.column;
  out["text"] = text(said.text);
  return out;
}

py::list to_python(const std::vector<Said>& said) {
  py::list out;
  for (const Said& one : said) out.append(to_python(one));
  return out;
}

void raise(const Failure& failure) {
  const py::object make = py::module_::import("whit._errors").attr("make_error");
  const py::object error = make(kind_name(failure.kind), text(failure.what()), to_python(failure.said));
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

}  // namespace whit::python
