// SPDX-License-Identifier: Apache-2.0

#include <string_view>
#include <unordered_map>

#include "bindings.h"

// nanobind answers a wrong argument by listing its C++ signatures. Whatever is called here goes
// through one function more, which asks volcontact.messages.type_errors for a line that names the
// argument, what it takes and what it got.

namespace volcontact::python {
namespace {

namespace nb = nanobind;

// What was called before, by callable; filled once, while the module is made.
std::unordered_map<PyObject*, vectorcallfunc>& calls() {
  static std::unordered_map<PyObject*, vectorcallfunc> map;
  return map;
}

// Where CPython does not use the call of a type, as 3.10 does not, its __init__ is called and
// stands for it.
std::unordered_map<PyObject*, PyObject*>& types() {
  static std::unordered_map<PyObject*, PyObject*> map;
  return map;
}

// Puts a plain line in the place of a TypeError of nanobind; any other error stays.
void explain(PyObject* callable, PyObject* const* args, size_t flagged, PyObject* names) {
  nb::python_error error;  // takes the error over
  try {
    const std::string_view text = nb::str(error.value()).c_str();
    if (text.find("incompatible function arguments") == std::string_view::npos &&
        text.find("no constructor defined") == std::string_view::npos) {
      error.restore();
      return;
    }
    const auto count = static_cast<size_t>(PyVectorcall_NARGS(flagged));
    const auto type = types().find(callable);
    const bool is_init = type != types().end();
    nb::list positional;
    for (size_t i = is_init ? 1 : 0; i < count; ++i) positional.append(nb::handle(args[i]));
    nb::dict keywords;
    const size_t named = names ? static_cast<size_t>(PyTuple_GET_SIZE(names)) : 0;
    for (size_t i = 0; i < named; ++i) {
      keywords[nb::handle(PyTuple_GET_ITEM(names, static_cast<Py_ssize_t>(i)))] =
          nb::handle(args[count + i]);
    }
    const nb::object line = nb::module_::import_("volcontact.messages.type_errors")
                                .attr("explained")(nb::handle(is_init ? type->second : callable),
                                                   positional, keywords, error.value());
    PyErr_SetObject(PyExc_TypeError, line.ptr());
  } catch (nb::python_error& other) {
    other.restore();
  }
}

PyObject* plain_call(PyObject* callable, PyObject* const* args, size_t flagged, PyObject* names) {
  const auto found = calls().find(callable);
  PyObject* result = found->second(callable, args, flagged, names);
  if (!result && PyErr_ExceptionMatches(PyExc_TypeError)) explain(callable, args, flagged, names);
  return result;
}

// A function or method of nanobind keeps what is called in itself, at a place its type names.
void make_plain(PyObject* function) {
  const Py_ssize_t offset = Py_TYPE(function)->tp_vectorcall_offset;
  if (offset <= 0 || calls().contains(function)) return;
  auto* place = reinterpret_cast<vectorcallfunc*>(reinterpret_cast<char*>(function) + offset);
  calls()[function] = *place;
  *place = plain_call;
}

bool is_function(PyObject* object) {
  const std::string_view type = Py_TYPE(object)->tp_name;
  return type == "nanobind.nb_func" || type == "nanobind.nb_method";
}

}  // namespace

void speak_plainly(nb::module_& m) {
  for (auto [name, value] : nb::borrow<nb::dict>(m.attr("__dict__"))) {
    if (is_function(value.ptr())) make_plain(value.ptr());
    if (!nb::type_check(value)) continue;
    auto* type = reinterpret_cast<PyTypeObject*>(value.ptr());
    const bool has_call =
        type->tp_vectorcall && PyType_HasFeature(Py_TYPE(type), Py_TPFLAGS_HAVE_VECTORCALL);
    if (has_call && !calls().contains(value.ptr())) {
      calls()[value.ptr()] = type->tp_vectorcall;
      type->tp_vectorcall = plain_call;
    }
    const nb::object members = nb::borrow(type->tp_dict);
    for (const nb::handle key : nb::list(members.attr("values")())) {
      // What is called __x__ answers by NotImplemented, or is __init__, which the type calls.
      if (is_function(key.ptr())) {
        const nb::str word(nb::handle(key).attr("__name__"));
        const std::string_view name_of(word.c_str());
        const bool is_init = name_of == "__init__" && !has_call;
        if (is_init) types()[key.ptr()] = value.ptr();
        if (is_init || name_of.substr(0, 2) != "__") make_plain(key.ptr());
      }
    }
  }
}

}  // namespace volcontact::python
