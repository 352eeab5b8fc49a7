// The extension module: what the package `whit` is made of. Its functions take what the package has checked; the
// documentation is there.

#include <new>

#include "python/convert.h"

namespace whit::python {
namespace {

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Failure& failure) { raise(failure); } catch (const std::bad_alloc& e) {
    raise({FailureKind::Limit, std::string("not enough memory: ") + e.what()});
  }
}

}  // namespace

PYBIND11_MODULE(_whit, module) {
  py::register_exception_translator(&translate);
  add_pictures(module);
  add_scenes(module);
  add_inquiries(module);
  add_comparisons(module);
}

}  // namespace whit::python
