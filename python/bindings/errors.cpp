#include "errors.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "core/errors.hpp"

namespace plica::python {
namespace {

namespace nb = nanobind;

void raise(const char* name, const nb::tuple& arguments) {
  const nb::object type = nb::module_::import_("plica.errors").attr(name);
  PyErr_SetObject(type.ptr(), type(*arguments).ptr());
}

void translate(const std::exception_ptr& error, void*) {
  try {
    std::rethrow_exception(error);
  } catch (const ScenarioError& wrong) {
    nb::list all;
    for (const Diagnostic& one : wrong.diagnostics())
      all.append(nb::make_tuple(one.file, one.line, one.key, one.problem, one.remedy));
    raise("ScenarioError", nb::make_tuple(all));
  } catch (const GaveUp& end) {
    raise("NumericsError", nb::make_tuple(end.reason, end.cell, end.time_s));
  } catch (const FileError& wrong) {
    raise("FileError", nb::make_tuple(wrong.what()));
  } catch (const UsageError& wrong) {
    PyErr_SetString(PyExc_ValueError, wrong.what());
  }
}

}  // namespace

void translate_errors() { nb::register_exception_translator(translate); }

}  // namespace plica::python
