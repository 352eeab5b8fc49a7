// The extension module _processor: what of the instruction sets that _whit is compiled for this processor has not. Python
// loads it before that one, on any processor, and so it is compiled for all of x86-64, of the C library and Python's alone.
#include <Python.h>

#include "tools/whit/instruction_sets.h"

namespace {

/// Names, the oldest first: none where _whit can be loaded.
PyObject* lacks(PyObject*, PyObject*) {
  PyObject* const names = PyList_New(0);
  const std::uint32_t missing = whit::kCompiledFor & ~whit::processor_has();
  for (unsigned i = 0; names && i < whit::kInstructionSets; ++i) {
    const auto set = static_cast<whit::InstructionSet>(i);
    if ((missing & whit::bit(set)) == 0) continue;
    PyObject* const name = PyUnicode_FromString(whit::name_of(set));
    const bool failed = !name || PyList_Append(names, name) != 0;
    Py_XDECREF(name);
    if (!failed) continue;
    Py_DECREF(names);
    return nullptr;
  }
  return names;
}

PyObject* architecture(PyObject*, PyObject*) { return PyUnicode_FromString(whit::kArchitecture); }

PyMethodDef methods[] = {
    {"lacks", lacks, METH_NOARGS, "Instruction sets that the extension module needs and the processor has not."},
    {"architecture", architecture, METH_NOARGS, "What the extension module is compiled for."},
    {nullptr, nullptr, 0, nullptr}};

PyModuleDef module = {PyModuleDef_HEAD_INIT, "_processor", nullptr, 0, methods, nullptr, nullptr, nullptr, nullptr};

}  // namespace

PyMODINIT_FUNC PyInit__processor() { return PyModule_Create(&module); }
